"""What a static solve refuses: wrong branches, unresolved and under-integrated strips, bad starts."""

import math

import numpy as np
import pytest

from spline_model import (
    ConvergenceError,
    InvalidParameter,
    StripDesign,
    compliant_mechanism,
    cross_axis_pivot,
    solve_many,
    solve_mechanism,
    solve_statics,
)
from spline_model.compile import compile_scene
from spline_model.continuation.followed import Followed
from spline_model.newton import solve
from spline_model.statics import solve_from
from tests.spline.frames import opposed
from tests.table_one import SIX, TABLE_ONE

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
    assert "not found with twice the Gauss points" in answer.message
    assert answer.critical_points == ()
    end = math.degrees(answer.rotation[-1])
    assert false_limit - 15 < end < false_limit
    finer = to(end, control_points=8, gauss_points=20)
    assert abs(answer.stiffness[-1] / finer.stiffness[-1] - 1) < 0.03


@pytest.mark.parametrize("degrees", [180, -180])
@pytest.mark.parametrize("control_points", [6, 8, 12])
def test_half_a_turn_either_way(control_points, degrees):
    """Requirement: six control points and more reach +-180 deg, stable all the way."""
    answer = to(degrees, control_points=control_points)
    assert answer.status.value == "converged"
    assert answer.inertia.max() == 0
    assert answer.critical_points == ()


GUESSES = {
    "right": lambda z, layout, rng: z,
    "perturbed": lambda z, layout, rng: _shifted(z, layout, 1e-3 * rng.standard_normal(z.size)),
    "far": lambda z, layout, rng: _shifted(z, layout, 0.05 * rng.standard_normal(z.size)),
    "crumpled": lambda z, layout, rng: _shifted(z, layout, 0.5 * rng.standard_normal(z.size)),
    "reversed": lambda z, layout, rng: _reordered(z, layout, slice(None, None, -1)),
    "coincident": lambda z, layout, rng: _reordered(z, layout, slice(0, 1)),
    "nothing": lambda z, layout, rng: np.zeros_like(z),
}


def _shifted(z, layout, change):
    moved = z.copy()
    moved[: layout.coordinate_count] += change[: layout.coordinate_count]
    return moved


def _reordered(z, layout, order):
    moved = z.copy()
    for name in layout.strips:
        points = moved[layout.strip(name)].reshape(-1, 2)
        points[:] = points[order].copy()
    return moved


@pytest.mark.parametrize("name", GUESSES)
@pytest.mark.parametrize("control_points", [4, 6])
def test_bad_starts_recover(name, control_points):
    """Requirement: from any guess the primary state is found, by it or from rest, and it is said which."""
    pivot = cross_axis_pivot(**TABLE_ONE, control_points=control_points)
    right = solve_mechanism(pivot, rotation=1.2)
    layout = compile_scene(pivot.driven(1.2)).layout
    guess = GUESSES[name](right.states[-1], layout, np.random.default_rng(3))
    with np.errstate(all="ignore"):
        found = solve_from(pivot, rotation=1.2, guess=guess)
    assert np.abs(found.states[-1] - right.states[-1])[: layout.coordinate_count].max() < 1e-9
    assert abs(found.torque[-1] / right.states[-1][-1] - 1) < 1e-8
    by_guess = "found from the given state" in found.message
    assert by_guess or "solved from rest" in found.message
    if name in ("right", "perturbed"):
        assert by_guess


def test_wrong_branches_near_the_right_one_are_not_believed():
    """Requirement: other equilibria of the discrete strips that Newton finds are left for the right one."""
    pivot = cross_axis_pivot(**TABLE_ONE, control_points=6)
    system = compile_scene(pivot.driven(2.5))
    layout, work = system.layout, Followed.of(system)
    right, rng = solve_mechanism(pivot, rotation=2.5).states[-1], np.random.default_rng(1)
    others = []
    with np.errstate(all="ignore"):
        for _ in range(100):
            newton = solve(work, _shifted(right, layout, 0.01 * rng.standard_normal(right.size)), 1.0)
            away = np.abs(newton.z - right)[: layout.coordinate_count].max()
            others += [newton.z] if not newton.reason and away > 1e-4 else []
    assert len(others) > 2, "no other equilibria were found to start from"
    for z in others:
        found = solve_from(pivot, rotation=2.5, guess=z)
        assert np.abs(found.states[-1] - right)[: layout.coordinate_count].max() < 1e-9
        assert "solved from rest" in found.message


def test_a_pivot_wound_up_the_other_way_round_is_not_believed():
    """Requirement: the same pose reached by a turn less passes every local check, and is not believed."""
    pivot = cross_axis_pivot(**TABLE_ONE, control_points=16, gauss_points=32)
    wound = solve_mechanism(pivot, rotation=0.3 - 2 * math.pi, increments=72).states[-1].copy()
    system = compile_scene(pivot.driven(0.3))
    wound[system.layout.body("body").stop - 1] += 2 * math.pi
    work = Followed.of(system)
    assert solve(work, wound, 1.0).reason == ""
    found = solve_from(pivot, rotation=0.3, guess=wound)
    assert "another branch" in found.message
    assert found.torque[-1] == pytest.approx(solve_statics(pivot, rotation=0.3).torque[-1], rel=1e-9)


def test_a_start_that_is_no_state_is_refused():
    """Requirement: a path does not start from what is no equilibrium, and says what was expected."""
    pivot = cross_axis_pivot(**SIX)
    first = solve_statics(pivot, rotation=0.5, increments=5)
    other = cross_axis_pivot(**TABLE_ONE, control_points=7)
    with pytest.raises(InvalidParameter, match=r"start: .*expected finite unknowns of shape"):
        solve_statics(other, rotation=1.0, start=first)
    with pytest.raises(InvalidParameter, match=r"guess|start"):
        solve_from(pivot, rotation=1.0, guess=np.full(5, np.nan))


def test_beyond_what_can_be_reached_a_guess_is_refused():
    """Requirement: where nothing arrives, the reason and the last good state are given."""
    pivot = cross_axis_pivot(**TABLE_ONE, control_points=4)
    size = compile_scene(pivot.driven(3.0)).layout.size
    with pytest.raises(ConvergenceError, match="do not resolve the strips") as caught:
        solve_from(pivot, rotation=3.0, guess=np.zeros(size))
    assert 1.5 < caught.value.solution.rotation[-1] < 2.2


@pytest.mark.parametrize(
    ("settings", "line"),
    [
        ({"control_points": 8, "gauss_points": 5}, "5 Gauss points see 5 of 6 shapes of bending"),
        ({"control_points": 8, "gauss_points": 6}, "7 axial forces work on 6 strains only"),
        ({"control_points": 4, "gauss_points": 2, "stretch": "consistent"}, "2 of 3 shapes of stretching"),
        ({"control_points": 6, "slide_stiffness": 0.0}, "4 axial modes leave 1 of 5 strains free"),
        ({"control_points": 8, "axial_modes": 2, "slide_stiffness": 0.0}, "2 axial modes leave 5 of 7"),
        ({"control_points": 8, "basis": "bspline", "gauss_points": 1}, "5 Gauss points see 5 of 6 shapes"),
    ],
    ids=str,
)  # fmt: skip
def test_singular_discretisations_are_refused(settings, line):
    """Requirement: too few axial modes or Gauss points are refused at once, with the reason."""
    with pytest.raises(InvalidParameter, match=line):
        cross_axis_pivot(**TABLE_ONE, **settings)


@pytest.mark.parametrize("axial_modes", [1, 2, 3, 4, 5])
def test_few_and_many_axial_modes_are_followed_or_refused(axial_modes):
    """Requirement: any number of axial modes that is not refused reaches 90 deg and is nearly right."""
    answer = to(90, control_points=6, axial_modes=axial_modes)
    assert answer.status.value == "converged"
    assert abs(answer.torque[-1] / to(90, control_points=12).torque[-1] - 1) < 0.1


def weighed(control_points):
    """Moment defect of a cantilever that hangs far down under its own weight."""
    names = ("area", "second_moment_of_area", "youngs_modulus", "poisson_ratio", "density")
    strip = StripDesign(name="s", start=(0.0, 0.0), end=(0.1, 0.0), **{n: TABLE_ONE[n] for n in names})
    made = compliant_mechanism(
        strips=[strip],
        effects=("bending", "stretching", "gravity"),
        parameters={"gravity": {"acceleration": (0.0, -3e5)}},
        control_points=control_points,
    )
    return solve_mechanism(made, increments=1).moment_defect[0]


def test_weight_is_in_the_balance_of_moments():
    """Requirement: the moment defect counts the weight of a strip, and vanishes with more control points."""
    defects = [weighed(n) for n in (5, 7, 9)]
    assert defects[0] < 0.1
    assert defects[1] < 0.3 * defects[0]
    assert defects[2] < 0.3 * defects[1]


def test_a_batch_says_what_is_stable():
    """Requirement: many designs at once give inertia and moment defect of single solves, -1 behind a stop."""
    designs = [TABLE_ONE, TABLE_ONE | {"crossing_ratio": 0.3}]
    batch = solve_many(designs, rotation=2.5, increments=25, control_points=4)
    single = solve_statics(
        cross_axis_pivot(**TABLE_ONE, control_points=4), rotation=2.5, increments=25, raise_on_failure=False
    )
    done = batch.states[0]
    assert 1 < done < 26
    assert (batch.inertia[0, :done] == 0).all()
    assert (batch.inertia[0, done:] == -1).all()
    assert np.allclose(batch.moment_defect[0, :done], single.moment_defect[:done], rtol=1e-6)


def test_a_scene_that_nothing_lets_move_is_refused():
    """Requirement: a drive against inextensible strips that cannot give way is refused, with a reason."""
    line = "the tangent is singular|between load factor 0 and"  # which of both is up to round-off
    with pytest.raises((InvalidParameter, ConvergenceError), match=line):
        solve_statics(opposed(stretch="inextensible", control_points=10), rotation=-0.1)
