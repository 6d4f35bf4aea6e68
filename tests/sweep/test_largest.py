"""Largest values of a path are those of all its states, where the path does not grow to its end."""

from dataclasses import replace

import numpy as np
import pytest

from studies.answers.adapters import answer_static
from studies.answers.settings import FeSettings, SplineSettings
from studies.cases.effects import DEFAULT, Effects
from studies.cases.problem import named_case
from studies.sweep.points import PATH, SHIFT, static_answer, values

#: Natural curvature that the drive of the pivot undoes, so that the stress falls on the way.
UNBENT = replace(
    named_case("cross_axis_pivot"),
    rotation=0.2,
    increments=8,
    effects=Effects(names=(*DEFAULT, "pre_strain"), tables={"pre_strain": {"curvature": 3.0}}),
)


@pytest.mark.parametrize(
    "settings", [SplineSettings(control_points=6), FeSettings(elements=10)], ids=lambda s: s.model
)
def test_largest_values_are_those_of_the_whole_path(settings):
    """Requirement: stress_max_Pa and its kin are the largest of all states, also of a path that relaxes."""
    answer = answer_static(UNBENT, settings)
    status, _, paths = static_answer(UNBENT, settings, both_sides=False)
    assert status == "converged" and paths is not None
    found = {name: float(value[0]) for name, value in values(PATH | SHIFT, paths).items()}
    stress, torque = answer.max_stress, np.abs(answer.torque)
    assert stress.max() > 1.2 * stress[-1] and torque.max() > 1.2 * torque[-1]  # the path does relax
    assert found["stress_max_Pa"] == pytest.approx(stress.max(), rel=1e-9)
    assert found["stress_end_Pa"] == pytest.approx(stress[-1], rel=1e-9)
    assert found["torque_max_Nm"] == pytest.approx(torque.max(), rel=1e-9)
    assert found["torque_Nm"] == pytest.approx(answer.torque[-1], rel=1e-9)
    shift = np.hypot(*answer.centre_shift.T)
    assert found["centre_shift_max_m"] == pytest.approx(shift.max(), rel=1e-9)
