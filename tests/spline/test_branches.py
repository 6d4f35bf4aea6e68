"""One branch whatever the increments: led bodies, weight and pre-strain, and what is said of buckling."""

import math

import numpy as np
import pytest

from spline_model import (
    BodyDesign,
    InvalidParameter,
    StripDesign,
    compliant_mechanism,
    cross_axis_pivot,
    solve_mechanism,
    solve_statics,
)
from tests import gates
from tests.spline.frames import column, toggle
from tests.table_one import TABLE_ONE

LENGTH = 0.1
SECTION = {
    "area": 5e-6,
    "second_moment_of_area": 0.01 * 0.5e-3**3 / 12,
    "youngs_modulus": 206e9,
    "density": 1e-3,
}
RIGIDITY = SECTION["youngs_modulus"] * SECTION["second_moment_of_area"]
# by collocation on the equations of the extensible elastica (scipy's solve_bvp, tolerance 1e-8)
LED_TIP = 15.204414550  # deg
HEAVY_TIPS = {3.0: -71.307634279, 5.0: -124.497920896}  # deg, by weight in EI/L^2


def one_strip(effects, parameters, *, end=(LENGTH, 0.0), centre=None, mass=0.0, **settings):
    """A straight strip of 0.1 m x 0.5 mm, clamped, with a body at its tip."""
    return compliant_mechanism(
        strips=[StripDesign(name="strip", start=(0.0, 0.0), end=end, tip="tip", **SECTION)],
        bodies=[BodyDesign(name="tip", centre=centre or end, mass=mass, moment_of_inertia=1e-6)],
        effects=("bending", "stretching", *effects),
        parameters=parameters,
        **settings,
    )


def led(displacement, **settings):
    """The strip as a cantilever whose tip is led, and free to turn."""
    given = {"driven_displacement": {"displacement": displacement}}
    return one_strip(given, given, **({"control_points": 10} | settings))


def heavy(weight, offset=1e-3, **settings):
    """The strip as an upright column under a body of a weight [EI/L^2], off its centre [m]."""
    given = {"gravity": {"acceleration": (0.0, -10.0)}}
    mass = weight * RIGIDITY / LENGTH**2 / 10.0
    more = {"end": (0.0, LENGTH), "centre": (offset, LENGTH), "mass": mass}
    return one_strip(given, given, **more, **({"control_points": 12} | settings))


def strained(compression, **settings):
    """The strip clamped at both ends and pushed together by a natural strain, in EI/L^2 of axial force."""
    strain = compression * RIGIDITY / (SECTION["youngs_modulus"] * SECTION["area"] * LENGTH**2)
    given = {"driven_displacement": {"displacement": (0.0, 0.0)}, "pre_strain": {"strain": strain}}
    return one_strip(given, given, **({"control_points": 10} | settings))


def tip(answer, state=-1):
    """Rotation of the tip's body [deg]."""
    return math.degrees(answer.bodies["tip"][state, 2])


def led_error(**settings):
    """Largest error of the led tip's rotation [deg] over numbers of increments."""
    answers = [solve_mechanism(led((-1.3e-3, 13e-3), **settings), increments=n) for n in (1, 5, 20, 200)]
    assert all(answer.inertia.max() == 0 for answer in answers)
    assert all(answer.critical_points == () for answer in answers)
    assert all(answer.message == "" for answer in answers)
    return max(abs(tip(answer) - LED_TIP) for answer in answers)


def test_a_led_tip_is_where_it_is_whatever_the_increments():
    """Requirement: a tip that is led into buckling bends to the stable branch, in 1 to 200 increments."""
    gates.hold("spline_led_tip", led_error)


@pytest.mark.slow
@pytest.mark.parametrize("control_points", [6, 7, 8, 10, 12])
def test_a_led_tip_has_one_energy(control_points):
    """Requirement: 5, 20, 200 and 1000 increments lead to one state, with 6 to 12 control points."""
    made = led((-1.3e-3, 13e-3), control_points=control_points)
    answers = [solve_mechanism(made, increments=n) for n in (5, 20, 200, 1000)]
    stored = np.array([a.bending_energy[-1] + a.axial_energy[-1] for a in answers])
    assert np.ptp(stored) < 1e-9 * stored[0]
    assert abs(stored[0] / 9.472e-3 - 1) < 1e-3


def led_work(late=0):
    """Largest difference of the work on a led tip and the energy stored, relative."""
    worst = 0.0
    for count in (5, 20, 200):
        answer = solve_mechanism(led((-1.3e-3, 13e-3)), increments=count)
        stored = answer.bending_energy + answer.axial_energy
        worst = max(worst, abs(answer.work[-1 - late] / stored[-1] - 1))
    return worst


def test_work_on_a_led_tip_is_the_energy_stored():
    """Requirement: the work of a led path is the energy it stores, in few increments as in many."""
    gates.hold("spline_led_work", led_work)


def test_a_led_pivot_has_one_torque():
    """Requirement: Table 1 led by (0.5, -0.5) mm and 20 deg has one torque in 1, 2, 4 and 20 increments."""
    given = {"driven_displacement": {"displacement": (5e-4, -5e-4)}}
    pivot = cross_axis_pivot(
        **TABLE_ONE, control_points=8, effects=("bending", "stretching", *given), parameters=given
    )
    angle = math.radians(20)
    torques = [solve_statics(pivot, rotation=angle, increments=n).torque[-1] for n in (1, 2, 4, 20)]
    assert max(torques) - min(torques) < 1e-9 * max(torques)
    assert 14400 < torques[0] < 14500


def heavy_error(**settings):
    """Largest error of the heavy columns' tips at load factor 0 [deg]."""
    answers = {weight: solve_mechanism(heavy(weight, **settings), increments=1) for weight in HEAVY_TIPS}
    assert all(answer.inertia.max() == 0 and answer.message == "" for answer in answers.values())
    return max(abs(tip(answers[weight], 0) - right) for weight, right in HEAVY_TIPS.items())


def test_a_heavy_column_sinks_to_its_stable_side():
    """Requirement: a column under more than its critical weight, off its centre, hangs down on that side."""
    gates.hold("spline_heavy_column", heavy_error)


def test_a_mirrored_column_sinks_to_the_other_side():
    """Requirement: the column whose body sits on the other side sinks to that side."""
    one, other = (solve_mechanism(heavy(5.0, offset), increments=1) for offset in (1e-3, -1e-3))
    assert abs(tip(one) + tip(other)) < 1e-6


@pytest.mark.parametrize("control_points", [8, 10])
def test_weight_beyond_a_limit_point_is_refused_there(control_points):
    """Requirement: a toggle of twice the weight that it bears is refused where it snaps, at 56.5 % of it."""
    made = toggle(control_points=control_points)
    heavy_apex = compliant_mechanism(
        strips=[replace_density(strip) for strip in made.design.strips],
        bodies=[BodyDesign(name="apex", centre=made.design.bodies[0].centre, mass=60.0)],
        effects=("bending", "stretching", "gravity"),
        parameters={"gravity": {"acceleration": (0.0, -1.0)}},
        control_points=control_points,
    )
    with pytest.raises(InvalidParameter, match=r"56\.5\d* % of weight .*it buckles, a limit point"):
        solve_mechanism(heavy_apex)


def replace_density(strip):
    """The strip, next to weightless."""
    return StripDesign(
        name=strip.name,
        start=strip.start,
        end=strip.end,
        tip=strip.tip,
        area=strip.area,
        second_moment_of_area=strip.second_moment_of_area,
        youngs_modulus=strip.youngs_modulus,
        density=1e-12,
    )


def test_an_upright_column_that_buckles_says_so():
    """Requirement: a centred column far beyond its critical weight stays upright, and is called unstable."""
    answer = solve_mechanism(heavy(30.0, 0.0), increments=2)
    assert abs(tip(answer)) < 1e-6
    assert answer.inertia.min() == 2
    assert "bifurcation at 8.22" in answer.message  # pi^2 / 4 of 30
    assert "it buckles" in answer.message
    assert "the last state is unstable" in answer.message


@pytest.mark.parametrize("control", ["load", "arc-length"])
def test_a_column_may_leave_its_upright_branch_as_its_weight_grows(control):
    """Requirement: branch = "follow" leads a centred heavy column onto its stable, bent branch."""
    answer = solve_mechanism(heavy(3.0, 0.0), increments=1, branch="follow", control=control)
    assert answer.inertia.max() == 0
    assert "goes on along the branch" in answer.message
    assert abs(tip(answer)) > 60  # deg


def buckling_share(**settings):
    """Error of the share of a pre-strain of 41 EI/L^2 at which the clamped strip is said to buckle, relative.

    Euler: 4 pi^2 of 41; the strip's own shortening is that of its strain, and is held.
    """
    message = solve_mechanism(strained(41.0, **settings), rotation=0.0, increments=1).message
    share = float(message.partition("bifurcation at ")[2].partition(" %")[0]) / 100
    return abs(share * 41.0 / (4 * math.pi**2) - 1)


def test_a_strip_pre_strained_beyond_euler_says_so():
    """Requirement: a clamped strip is told to buckle where its pre-strain has Euler's force."""
    gates.hold("spline_pre_strained_buckling", buckling_share)
    for compression in (41.0, 80.0):
        answer = solve_mechanism(strained(compression), rotation=0.0, increments=1)
        assert "the last state is unstable: it buckles" in answer.message
        assert answer.inertia.min() == 1
    assert "bifurcation" not in solve_mechanism(strained(39.0), rotation=0.0, increments=1).message


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


def test_a_stopped_path_says_that_it_buckles():
    """Requirement: a path that ends at a limit point of its load says so, with the load."""
    answer = solve_mechanism(toggle(control_points=8), raise_on_failure=False)
    assert "it buckles, a limit point" in answer.message
    assert "force 33.9" in answer.message
