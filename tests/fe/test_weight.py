"""Weight that hangs beside a body's centre takes part in the stiffness of its turn."""

import pytest

from fe_reference import ELEMENTS, cross_axis_pivot, solve_statics
from tests.fe.cases import MOMENT, TABLE_1
from tests.gates import hold

#: Few elements, and strips so heavy that the half of one that hangs beside the centre turns the body.
HEAVY = {"density": 2e6, "body_mass": 0.0, "centre_offset": (0.03, 0.05)}


@pytest.mark.parametrize("element", ELEMENTS)
def test_stiffness_of_a_turn_has_the_weight_that_hangs_on_it(element: str) -> None:
    """Stiffness is the difference quotient of torques where half-elements of heavy strips hang on a body."""
    model = cross_axis_pivot(
        **(TABLE_1 | HEAVY),
        elements=2,
        element=element,
        effects=("bending", "stretching", "gravity"),
        parameters={"gravity": {"acceleration": (0.0, -9.81)}},
    )
    stiffness = solve_statics(model, rotation=0.5, increments=4).stiffness[-1]

    def error(step: float = 1e-3) -> float:
        ends = [
            solve_statics(model, rotation=angle, increments=4).torque[-1]
            for angle in (0.5 + step, 0.5 - step)
        ]
        return abs(stiffness - (ends[0] - ends[1]) / (2.0 * step)) / MOMENT

    hold("fe_weight_stiffness", error)
