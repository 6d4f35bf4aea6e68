"""Sequential impulses in the suite: their motion is a neutral answer, their designs are what they say."""

import numpy as np
import pytest

from spline_model import natural_frequencies, solve_impulses
from spline_model.sequential_impulse import stability_limit
from studies.answers.models import put
from studies.answers.motion import Motion
from studies.cases.problem import named_case
from studies.convergence import impulse_steps
from studies.convergence.impulse_steps import GROUPS


def test_a_motion_by_impulses_is_a_neutral_answer():
    """A trajectory of impulses becomes the neutral motion of the other integrators."""
    asked = put(named_case(), impulse_steps.SETTINGS, moving=True)
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


@pytest.mark.parametrize("design", ["Table 1", "polymer"])
def test_groups_of_modes_are_apart(design):
    """Each group's fastest mode is of its kind: the limits fall from the swing to bending to stretching."""
    limits = [
        stability_limit(impulse_steps._pivot(design, GROUPS[group]))
        for group in ("swing", "bending", "axial")
    ]
    assert limits[0] > 20.0 * limits[1] > 400.0 * limits[2]
    swing = [
        natural_frequencies(impulse_steps._pivot(design, settings), count=1).frequency[0]
        for settings in GROUPS.values()
    ]
    assert np.ptp(swing) < 1e-3 * swing[0]
    assert len(natural_frequencies(impulse_steps._pivot(design, GROUPS["swing"])).frequency) == 1


def test_the_polymer_swings_at_a_few_hertz():
    """The soft design's swing can be seen at 25 pictures a second."""
    assert set(impulse_steps._designs()) == {"Table 1", "polymer"}
    assert 1.0 < natural_frequencies(impulse_steps._pivot("polymer"), count=1).frequency[0] < 5.0
