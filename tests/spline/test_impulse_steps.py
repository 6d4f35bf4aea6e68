"""Steps of sequential impulses: damping, weight, supports, loads and determinism."""

from functools import partial

import numpy as np
import pytest

from spline_model import solve_impulses, solve_motion
from spline_model.impulses.arrays import SOLVES
from tests import gates
from tests.spline.swings import POLYMER, pivot, stepper, total

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


def test_supports_hold_and_loads_work():
    """Requirement: a body on a support under a constant load swings as by the other integrator."""
    effects = ("bending", "stretching", "strip_inertia", "body_inertia", "support", "applied_moment")
    given = {"support": {"fixed": ("y",)}, "applied_moment": {"moment": 0.02}}
    chosen, options = pivot(effects=effects, parameters=given), {"start": 0.05, "duration": 2e-3}
    exact = solve_motion(chosen, step=2e-6, records=20, check=False, **options)
    run = solve_impulses(chosen, step=1e-5, records=20, **options)
    assert np.abs(run.centre[:, 1] - run.centre[0, 1]).max() < 1e-12
    assert np.abs(run.rotation - exact.rotation).max() < 1e-3 * np.ptp(exact.rotation)
    assert np.abs(run.work - exact.work).max() < 1e-3 * np.abs(exact.work).max()
    assert np.diff(total(run) - run.work).max() < 1e-13 * total(run)[0]


# ---- determinism ----


def test_the_same_state_gives_the_same_bits():
    """Requirement: steps taken again from a state that was kept lead to the same bits, one by one or not."""
    swing = stepper(pivot(), 1.0)
    first, none = swing.kept(), np.zeros((0, swing.width))
    swing.take(0.0, 1e-3, 0, 4, 5, none)
    ahead = swing.state.z.copy()
    swing.take(0.0, 1e-2, 0, 4, 5, none)
    swing.take_back(first)
    swing.take(0.0, 1e-3, 0, 4, 5, none)
    assert (swing.state.z == ahead).all()
    swing.take_back(first)
    for _ in range(4):
        swing.advance(0.0, 1e-3)
    assert np.abs(swing.state.z - ahead).max() <= 1e-12 * np.abs(ahead).max()


def test_an_absurd_step_is_refused_in_bounded_work():
    """Requirement: a velocity that no strip can follow ends at the last good state after bounded work."""
    swing = stepper(pivot(), 0.0)
    swing.state.v[:] = 1e9
    before = swing.state.z.copy()
    assert not swing.advance(0.0, 0.01)
    assert swing.counters[SOLVES] < 64 * 12
    assert (swing.state.z == before).all()
