"""What a static solve refuses: wrong branches, unresolved and under-integrated strips."""

import math

import numpy as np
import pytest

import spline_model
from spline_model import (
    cross_axis_pivot,
    solve_mechanism,
    solve_statics,
)
from tests.frames import one_strip
from tests.table_one import SECTION, SIX

METHODS = ("condensed", "multipliers")


def to(degrees, *, increments=36, method="condensed", **settings):
    """Table 1 driven to a rotation [deg]; a stopped path is returned."""
    pivot = cross_axis_pivot(**(SIX | settings))
    return solve_statics(
        pivot,
        rotation=math.radians(degrees),
        increments=increments,
        method=method,
        raise_on_failure=False,
    )


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("sense", [1, -1])
def test_the_wrong_branch_of_four_control_points_is_refused(sense, method):
    """Requirement: n = 4 is not followed to 180 deg onto a branch of its own; what is kept is right."""
    answer = to(sense * 180, method=method, control_points=4)
    assert answer.status.value == "not_converged"
    assert "do not resolve the strips" in answer.message
    assert answer.moment_defect.max() <= 0.155
    right = to(sense * 180, control_points=12)
    torque = np.interp(sense * answer.rotation, sense * right.rotation, right.torque)
    assert np.abs(answer.torque - torque).max() < 0.05 * np.abs(torque).max()
    assert answer.stiffness.min() > 0


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(("gauss_points", "false_limit"), [(7, 149.0), (8, 184.3), (10, 225.5)])
def test_what_few_gauss_points_make_up_is_no_critical_point(gauss_points, false_limit, method):
    """Requirement: a limit that only too few Gauss points have is refused, with the states it spoils."""
    answer = to(240, increments=48, method=method, control_points=8, gauss_points=gauss_points)
    assert answer.status.value == "not_converged"
    assert "not resolved with 8 control points" in answer.message
    assert answer.critical_points == ()
    end = math.degrees(answer.rotation[-1])
    assert false_limit - 15 < end < false_limit
    finer = to(end, control_points=8, gauss_points=20)
    assert abs(answer.stiffness[-1] / finer.stiffness[-1] - 1) < 0.03


def weighed(control_points):
    """Moment defect of a cantilever that hangs far down under its own weight."""
    weight = {"gravity": {"acceleration": (0.0, -3e5)}}
    made = one_strip(spline_model, weight, weight, section=SECTION, control_points=control_points)
    return solve_mechanism(made, increments=1).moment_defect[0]


def test_weight_is_in_the_balance_of_moments():
    """Requirement: the moment defect counts the weight of a strip, and vanishes with more control points."""
    defects = [weighed(n) for n in (5, 7, 9)]
    assert defects[0] < 0.1
    assert defects[1] < 0.3 * defects[0]
    assert defects[2] < 0.3 * defects[1]
