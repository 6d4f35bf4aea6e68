"""Critical points of paths: found, located, named, the same on both paths; and paths through limit points."""

import math

import numpy as np
import pytest

import spline_model
from spline_model import cross_axis_pivot, solve_mechanism, solve_statics
from studies.answers.models import put
from studies.answers.settings import SplineSettings
from studies.published.case import published
from tests import gates
from tests.frames import column, heavy, opposed, tip
from tests.table_one import SIX, TABLE_ONE

TWO_LIMITS = ("limit point", "limit point")


def test_the_mode_of_a_column_is_a_quarter_wave():
    """Requirement: the critical mode moves the tip across and not along, and turns it as a sine does."""
    answer = solve_mechanism(column(load=4.0, slenderness=1e4, control_points=6), increments=7)
    (point,) = answer.critical_points
    along, across, turn = point.mode[answer.system.layout.body("tip")]
    assert abs(along) < 1e-6
    assert abs(turn / across - math.pi / 2) < 1e-3


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


@pytest.mark.parametrize("increments", [3, 7])
@pytest.mark.parametrize("side", [1e-9, 1e-8, -1e-8])
def test_a_small_imperfection_bends_the_column_to_its_side(side, increments):
    """Requirement: beyond its Euler load a column with a billionth of the load aside is on the branch that
    the perfect one has there, to the side of the load, stable, and has no critical point."""
    perfect = solve_mechanism(column(load=4.0, control_points=8), branch="follow")
    found = solve_mechanism(column(load=4.0, control_points=8, side=side), increments=increments)
    assert found.critical_points == () and found.inertia[-1] == 0
    (_, across, turn), right = found.bodies["tip"][-1], perfect.bodies["tip"][-1]
    assert math.copysign(1.0, across) == math.copysign(1.0, side)
    assert abs(abs(turn) - abs(right[2])) < 1e-6


def test_printed_forces_have_no_inertia():
    """Requirement: forces without a potential have a path without inertia and critical points."""
    pivot = cross_axis_pivot(**TABLE_ONE, control_points=4, measure="published", stretch="consistent")
    answer = solve_statics(pivot, rotation=0.5, increments=5)
    assert (answer.inertia == -1).all()
    assert answer.critical_points == ()


@pytest.mark.parametrize("control", ["load", "arc-length"])
def test_a_column_may_leave_its_upright_branch_as_its_weight_grows(control):
    """Requirement: branch = "follow" leads a centred heavy column onto its stable, bent branch."""
    made = heavy(spline_model, 3.0, 0.0, control_points=12)
    answer = solve_mechanism(made, increments=1, branch="follow", control=control)
    assert answer.inertia.max() == 0
    assert "goes on along the branch" in answer.message
    assert abs(tip(answer)) > 60  # deg


def lees_frame(control_points):
    """Lee's frame of the published problems, its load of 3 t at load factor 1."""
    design = published("lees_frame").frame().design
    return put(design, SplineSettings(control_points=control_points)).modelled


def test_a_load_that_turns_round_keeps_its_sign():
    """Requirement: with default settings Lee's frame is followed through loads below zero, told with sign."""
    path = solve_mechanism(lees_frame(control_points=None), control="arc-length")
    assert path.estimate.accuracy == 1e-4 and path.resolution == ""
    assert [point.kind for point in path.critical_points] == ["limit point", "limit point"]
    assert path.load_factor.min() < -0.3
    assert "load factor -0.3138" in path.message


def work_balance(late=0):
    """Work of the load on Lee's frame, some states late, against the energy stored at the end of its path."""
    path = solve_mechanism(lees_frame(control_points=10), control="arc-length")
    return abs(path.work[-1 - late] / path.energies[-1].sum() - 1)


def test_work_is_booked_through_limit_points():
    """Requirement: along a path whose load goes up, down and up again the work is the energy stored."""
    gates.hold("spline_arc_length_work", work_balance)
