"""Natural modes about loaded states, at rotations of either sign, at none and without a drive."""

from functools import partial

import numpy as np
import pytest

from studies.answers.adapters import answer_modes
from studies.answers.settings import FeSettings, Settings, SplineSettings
from studies.cases.design import Design
from tests import gates
from tests.agreement import loaded
from tests.agreement.loaded import LOADS, ROTATION, angle

LED = "driven_displacement"


def frequencies(asked: Design, settings: Settings, count: int = 3) -> np.ndarray:
    """Lowest frequencies about the state that the design is driven to and released from [Hz]."""
    answer = answer_modes(asked, settings, rotation=asked.rotation or 0.0, count=count)
    assert answer.converged, answer.message
    return answer.frequency


def apart(asked: Design, control_points: int = 8, meshes: tuple[int, int] = (5, 10)) -> float:
    """Largest relative difference of the lowest frequencies from the limit of two meshes."""
    coarse, fine = (frequencies(asked, FeSettings(elements=count)) for count in meshes)
    limit = (4.0 * fine - coarse) / 3.0
    return float(
        np.abs(frequencies(asked, SplineSettings(control_points=control_points)) / limit - 1.0).max()
    )


@pytest.mark.parametrize("effect", LOADS)
@pytest.mark.parametrize(
    "rotation",
    [-ROTATION, *(pytest.param(each, marks=pytest.mark.slow) for each in (ROTATION, 0.0, None))],
    ids=angle,
)
def test_modes_about_loaded_states_agree(effect, rotation):
    """Requirement: the first three modes of the released coordinates agree under every load."""
    gate, meshes = ("loads_modes_led", (10, 20)) if effect == LED else ("loads_modes", (5, 10))
    error = partial(apart, loaded.design(effect, rotation), meshes=meshes)
    gates.check(gate, error())
    if effect in ("applied_force", LED) and rotation == -ROTATION:
        gates.refuse(gate, error)
