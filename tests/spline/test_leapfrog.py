"""The leapfrog: energy, agreement with the energy-consistent scheme, scenes of all kinds."""

from functools import cache

import numpy as np
import pytest

from spline_model import Status, cross_axis_pivot, solve_release
from tests import gates
from tests.spline.swings import QUARTER, drift, pivot
from tests.table_one import TABLE_ONE


def swing(step, duration=0.004, integrator="leapfrog", **more):
    """Rotation at 100 records."""
    return solve_release(
        pivot(**more),
        start=QUARTER,
        duration=duration,
        step=step,
        records=100,
        integrator=integrator,
        check=False,
    )


@cache
def reference():
    """Rotation by short energy-consistent steps, 4 ms."""
    return swing(1e-7, integrator="energy").rotation


def difference_to_energy(step=1e-6):
    """Largest difference of the rotation to the reference's."""
    return np.abs(swing(step).rotation - reference()).max()


def test_leapfrog_agrees_with_the_energy_consistent_scheme():
    """Requirement: both schemes, which share no time step, tend to one trajectory."""
    gates.hold("spline_leapfrog_agrees", difference_to_energy)


def test_default_step_is_stable_and_a_long_one_says_so():
    """Requirement: the step from the highest frequency works; a step above the limit ends with a reason."""
    run = solve_release(pivot(), duration=0.002, integrator="leapfrog")
    assert run.status is Status.CONVERGED
    assert 3e-6 < run.settings["step_s"] < 6e-6
    run = swing(1e-5)
    assert run.status is Status.NOT_CONVERGED
    assert "take a shorter step" in run.message


@pytest.mark.parametrize(
    "more",
    [
        {"stretch": "consistent"},
        {"stretch": "inextensible"},
        {"segments": 2, "control_points": 5},
        {"effects": ("bending", "stretching", "strip_inertia", "body_inertia", "gravity")},
    ],
    ids=["consistent", "inextensible", "segments", "gravity"],
)
def test_all_free_scenes_move(more):
    """Requirement: both schemes tend to one trajectory in every basis and axial form."""
    steps = {"leapfrog": 1e-6, "energy": 2.5e-7}
    pair = [swing(step, 2e-4, name, **more).rotation for name, step in steps.items()]
    gates.check("spline_leapfrog_agrees", np.abs(pair[0] - pair[1]).max())


def energy_of_inextensible(step=5e-6):
    """Largest change of the energy of strips that cannot stretch, over it."""
    stiff = cross_axis_pivot(**TABLE_ONE, control_points=6, stretch="inextensible")
    run = solve_release(stiff, duration=0.01, start=1.0, step=step, integrator="leapfrog", check=False)
    assert run.status is Status.CONVERGED
    return drift(run)


def test_inextensible_strips_keep_energy():
    """Requirement: strips that cannot stretch move on their own steps, and the forces in them do no work."""
    gates.hold("spline_inextensible_leapfrog_energy", energy_of_inextensible)
