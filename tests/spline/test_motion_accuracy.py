"""Accuracy on request in motion: steps and control points until the estimated error is below it."""

from functools import cache

import numpy as np
import pytest

from spline_model import Status, solve_release
from tests import gates
from tests.spline.scenes import pivot

#: Half a swing [s].
DURATION = 0.006
HEAVY = ("bending", "stretching", "strip_inertia", "body_inertia", "gravity")


def released(n=6, **settings):
    """The release of Table 1 from a quarter turn, or with other settings."""
    options = {"duration": DURATION} | {
        name: settings.pop(name)
        for name in ("duration", "accuracy", "records", "integrator", "step", "start")
        if name in settings
    }
    return solve_release(pivot(control_points=n, **settings), **options)


@cache
def exact():
    """The swing with ten control points and explicit steps; eight move it by less than 1e-4 rad."""
    return released(10, integrator="leapfrog", step=1e-6)


def true_error(trajectory, reference=None):
    """Largest error of the rotation at the trajectory's instants [rad]."""
    reference = exact() if reference is None else reference
    return np.abs(trajectory.rotation - np.interp(trajectory.time, reference.time, reference.rotation)).max()


@pytest.mark.parametrize("n", [4, 6])
@pytest.mark.parametrize("accuracy", [3e-2, 1e-2, 3e-3])
def test_wanted_accuracy_is_met_and_estimated(n, accuracy):
    """Requirement: the true error is below what was asked for, and the estimate within its band."""
    trajectory = released(n, accuracy=accuracy)
    assert trajectory.status is Status.CONVERGED
    assert trajectory.estimate.rotation <= accuracy
    error = true_error(trajectory)
    gates.check("spline_motion_accuracy_request", error / accuracy)
    gates.check("spline_motion_accuracy_optimism", error / trajectory.estimate.rotation)
    gates.check("spline_motion_accuracy_pessimism", trajectory.estimate.rotation / error)


def test_wrong_estimates_are_seen():
    """Requirement: the checks see an estimate by steps alone, and motions of other errors than estimated."""

    def optimism(control_points):
        coarse, fine = (released(control_points, step=step, records=60) for step in (1e-4, 5e-5))
        return true_error(fine) / np.abs(coarse.rotation - fine.rotation).max()

    gates.refuse("spline_motion_accuracy_optimism", optimism)
    gates.refuse("spline_motion_accuracy_request", lambda step: true_error(released(4, step=step)) / 1e-2)
    gates.refuse("spline_motion_accuracy_pessimism", lambda step: 1e-1 / true_error(released(10, step=step)))


def test_records_are_thinned_not_the_comparison():
    """Requirement: few records are those of the whole run, and do not blind the estimate."""
    few, many = (released(accuracy=1e-2, records=records) for records in (2, 64))
    assert len(few.time) == 3
    assert len(many.time) == 65
    assert few.states.shape[0] == few.bodies["body"].shape[0] == len(few.kinetic_energy) == 3
    assert few.estimate.rotation == pytest.approx(many.estimate.rotation, rel=1e-12)
    assert np.array_equal(few.rotation, many.rotation[::32])


@pytest.mark.parametrize(
    "settings",
    [
        {"stretch": "inextensible"},
        {"effects": ("bending", "stretching", "body_inertia")},
        {"effects": HEAVY},
        {
            "effects": ("bending", "stretching", "strip_inertia", "body_inertia", "strip_damping"),
            "parameters": {"strip_damping": {"relaxation_time": 1e-6}},
        },
    ],
    ids=["inextensible", "massless strips", "gravity", "damping"],
)
def test_other_scenes_have_an_estimate_too(settings):
    """Requirement: scenes without explicit steps, with weight or with losses are solved to an accuracy."""
    trajectory = released(accuracy=3e-2, duration=0.003, **settings)
    assert trajectory.status is Status.CONVERGED
    finer = released(8, duration=0.003, step=1.25e-5, **settings)
    gates.check("spline_motion_accuracy_request", true_error(trajectory, finer) / 3e-2)


def test_accuracy_out_of_reach_is_said():
    """Requirement: the best motion is returned with its estimate and the reason; nothing is claimed."""
    trajectory = released(4, accuracy=1e-13, duration=5e-4)
    assert trajectory.status is Status.NOT_CONVERGED
    assert "accuracy 1e-13 rad is not reached: the estimated error is" in trajectory.message
    assert 1e-13 < trajectory.estimate.rotation < 1e-2
    assert trajectory.time[-1] == pytest.approx(5e-4)
