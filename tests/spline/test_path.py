"""Following the path: increments, work, refusals."""

import math

import numpy as np
import pytest

from spline_model import ConvergenceError, cross_axis_pivot, solve_statics
from tests.table_one import SIX, TABLE_ONE

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


def test_a_path_that_stops_keeps_its_converged_part():
    """Requirement: a failed path says where and why and keeps the last good state."""
    pivot = cross_axis_pivot(**TABLE_ONE, control_points=8)
    with pytest.raises(ConvergenceError, match="stopped between load factor") as caught:
        solve_statics(pivot, rotation=math.radians(230), increments=30)
    kept = solve_statics(pivot, rotation=math.radians(230), increments=30, raise_on_failure=False)
    assert kept.status.value == "not_converged"
    assert "try more increments" in kept.status.text
    assert 1 < len(kept.rotation) <= 31
    assert kept.rotation[-1] < math.radians(230)
    assert np.array_equal(kept.torque, caught.value.solution.torque)
    assert np.isfinite(kept.torque).all()
    assert 0 < caught.value.load_factor < 1


def test_progress_counts_to_the_end():
    """Requirement: the progress callable sees every increment."""
    seen = []
    solve_statics(
        cross_axis_pivot(**SIX),
        rotation=0.5,
        increments=4,
        progress=lambda done, total: seen.append((done, total)),
    )
    assert seen == [(1, 4), (2, 4), (3, 4), (4, 4)]
