"""What must hold on any mesh: energy, balance, symmetry, frame indifference, reversibility."""

from dataclasses import replace

import numpy as np
import pytest

from fe_reference import ELEMENTS, solve_statics
from tests.fe.cases import STRIP, pivot

QUARTER = np.pi / 2.0


@pytest.mark.parametrize("element", ELEMENTS)
def test_stiffness_does_not_depend_on_the_order(element: str) -> None:
    """Whichever strip comes first, stiffness is the same: round-off of EA is not in it, however slender."""
    thinner = {"area": 0.1 * STRIP.area, "second_moment_of_area": 1e-3 * STRIP.second_moment_of_area}
    given = pivot(crossing_ratio=0.35, element=element)
    model = replace(given, strips=tuple(replace(strip, **thinner) for strip in given.strips))
    turned = replace(model, strips=model.strips[::-1])
    one, other = (solve_statics(each, rotation=0.5, increments=4).stiffness for each in (model, turned))
    assert one[1:] == pytest.approx(other[1:], rel=1e-12)
