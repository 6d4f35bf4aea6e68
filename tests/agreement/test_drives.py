"""Drives that begin and end during a motion, in both models: rotations of either sign, and a led centre."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from studies.answers.settings import FeSettings
from studies.cases.design import Design
from tests import gates
from tests.agreement import loaded
from tests.agreement.loaded import ROTATION
from tests.agreement.test_loads_release import ELEMENTS, SPLINE, STEP, apart, largest, places, released

#: A rotation that is locked and then released, one that is driven back and released while it moves, and the
#: centre driven on. Corners are off the grid of steps.
HELD, LED_BACK = (0.0, 0.00301), ((0.0, 1.0), (0.00503, 0.7))
AWAY = ((0.0, 1.0), (0.00307, 0.8), (0.00611, 1.0))


def driven(name: str, sign: float = 1.0) -> Design:
    """Return a loaded design whose motion is driven in part."""
    centre = {"history": AWAY} if "centre" in name else {}
    asked = loaded.design("driven_displacement" if centre else "gravity", sign * ROTATION, **centre)
    return {
        "held": replace(asked, held=HELD),
        "led back": replace(asked, history=LED_BACK, held=(0.0, 0.00503)),
        "caught": replace(asked, held=(0.00211, 0.00701)),
        "led centre": asked,
        "held, led centre": replace(asked, held=HELD),
    }[name]


@pytest.mark.parametrize(
    "name, sign",
    [
        ("held", -1.0),
        pytest.param("led back", 1.0, marks=pytest.mark.slow),
        ("led back", -1.0),
        pytest.param("led centre", 1.0, marks=pytest.mark.slow),
    ],
)
def test_motions_that_are_driven_in_part_agree(name, sign):
    """Requirement: drives hold, lead and end at the same instants in both models, which move alike."""
    error = partial(apart, driven(name, sign))
    gates.check("drives_release", error())
    if (name, sign) == ("led back", -1.0):
        gates.refuse("drives_release", error)


@pytest.mark.parametrize("name", ["caught", "held, led centre"])
@pytest.mark.parametrize("settings", [SPLINE, ELEMENTS], ids=lambda s: s.model)
def test_what_is_held_stays_and_the_books_close(name, settings):
    """Requirement: a held rotation stays, what the catch costs is dissipated, and the energies balance."""
    motion = released(driven(name), settings)
    inside = (motion.time > 0.00212) & (motion.time < 0.003)
    assert np.ptp(motion.rotation[inside]) < 1e-10
    assert motion.dissipated[-1] > 0.0 or name != "caught"
    gates.check("drives_books", max(motion.energy_error, 1e-16))
    if settings is ELEMENTS and name == "caught":
        coarse = partial(released, driven(name), settings)
        gates.refuse("drives_books", lambda **options: coarse(**options).energy_error)
    other = released(driven(name), SPLINE if settings is ELEMENTS else ELEMENTS)
    assert motion.dissipated[-1] == pytest.approx(other.dissipated[-1], rel=0.02, abs=1e-12)


def schemes_apart(step: float = 0.4 * STEP) -> float:
    """Return how far the motions of the implicit and the explicit scheme of the elements are apart."""
    design, mesh = driven("held, led centre"), FeSettings(elements=4)
    implicit = released(design, mesh, integrator="generalised-alpha", step=step)
    return largest(places(implicit), places(released(design, mesh)))


def test_both_schemes_of_the_elements_follow_the_same_drives():
    """Requirement: the implicit integrator of the elements moves as the explicit one does."""
    gates.hold("drives_schemes", schemes_apart)
