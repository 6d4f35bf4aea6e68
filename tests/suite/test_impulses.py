"""Sequential impulses in the suite: their motion is a neutral answer."""

import pytest

from spline_model import solve_impulses
from studies.answers.models import put
from studies.answers.motion import Motion
from studies.answers.settings import SplineSettings
from studies.cases.problem import named_case


def test_a_motion_by_impulses_is_a_neutral_answer():
    """A trajectory of impulses becomes the neutral motion of the other integrators."""
    asked = put(named_case(), SplineSettings(control_points=6), moving=True)
    run = solve_impulses(asked.modelled, start=0.5, duration=0.05)
    answer = Motion.of(asked, run, wall_s=0.0, solve_s=0.0)
    assert answer.converged
    own = {
        "integrator": "sequential impulses, stable",
        "step_s": 0.01,
        "control_points": run.control_points,
    }
    assert answer.settings == asked.discretised(None) | own
    assert answer.rotation[0] == pytest.approx(0.5)
    assert "of the swing's period at rest" in answer.resolution
    assert 0.0 < answer.energy_error <= 1.0  # all that the damping of the swing takes
