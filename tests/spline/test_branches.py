"""One branch whatever the increments, and what is said of buckling."""

from dataclasses import replace

import pytest

import spline_model
from spline_model import BodyDesign, ConvergenceError, compliant_mechanism, solve_mechanism
from tests.frames import column, heavy, tip, toggle


@pytest.mark.parametrize("control_points", [8, 10])
def test_weight_beyond_a_limit_point_is_refused_there(control_points):
    """Requirement: a toggle of twice the weight that it bears is refused where it snaps, at 56.5 % of it."""
    made = toggle(control_points=control_points)
    heavy_apex = compliant_mechanism(
        strips=[replace(strip, density=1e-12) for strip in made.design.strips],
        bodies=[BodyDesign(name="apex", centre=made.design.bodies[0].centre, mass=60.0)],
        effects=("bending", "stretching", "gravity"),
        parameters={"gravity": {"acceleration": (0.0, -1.0)}},
        control_points=control_points,
    )
    with pytest.raises(
        ConvergenceError, match=r"56\.5\d* % of weight .*it buckles, a limit point"
    ) as refused:
        solve_mechanism(heavy_apex)
    answer = refused.value.solution
    assert not answer.settled and len(answer.work) == 1
    assert answer.critical_points[-1].preload == pytest.approx(0.565, abs=1e-3)


def test_an_upright_column_that_buckles_says_so():
    """Requirement: a centred column far beyond its critical weight stays upright, and is called unstable."""
    answer = solve_mechanism(heavy(spline_model, 30.0, 0.0, control_points=12), increments=2)
    assert abs(tip(answer)) < 1e-6
    assert answer.inertia.min() == 2
    assert "bifurcation at 8.22" in answer.message  # pi^2 / 4 of 30
    assert "it buckles" in answer.message
    assert "the last state is unstable" in answer.message


@pytest.mark.parametrize("control", ["load", "arc-length"])
def test_a_column_may_leave_its_upright_branch_as_its_weight_grows(control):
    """Requirement: branch = "follow" leads a centred heavy column onto its stable, bent branch."""
    made = heavy(spline_model, 3.0, 0.0, control_points=12)
    answer = solve_mechanism(made, increments=1, branch="follow", control=control)
    assert answer.inertia.max() == 0
    assert "goes on along the branch" in answer.message
    assert abs(tip(answer)) > 60  # deg


@pytest.mark.parametrize("increments", [1, 2, 3, 7])
def test_an_imperfect_column_reports_no_bifurcation(increments):
    """Requirement: a column with a side load bends on one stable branch in any number of increments."""
    bent = solve_mechanism(column(load=5.0, side=0.02, control_points=10), increments=increments)
    fine = solve_mechanism(column(load=5.0, side=0.02, control_points=10), increments=60)
    assert bent.critical_points == ()
    assert bent.inertia.max() == 0
    assert bent.message == ""
    assert abs(tip(bent) - tip(fine)) < 1e-6


def test_a_buckled_column_is_told_in_newtons():
    """Requirement: a path that passed a bifurcation says the load there, and that its end is unstable."""
    answer = solve_mechanism(column(load=4.0, control_points=8), increments=5)
    assert "bifurcation at load factor 0.61" in answer.message  # pi^2 / 16
    assert "(force 2.46" in answer.message
    assert "the last state is unstable: it buckles" in answer.message
