"""Numbers of a mechanism's case file as variables: their gradients, and the file with their values."""

import numpy as np
import pytest

from studies.cases.document import parsed
from studies.cases.problem import FOLDER
from studies.design.evaluate import STRESS, VARIATION
from studies.design.question import Question
from tests import gates
from tests.design.gradients import gradient_error

FREE = (
    "section.thickness_m",
    "strips.crank_coupler.end_m.y=0.09:0.11",
    "bodies.coupler.centre_m.x=0.04:0.06",
)
SHARED = "strips.left.end_m.y,strips.right.end_m.y=0.09:0.11"


def task(name, texts, **given):
    """The question about a case that comes with the suite."""
    return Question.of(name, parsed(FOLDER / f"{name}.toml"), texts, **given)


@pytest.mark.parametrize(
    ("name", "texts", "objective"),
    [
        pytest.param("four_bar_of_flexures", FREE, VARIATION, marks=pytest.mark.slow),
        ("parallel_strip_guide", ("section.width_m", SHARED), STRESS),
        ("living_hinge", ("section.thickness_m", "material.youngs_modulus_Pa"), STRESS),
    ],
)
def test_gradients_by_numbers_of_a_file(name, texts, objective):
    """Rows and Jacobian fit together for sections, moduli, places, and values that several keys share."""
    asked = task(name, texts, objective=objective, wanted=1.0, allowable_stress=1e9)
    gates.hold("sizing_gradients", lambda **steps: gradient_error(asked, asked.own, **steps))


def test_a_number_stands_for_the_sections_of_all_strips():
    """The width of all sections, given by A and I, moves area and second moment of each strip."""
    asked = task("four_bar_of_flexures", ["section.width_m"], objective=STRESS)
    (number,) = asked.variables
    assert (number.own, number.low, number.high) == pytest.approx((0.01, 0.005, 0.02))
    wide = asked.design(np.array([0.02]))
    for strip, own in zip(wide.strips, asked.start.strips, strict=True):
        assert strip.second_moment_of_area == pytest.approx(2.0 * own.second_moment_of_area)
