"""Steps of sequential impulses: release and catch, several bodies, damping, weight, loads, refusals."""

import math
from functools import partial

import numpy as np
import pytest

from spline_model import (
    DrivenRotation,
    impulse_solver,
    solve_impulses,
    solve_motion,
)
from tests import gates
from tests.spline.scenes import POLYMER, QUARTER, pivot, total
from tests.table_one import TABLE_ONE

DAMPED = {
    "effects": (
        "bending",
        "stretching",
        "strip_inertia",
        "body_inertia",
        "strip_damping",
        "strip_drag",
        "body_damping",
        "gravity",
    ),
    "parameters": {
        "strip_damping": {"relaxation_time": 2e-6},
        "strip_drag": {"rate": 20.0},
        "body_damping": {"translation": 5.0, "rotation": 0.02},
    },
}


def pose_of(solver, state):
    """x, y and rotation of the body."""
    return state.z[solver.system.layout.body("body")].copy()


# ---- release and catch ----


@pytest.mark.parametrize("design", [TABLE_ONE, POLYMER], ids=["Table 1", "polymer"])
@pytest.mark.parametrize("turn", [-20.0, 20.0])
def test_catch_reaches_a_pose_that_is_20_degrees_away(design, turn):
    """Requirement: a swinging body goes to a static pose 20 degrees away within ten steps."""
    solver = impulse_solver(pivot(design))
    for count in (3, 12, 20):
        free = solver.step(solver.start(QUARTER), 0.01, count=count)
        there = pose_of(solver, solver.start(pose_of(solver, free.state)[2] + math.radians(turn)))
        caught = solver.step(free.state, 0.01, count=10, pose=there)
        assert caught.complete
        assert np.abs(pose_of(solver, caught.state) - there).max() < 1e-9
        quiet = solver.step(caught.state, 0.01, count=40, pose=there)
        assert quiet.kinetic_energy < 1e-3 * quiet.strain_energy


def caught_swing(step=2.5e-6):
    """Largest difference of a swing, re-clamped and released by a drive, to the energy-consistent
    integrator's."""
    chosen = pivot(control_points=4)
    drive = DrivenRotation(body="body", angle=0.0, held=(1e-3, 2e-3))
    options = {"start": 0.5, "drive": drive, "duration": 2.5e-3, "records": 25}
    exact = solve_motion(chosen, step=1e-6, **options)
    run = solve_impulses(chosen, step=step, **options)
    assert run.status.value == exact.status.value == "converged"
    held = (run.time > 1.05e-3) & (run.time < 1.95e-3)
    assert np.ptp(run.rotation[held]) < 1e-9
    return np.abs(run.rotation - exact.rotation).max()


def test_a_drive_that_begins_and_ends():
    """Requirement: a body caught, held and released in a run follows the other integrators' motion."""
    gates.hold("impulse_caught_swing", caught_swing)


# ---- more than a pivot ----


def balance_error(form, step=4e-6):
    """Error of the balance of energies over 5 ms with weight and every damping, over the energy."""
    chosen = pivot(control_points=4, **DAMPED)
    run = solve_impulses(chosen, start=1.0, duration=5e-3, step=step, form=form, records=50)
    assert run.status.value == "converged", run.message
    assert run.dissipated[-1] > 0.01 * total(run)[0]
    balance = total(run) + run.gravity_energy + run.dissipated - run.work
    return np.abs(balance - balance[0]).max() / balance[0]


@pytest.mark.parametrize("form", ["published", "stable"])
def test_damping_is_booked(form):
    """Requirement: what damping takes is counted, to the accuracy of the step."""
    gates.hold(f"impulse_{form}_balance", partial(balance_error, form))


def test_a_pivot_at_rest_under_its_weight_stays():
    """Requirement: equilibrium under weight is kept, without motion or energy, in ten thousand steps."""
    chosen = pivot(POLYMER, effects=("bending", "stretching", "strip_inertia", "body_inertia", "gravity"))
    run = solve_impulses(chosen, duration=100.0, records=100)
    assert np.abs(run.centre - run.centre[0]).max() < 1e-9
    assert run.kinetic_energy.max() < 1e-15 * run.strain_energy[0]


# ---- determinism and refusals ----


def test_the_same_state_gives_the_same_bits():
    """Requirement: a step changes neither its state nor its solver's later answers."""
    solver = impulse_solver(pivot())
    first = solver.start(1.0)
    copy = first.z.copy(), first.v.copy()
    ahead = solver.step(first, 1e-3, count=4)
    solver.step(ahead.state, 1e-2, count=4)
    again = solver.step(first, 1e-3, count=4)
    one_by_one = first
    for _ in range(4):
        one_by_one = solver.step(one_by_one, 1e-3).state
    assert (first.z == copy[0]).all() and (first.v == copy[1]).all()
    assert (again.state.z == ahead.state.z).all() and (again.state.v == ahead.state.v).all()
    assert np.abs(one_by_one.z - ahead.state.z).max() <= 1e-12 * np.abs(ahead.state.z).max()


def test_an_absurd_pose_is_refused_in_bounded_work():
    """Requirement: a pose that no strip reaches ends at the last good state after bounded work."""
    solver = impulse_solver(pivot())
    outcome = solver.step(solver.start(), 0.01, count=4, pose=np.array([5.0, 5.0, 30.0]))
    assert outcome.counters["solves"] < 4 * 64 * 12
    assert np.isfinite(outcome.state.z).all()
    if not outcome.complete:
        assert outcome.taken < 4
