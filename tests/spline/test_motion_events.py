"""Sudden events in a motion, the energy monitor, restart, bounded work and frequencies beyond a step."""

import math
from functools import cache, partial

import numpy as np
import pytest

from spline_model import DrivenRotation, InvalidParameter, solve_motion, solve_release
from tests import gates
from tests.spline import scenes

EFFECTS = ("bending", "stretching", "strip_inertia", "body_inertia")


pivot = partial(scenes.pivot, control_points=4)
#: A moment that sets in between two steps, and one that grows all the time.
SUDDEN, GROWING = ((0.0, 0.0), (1.0003e-3, 0.0), (1.0003e-3 + 1e-9, 1.0)), ((0.0, 0.0), (4e-3, 1.0))


def under(history):
    """What a pivot under a moment with a history is given."""
    return {
        "effects": (*EFFECTS, "applied_moment"),
        "parameters": {"applied_moment": {"moment": 50.0, "history": history}},
    }


@cache
def turned(history, step):
    """Rotation at the end, after a moment with a history [rad]."""
    return solve_motion(pivot(**under(history)), duration=4e-3, step=step, records=1).rotation[-1]


@pytest.mark.parametrize("history", [SUDDEN, GROWING], ids=["sudden", "growing"])
def test_a_load_in_time_keeps_the_order(history):
    """Requirement: a moment that sets in between two steps, or grows, leaves an error that falls as h^2."""

    def error(step=5e-5):
        """Relative error of the rotation, against a fine grid."""
        return abs(turned(history, step) / turned(history, 5e-6) - 1.0)

    assert math.log(error(2e-4) / error(), 4.0) > 2 - 0.3, (error(2e-4), error())
    gates.hold("spline_sudden_load", error)


def test_a_drive_off_the_grid_ends_where_it_should():
    """Requirement: a drive that begins, turns and ends between steps is followed, and the books close."""
    corners = ((0.00203, 0.0), (0.00307, 0.2), (0.00411, -0.1))
    drive = DrivenRotation(body="body", angle=1.0, history=corners, held=(0.00203, 0.00411))
    run = solve_motion(pivot(), drive=drive, duration=6e-3, step=5e-5)
    assert not run.message
    inside = (run.time > 0.00204) & (run.time < 0.0041)
    wanted = np.interp(run.time[inside], *zip(*corners, strict=True))
    assert np.abs(run.rotation[inside] - wanted).max() < 1e-10  # tolerance of a step's constraints, rad
    books = run.kinetic_energy + run.strain_energy - run.work + run.dissipated
    assert np.abs(books - books[0]).max() < 1e-9 * np.abs(run.work).max()


@pytest.mark.parametrize(
    ("settings", "how", "apart"),
    [
        ({}, {"step": 5e-5}, 1e-11),
        (under(GROWING), {"step": 5e-5}, 1e-11),
        ({}, {"step": 1e-6, "integrator": "leapfrog"}, 1e-7),  # extrapolates its centripetal terms
    ],
    ids=["free", "loaded", "leapfrog"],
)
def test_a_motion_goes_on_where_another_ended(settings, how, apart):
    """Requirement: two halves, one after the other, are the whole run, work and the loads' clock included."""
    given = pivot(**settings)
    whole = solve_release(given, start=1.0, duration=4e-3, check=False, **how)
    half = solve_release(given, start=1.0, duration=2e-3, check=False, **how)
    rest = solve_motion(given, after=half, duration=2e-3, **how)
    assert rest.time[0] == pytest.approx(half.time[-1]) and rest.time[-1] == pytest.approx(whole.time[-1])
    assert abs(rest.rotation[-1] - whole.rotation[-1]) < apart
    assert abs(rest.work[-1] - whole.work[-1]) <= 1e-11 * whole.strain_energy[0]
    with pytest.raises(InvalidParameter, match="after: got 'a motion of another mechanism'"):
        solve_motion(pivot(control_points=5), after=half, duration=1e-3)


def test_the_monitor_stops_a_run_that_gains_energy(monkeypatch):
    """Requirement: a run whose energy grows is stopped at the last good record, with the reason."""
    # a Newton that hardly solves its steps
    monkeypatch.setattr("spline_model.motion.energy_consistent.TOLERANCE", 1e-3)
    run = solve_release(pivot(), duration=0.02, step=5e-5)
    assert run.status.value == "not_converged"
    assert "the energy grows by more than 1e-06 of itself" in run.message
    stored = scenes.total(run)
    assert (stored <= stored[0] * (1 + 1e-6)).all()


def test_a_long_step_names_the_mode_that_it_leaves_out():
    """Requirement: a step too long for a mode that has energy names the mode, and the step that it takes."""
    run = solve_release(pivot(control_points=6), duration=2e-4, step=2e-4)
    assert "mode 2 (bending, 850 Hz" in run.resolution and "take 5.9e-05 s or less" in run.resolution
