"""Following the path: increments, work, refusals."""

import math

import pytest

from spline_model import cross_axis_pivot, solve_statics
from tests.table_one import SIX

QUARTER = math.pi / 2


def solved(rotation=QUARTER, increments=20, **settings):
    """Static solution of Table 1 with settings."""
    return solve_statics(cross_axis_pivot(**(SIX | settings)), rotation=rotation, increments=increments)


@pytest.mark.parametrize("control_points", [4, 6, 8, 12])
def test_newton_iterations(control_points):
    """Requirement: 25 Newton iterations or fewer for 20 increments, and an evaluation more a state; few
    states form more than one tangent, as what lies behind a good prediction needs none.
    """
    counters = solved(control_points=control_points).counters
    assert counters["newton_iterations"] <= 25
    assert counters["residual_evaluations"] <= counters["newton_iterations"] + counters["increments"] + 2
    assert counters["factorisations"] <= 26
    assert counters["increments"] == 20
    assert counters["halved_increments"] == 0
