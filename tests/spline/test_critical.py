"""Critical points of paths: found, located, named, the same on both paths; and paths through limit points."""

import math

import numpy as np
import pytest

import spline_model
from spline_model import cross_axis_pivot, solve_statics
from studies.answers.models import put
from studies.answers.settings import SplineSettings
from studies.published.case import published
from tests import gates
from tests.frames import column, heavy, one_strip, opposed, tip
from tests.table_one import SECTION, SIX, TABLE_ONE

TWO_LIMITS = ("limit point", "limit point")


def test_the_mode_of_a_column_is_a_quarter_wave():
    """Requirement: the critical mode moves the tip across and not along, and turns it as a sine does."""
    answer = solve_statics(column(load=4.0, slenderness=1e4, control_points=6), increments=7)
    (point,) = answer.critical_points
    along, across, turn = point.mode[answer.system.layout.body("tip")]
    assert abs(along) < 1e-6
    assert abs(turn / across - math.pi / 2) < 1e-3


@pytest.mark.parametrize("branch", ["primary", "follow"])
def test_load_control_and_arc_length_end_alike(branch):
    """Requirement: a branch without limit points ends in the same state in either control."""
    made = column(load=4.0, control_points=8)
    by_load, by_arc = (
        solve_statics(made, control=control, branch=branch) for control in ("load", "arc-length")
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
    perfect = solve_statics(column(load=4.0, control_points=8), branch="follow")
    found = solve_statics(column(load=4.0, control_points=8, side=side), increments=increments)
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
    answer = solve_statics(made, increments=1, branch="follow", control=control)
    assert answer.inertia.max() == 0
    assert "goes on along the branch" in answer.message
    assert abs(tip(answer)) > 60  # deg


def lees_frame(control_points):
    """Lee's frame of the published problems, its load of 3 t at load factor 1."""
    design = published("lees_frame").frame().design
    return put(design, SplineSettings(control_points=control_points)).modelled


def test_a_load_that_turns_round_keeps_its_sign():
    """Requirement: with default settings Lee's frame is followed through loads below zero, told with sign."""
    path = solve_statics(lees_frame(control_points=None), control="arc-length")
    assert path.estimate.accuracy == 1e-4 and path.resolution == ""
    assert [point.kind for point in path.critical_points] == ["limit point", "limit point"]
    assert path.load_factor.min() < -0.3
    assert "load factor -0.3138" in path.message


def work_balance(late=0):
    """Work of the load on Lee's frame, some states late, against the energy stored at the end of its path."""
    path = solve_statics(lees_frame(control_points=10), control="arc-length")
    return abs(path.work[-1 - late] / path.energies[-1].sum() - 1)


def test_work_is_booked_through_limit_points():
    """Requirement: along a path whose load goes up, down and up again the work is the energy stored."""
    gates.hold("spline_arc_length_work", work_balance)


MOMENT = 100.0  # N m
FORCE = {"force": (3000.0, 5000.0)}
LED = {"displacement": (5e-4, -5e-4)}
LOADS = {
    "moment": {"applied_moment": {"moment": MOMENT}},
    "force": {"applied_force": FORCE},
    "led": {"driven_displacement": LED},
    "all": {
        "applied_moment": {"moment": -60.0},
        "applied_force": FORCE,
        "gravity": {"acceleration": (300.0, -500.0)},
        "pre_strain": {"curvature": 1.0, "strain": 1e-4},
    },
}


def loaded(parameters, **settings):
    """The pivot of Table 1 under loads, by the names and parameters of their effects."""
    effects = ("bending", "stretching", *parameters)
    return cross_axis_pivot(
        **(TABLE_ONE | {"control_points": 8} | settings), effects=effects, parameters=parameters
    )


def turned(parameters, degrees, **how):
    """The loaded pivot's path to a rotation [deg], its loads growing with it."""
    how = {"increments": 5, "order": "together"} | how
    return solve_statics(loaded(parameters), rotation=math.radians(degrees), **how)


@pytest.mark.parametrize("name", ["moment", "force"])
def test_a_path_there_and_back_carries_the_load_with_it(name):
    """Requirement: loads go with the size of the rotation over the largest; work is energy."""
    legs = [math.radians(d) for d in (-10.0, -30.0, -5.0)]
    path = solve_statics(loaded(LOADS[name]), rotation=legs, increments=3, order="together")
    assert np.allclose(path.load_factor, np.abs(path.rotation) / math.radians(30))
    direct = turned(LOADS[name], -30.0)
    row = int(np.argmin(path.rotation))
    assert abs(path.torque[row] / direct.torque[-1] - 1) < 1e-9
    energy = path.bending_energy + path.axial_energy
    assert np.abs(path.work - energy).max() < 1e-3 * energy.max()


def test_a_held_pivot_tips_where_its_own_stiffness_vanishes():
    """Requirement: under growing loads a limit of the torque is where the stiffness vanishes, in newtons."""
    made = loaded({"applied_force": {"force": (0.0, -5e4)}})
    answers = [solve_statics(made, rotation=0.0, increments=count) for count in (3, 10)]
    answers.append(solve_statics(made, rotation=math.radians(0.01), increments=10))
    factors = []
    for answer in answers:
        (point,) = answer.critical_points
        assert point.kind == "limit point"
        assert "stiffness vanishes" in answer.message
        assert f"force {5e1 * point.load_factor:.4g} kN" in answer.message
        factors.append(point.load_factor)
    assert max(factors) - min(factors) < 1e-4
    free = solve_statics(made, increments=10, raise_on_failure=False)
    assert abs(free.critical_points[0].load_factor - factors[0]) < 1e-4


def test_a_ramp_of_load_makes_no_limit_of_the_torque():
    """Requirement: where the torque turns because a moment grows beside it, there is no limit point."""
    answer = turned({"applied_moment": {"moment": 270.0}}, 30.0, increments=20)
    assert (np.diff(answer.torque) < 0).any()
    assert (np.diff(answer.torque) > 0).any()
    assert answer.critical_points == ()
    assert answer.message == ""


def first(name, degrees, **how):
    """The path under loads that come on before the rotation [deg]."""
    return solve_statics(loaded(LOADS[name]), rotation=np.radians(degrees), **({"increments": 4} | how))


@pytest.mark.parametrize("name", [name for name in LOADS if name != "led"])
def test_loads_come_on_first_and_stay(name):
    """Requirement: the body is held while loads grow; they are in full on the rotation, whatever its sign."""
    path = first(name, [20.0, -30.0])
    assert np.allclose(path.load_factor, np.minimum(np.arange(13) / 4, 1.0))
    assert np.allclose(np.degrees(path.rotation[4:]), [*np.linspace(0, 20, 5), *np.linspace(20, -30, 5)[1:]])
    assert not path.rotation[:4].any()
    for row, degrees in ((8, 20.0), (12, -30.0)):
        direct = turned(LOADS[name], degrees)
        for quantity in ("torque", "stiffness"):
            assert abs(getattr(path, quantity)[row] / getattr(direct, quantity)[-1] - 1) < 1e-8
    energy = path.bending_energy + path.axial_energy + path.gravity_energy
    assert np.abs(path.work - (energy - energy[0])).max() < 1e-3 * energy.max()


def test_loads_first_by_both_methods_and_for_any_mechanism():
    """Requirement: the paper's bordered system and the mechanism of one body have the same path."""
    path, other = first("all", -25.0), first("all", -25.0, method="multipliers")
    body = solve_statics(loaded(LOADS["all"]), rotation=math.radians(-25.0), increments=4)
    for same in (other, body):
        assert np.allclose(same.torque, path.torque, rtol=0, atol=1e-9 * np.abs(path.torque).max())
        assert np.array_equal(same.load_factor, path.load_factor)


METHODS = ("condensed", "multipliers")


def to(degrees, *, increments=36, method="condensed", **settings):
    """Table 1 driven to a rotation [deg]; a stopped path is returned."""
    pivot = cross_axis_pivot(**(SIX | settings))
    return solve_statics(
        pivot, rotation=math.radians(degrees), increments=increments, method=method, raise_on_failure=False
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
    return solve_statics(made, increments=1).moment_defect[0]


def test_weight_is_in_the_balance_of_moments():
    """Requirement: the moment defect counts the weight of a strip, and vanishes with more control points."""
    defects = [weighed(n) for n in (5, 7, 9)]
    assert defects[0] < 0.1
    assert defects[1] < 0.3 * defects[0]
    assert defects[2] < 0.3 * defects[1]
