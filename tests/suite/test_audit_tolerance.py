"""What the audit holds within its tolerance: each kind of change alone makes a scene too different."""

from dataclasses import fields

import numpy as np
import pytest

from studies.answers.settings import SplineSettings
from studies.cases.effects import Effects
from studies.cases.problem import named_case
from studies.effects import audit, scenes
from studies.effects.scenes import CHANGES, SIZES, Answer, Outcome, Run, Variant

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


ANSWER = Answer(
    path={"body": np.array([[0.0, 0.0], [1.0, 0.0]])},
    torque=np.array([0.0, 2.0]),
    mode=1.0,
    swing=1.0,
    loss=0.3,
)
CHANGED = {
    "trajectory": {"path": {"body": np.array([[0.0, 0.0], [1.0, 0.1]])}},
    "torque": {"torque": np.array([0.0, 2.2])},
    "swing_frequency": {"swing": 1.1},
    "first_mode": {"mode": 1.1},
    "loss": {"loss": 0.4},
}


@pytest.mark.parametrize("change", CHANGED)
def test_every_change_is_measured(change, monkeypatch):
    """Requirement: a scene whose answer differs in one thing by a tenth has that change and no other."""
    given = {each.name: getattr(ANSWER, each.name) for each in fields(Answer)}
    monkeypatch.setattr(Run, "answer", lambda *_: Answer(**(given | CHANGED[change])))
    monkeypatch.setattr(scenes, "size_of", lambda *_: SIZE)
    design, run = (
        named_case("cross_axis_pivot"),
        Run(settings=SplineSettings(control_points=6), duration=1.0, step=1.0),
    )
    found = run.outcome(Variant(dropped=(), effects=design.effects), design, ANSWER)
    assert found.changes == pytest.approx({name: 0.1 if name == change else 0.0 for name in CHANGED})
