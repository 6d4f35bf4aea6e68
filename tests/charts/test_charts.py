"""The design charts are those of the models, and say where they end."""

import math
from dataclasses import replace

import numpy as np
import pytest

from studies.answers.adapters import answer_static
from studies.answers.settings import FeSettings
from studies.cases.problem import named_case
from studies.cases.section import of_sides
from studies.design import charts as pivot
from tests import gates

RATIOS, ANGLES = np.array([0.2, 0.5, 0.8]), np.array([45.0, 45.0, 45.0])


@pytest.fixture(scope="module")
def charted():
    """Quantities of three designs."""
    return pivot.paths(RATIOS, ANGLES, pivot.SLENDER)


def test_stiffness_at_rest_is_the_closed_form(charted):
    """Requirement: K L/(EI) of slender strips at rest is 8 (1 - 3 lambda (1 - lambda))."""
    exact = 8.0 * (1.0 - 3.0 * RATIOS * (1.0 - RATIOS))
    assert charted["stiffness"][:, 0] == pytest.approx(exact, rel=1e-3)


def test_what_holds_for_a_ratio_holds_for_its_complement(charted):
    """Requirement: crossed at lambda and at 1 - lambda a pivot is as stiff, as strained and shifts as far."""
    for name in pivot.QUANTITIES:
        assert charted[name][0] == pytest.approx(charted[name][2], rel=1e-5, abs=1e-7), name


def _apart(elements=80):
    """Largest difference of stiffness and shift of a chart from those of elements at 30 degrees, relative."""
    ratio, increments = 0.3, round(30.0 / pivot.INCREMENT)
    chart = pivot.paths(np.array([ratio]), np.array([45.0]), pivot.SLENDER)
    case = named_case("cross_axis_pivot")
    sides = {"width": pivot.WIDTH * case.length, "thickness": case.length / pivot.SLENDER}
    problem = replace(
        case,
        **sides,
        **of_sides(*sides.values()),
        crossing_ratio=ratio,
        inclination=math.radians(45.0),
        centre_offset=(0.0, -(1.0 - ratio) * case.length * math.sin(math.radians(45.0))),
        rotation=math.radians(30.0),
        increments=increments,
    )
    unit = problem.youngs_modulus * problem.second_moment_of_area / problem.length
    answer = answer_static(problem, FeSettings(elements=elements))
    shift = np.hypot(*(answer.centre[-1] - answer.centre[0])) / problem.length
    apart = [
        answer.stiffness[-1] / unit / chart["stiffness"][0, increments] - 1.0,
        shift / chart["shift"][0, increments] - 1.0,
    ]
    return float(np.abs(apart).max())


@pytest.mark.slow
def test_charts_are_the_answers_of_elements():
    """Requirement: stiffness and shift of a chart are those of finite elements of that pivot."""
    gates.hold("charts_by_elements", _apart)


def test_theory_ends_where_the_remarks_say():
    """Requirement: at a ratio of the table beam theory neglects the share of that row."""
    for row in pivot.limits()["limits"]:
        assert pivot.LEFT_OUT[row["ratio"]][0](row["value"]) == pytest.approx(row["share"], rel=0.05)
