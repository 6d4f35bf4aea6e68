"""A motion that its discretisation does not resolve has a warning by default."""

import math

import numpy as np
import pytest

from fe_reference import InvalidParameter
from fe_reference import cross_axis_pivot as elements_pivot
from fe_reference import solve_release as release_elements
from spline_model import cross_axis_pivot, solve_release
from tests.table_one import TABLE_ONE


def test_swing_of_a_light_body_says_that_it_is_not_resolved():
    """Table 1 with a body of 0.4 times the mass of its strips, from 92 deg, is not resolved and has a
    warning."""
    light = TABLE_ONE | {"body_mass": 0.0265, "body_moment_of_inertia": 2.65e-5}
    motion = solve_release(cross_axis_pivot(**light), start=math.radians(92.0), duration=0.02)
    assert "the motion is not resolved" in motion.resolution
    assert motion.rotation_error > 0.2


def test_coarse_motion_says_so_by_default():
    """Four control points are told in the answer, with the difference; nothing was asked for."""
    motion = solve_release(cross_axis_pivot(**TABLE_ONE, control_points=4))
    assert "rotations are uncertain by up to" in motion.resolution
    assert motion.rotation_error > 0.05 * math.pi / 2.0


def test_resolved_motion_has_an_error_and_no_remark():
    """Six control points are enough for Table 1; the estimate is what eight make of it by the leapfrog."""
    motion = solve_release(cross_axis_pivot(**TABLE_ONE), duration=0.02)
    finer = solve_release(
        cross_axis_pivot(**TABLE_ONE, control_points=8),
        duration=0.02,
        integrator="leapfrog",
        step=1e-6,
        records=400,
        check=False,
    )
    assert motion.resolution == "" and math.isnan(finer.rotation_error)  # nobody asked for it
    exact = np.abs(motion.rotation - finer.rotation).max()
    assert motion.rotation_error == pytest.approx(exact, rel=0.05)


def test_explicit_run_of_too_many_steps_is_refused_before_it_starts():
    """A stiffly damped release that needs 5e9 explicit steps names the scheme that needs twenty thousand."""
    damped = {
        "effects": ("bending", "stretching", "strip_inertia", "body_inertia", "strip_damping"),
        "parameters": {"strip_damping": {"relaxation_time": 2e-3}},
    }
    pivot = elements_pivot(**TABLE_ONE, **damped)
    with pytest.raises(InvalidParameter) as refused:
        release_elements(pivot, start=0.1, duration=0.05, increments=2)
    assert "at most 2e+07 steps" in str(refused.value)
    assert "--integrator generalised-alpha takes about 2.3e+04" in str(refused.value)
    brief = {"start": 0.1, "duration": 1e-8, "increments": 2, "samples": 2}
    run = release_elements(pivot, **brief, most_steps=1000)
    assert 100 < run.counters["steps"] <= 1000
    with pytest.raises(InvalidParameter, match="at most 100 steps"):
        release_elements(pivot, **brief, most_steps=100)
