"""Critical points of paths: found, located, named, and the same on both paths."""

import math

import numpy as np
import pytest
from mpmath import ellipk, mp

from spline_model import cross_axis_pivot, solve_mechanism, solve_statics
from tests import gates
from tests.frames import column, opposed
from tests.table_one import SIX, TABLE_ONE

EULER = math.pi**2 / 4
TWO_LIMITS = ("limit point", "limit point")
ANGLES = (20, 40, 60, 80, 100, 120, 140, 160, 176)


def test_the_mode_of_a_column_is_a_quarter_wave():
    """Requirement: the critical mode moves the tip across and not along, and turns it as a sine does."""
    answer = solve_mechanism(column(load=4.0, slenderness=1e4, control_points=6), increments=7)
    (point,) = answer.critical_points
    along, across, turn = point.mode[answer.system.layout.body("tip")]
    assert abs(along) < 1e-6
    assert abs(turn / across - math.pi / 2) < 1e-3


def post_buckling(control_points=14):
    """Largest error of the tip's angle [deg] on the bifurcated branch, at the loads of the elastica.

    P / Pcr = (2 K(sin(angle / 2)) / pi)^2: Timoshenko and Gere, Theory of Elastic Stability (1961), 2.7.
    """
    errors = []
    for angle in ANGLES:
        ratio = float((2 * ellipk(mp.sin(mp.radians(angle) / 2) ** 2) / mp.pi) ** 2)
        grid = {"control_points": control_points, "gauss_points": 2 * control_points}
        made = column(load=EULER * ratio, effects=("bending", "inextensible"), **grid)
        answer = solve_mechanism(made, branch="follow", control="arc-length")
        assert "goes on along the branch" in answer.message
        assert answer.inertia[-1] == 0
        errors.append(abs(abs(math.degrees(answer.bodies["tip"][-1, 2])) - angle))
    return max(errors)


def test_the_bifurcated_branch_is_the_elastica():
    """Requirement: branch = "follow" leads onto the post-buckling branch, to a tip angle of 176 deg."""
    gates.hold("spline_post_buckling", post_buckling)


@pytest.mark.parametrize("branch", ["primary", "follow"])
def test_load_control_and_arc_length_end_alike(branch):
    """Requirement: a branch without limit points ends in the same state in either control."""
    made = column(load=4.0, control_points=8)
    by_load, by_arc = (
        solve_mechanism(made, control=control, branch=branch) for control in ("load", "arc-length")
    )
    assert np.abs(by_load.states[-1] - by_arc.states[-1]).max() < 1e-7
    assert [c.kind for c in by_load.critical_points] == [c.kind for c in by_arc.critical_points]
    assert by_load.inertia[-1] == by_arc.inertia[-1] == (1 if branch == "primary" else 0)
    assert by_load.message == by_arc.message


@pytest.mark.parametrize(
    ("pivot", "rotation", "increments", "kinds"),
    [
        (opposed(offset=0.01, control_points=8), -0.3, 12, ["bifurcation"]),
        (opposed(offset=0.03, control_points=8, gauss_points=16), -0.3, 40, ["bifurcation", *TWO_LIMITS]),
        (cross_axis_pivot(**SIX), 1.5, 20, []),
    ],
)  # fmt: skip
def test_both_paths_find_the_same_critical_points(pivot, rotation, increments, kinds):
    """Requirement: the condensed path has the inertia and the critical points of the multiplier path."""
    fast, slow = (
        solve_statics(pivot, rotation=rotation, increments=increments, method=method)
        for method in ("condensed", "multipliers")
    )
    assert np.array_equal(fast.inertia, slow.inertia)
    assert np.allclose(fast.moment_defect, slow.moment_defect, rtol=1e-6, atol=1e-9)
    assert [c.kind for c in fast.critical_points] == [c.kind for c in slow.critical_points] == kinds
    for a, b in zip(fast.critical_points, slow.critical_points, strict=True):
        assert abs(a.rotation - b.rotation) < math.radians(1e-4)
        assert np.abs(a.mode - b.mode).max() < 1e-4
    assert fast.message == slow.message


def test_printed_forces_have_no_inertia():
    """Requirement: forces without a potential have a path without inertia and critical points."""
    pivot = cross_axis_pivot(**TABLE_ONE, control_points=4, measure="printed", stretch="consistent")
    answer = solve_statics(pivot, rotation=0.5, increments=5)
    assert (answer.inertia == -1).all()
    assert answer.critical_points == ()
