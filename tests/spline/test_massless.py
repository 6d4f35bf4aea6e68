"""Bodies on massless strips: steps of any length, stable equilibria alone, and a strip that snaps through."""

import math
import re
from functools import cache

import numpy as np
import pytest

from spline_model import cross_axis_pivot, natural_frequencies, solve_motion, solve_release
from tests import gates
from tests.spline.scenes import drift, pivot, total
from tests.table_one import SIX, TABLE_ONE

EFFECTS = ("bending", "stretching", "body_inertia")
SLENDER = TABLE_ONE | {
    "area": TABLE_ONE["area"] / 10.0,
    "second_moment_of_area": TABLE_ONE["second_moment_of_area"] / 1000.0,
}
LONG_STEP = 1.75e-3


def massless(design=TABLE_ONE, control_points=6, effects=EFFECTS, **more):
    """A pivot whose strips have no inertia."""
    return pivot(design, control_points=control_points, effects=effects, **more)


def pushed(step):
    """A damped pivot under a moment that grows all the time."""
    given = {
        "body_damping": {"translation": 2.0, "rotation": 0.1},
        "applied_moment": {"moment": 50.0, "history": ((0.0, 0.0), (4e-3, 1.0))},
    }
    made = massless(effects=(*EFFECTS, *given), parameters=given)
    return solve_motion(made, duration=4e-3, step=step, records=1)


@cache
def slender(control_points, step, duration):
    """Release of the ten times more slender pivot from a quarter turn."""
    made = massless(SLENDER, control_points, (*EFFECTS, "gravity"))
    return solve_release(made, start=math.pi / 2, duration=duration, step=step, check=False)


@pytest.mark.parametrize("steps", [200, 800])
@pytest.mark.parametrize("start", [0.1, 0.5236, 1.0])
def test_massless_strips_take_short_steps(start, steps):
    """Requirement: massless strips move at short steps as at long ones, and keep energy."""
    run = solve_release(massless(), start=start, duration=0.013 / 8, step=0.013 / steps)
    assert not run.message
    assert drift(run) < 1e-9  # three orders below a step of 1e-6 of the energy


def test_massless_strips_keep_the_books_of_dampers_and_loads():
    """Requirement: what a load does and dampers take is the change of energy, and errors fall as h^2."""
    coarse, fine, finest = (pushed(step) for step in (2e-4, 1e-4, 1e-5))
    for run in (coarse, fine):
        stored = np.ptp(total(run))
        assert 0.05 * stored < run.dissipated[-1] < run.work[-1]
        assert stored + run.dissipated[-1] == pytest.approx(run.work[-1], rel=1e-9)
    off, less = (abs(run.rotation[-1] - finest.rotation[-1]) for run in (coarse, fine))
    assert math.log2(off / less) == pytest.approx(2.0, abs=0.1)


def snapped(control_points, step):
    """Rotation [deg] at which the slender pivot's second strip snaps through, as the motion says it."""
    run = slender(control_points, step, 0.1)
    said = r"stopped at 0\.0957\d* s: strip_2 snaps through at (\S+) degrees of body: .*\(strip_inertia\)"
    match = re.fullmatch(said, run.message)
    assert match, run.message
    return float(match[1])


@pytest.mark.slow
def test_strip_that_snaps_through_is_named():
    """Requirement: a motion says which massless strip has no equilibrium to go on to, and at which rotation.

    More control points and shorter steps find it at the same one.
    """
    assert snapped(8, 1e-5) == pytest.approx(-0.437, rel=0.01)
    assert snapped(10, 5e-6) == pytest.approx(snapped(8, 1e-5), rel=0.01)


def test_strips_with_inertia_go_through_it():
    """Requirement: the motion that stops on massless strips goes on where they have their inertia."""
    made = pivot(SLENDER, effects=(*EFFECTS, "gravity", "strip_inertia"))
    run = solve_release(made, start=math.pi / 2, duration=0.1, step=LONG_STEP / 16, check=False)
    assert not run.message
    assert run.rotation[-1] < 0.0


def test_massless_strips_leave_the_body_alone_dynamic():
    """Requirement: without strip inertia three degrees of freedom are dynamic, and energy is kept."""
    massive = natural_frequencies(cross_axis_pivot(**SIX), count=1).frequency[0]
    modes = natural_frequencies(massless(), count=10)
    assert len(modes.frequency) == 3
    assert 0 < modes.frequency[0] / massive - 1 < 0.02  # the strips weigh a third of the body
    run = solve_release(massless(), start=1.2, duration=0.01)
    assert run.settings["integrator"] == "quasi-static strips"
    gates.check("spline_motion_balance", drift(run))
