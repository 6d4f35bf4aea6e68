"""What the audit holds within its tolerance: each kind of change alone makes a scene too different."""

import pytest

from studies.cases.effects import Effects
from studies.effects import audit
from studies.effects.scenes import CHANGES, SIZES, Outcome, Variant

TOLERANCE = 1e-3
WITHIN = dict.fromkeys(CHANGES, 1e-4)
SIZE = dict.fromkeys(SIZES, 1)


def scene(wall_s, *names, **changes):
    """A scene of the audit with these effects, changes and time."""
    variant = Variant(dropped=(), effects=Effects(names=names))
    return Outcome(variant=variant, size=SIZE, wall_s=wall_s, changes=WITHIN | changes)


@pytest.mark.parametrize("change", WITHIN)
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_every_change_counts(change, sign):
    """Requirement: the cheapest scene within the tolerance is none that changes anything by more than it."""
    full = scene(2.0, "bending", "stretching", **dict.fromkeys(WITHIN, 0.0))
    far = scene(1.0, "bending", **{change: sign * 2.0 * TOLERANCE})
    near = scene(1.0, "bending", **{change: sign * 0.5 * TOLERANCE})
    assert far.largest == pytest.approx(2.0 * TOLERANCE)
    assert audit._cheapest([full, far], TOLERANCE) is full
    assert audit._cheapest([full, near], TOLERANCE) is near
