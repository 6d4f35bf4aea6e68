"""Strips by their sides: clamps over the whole width and anticlastic bending, in a scene and in a batch."""

import numpy as np
import pytest

import spline_model
from spline_model import (
    DEFAULT_EFFECTS,
    cross_axis_pivot,
    solve_mechanism,
    solve_motion,
)
from tests.agreement.test_section_laws import strips
from tests.spline.swings import drift
from tests.table_one import BARE

CLAMPED = (*DEFAULT_EFFECTS, "clamped_width")
CURLING = (*CLAMPED, "anticlastic")


def thin_pivot(width, **changed):
    """A pivot of strips so thin that stretch is out of sight, whose clamps hold the whole width."""
    given = {"width": width, "thickness": 1e-4, "effects": CLAMPED, "control_points": 8}
    return cross_axis_pivot(**BARE | given | changed)


def test_roll_up_reports_the_moment_that_bends_it():
    """Sections carry the moment of the law, which is that of balance, and the energy is its work."""
    made = strips(spline_model, 0.3, 0.3**2 * 0.5 / 20.0, effects=("anticlastic",))
    path = solve_mechanism(made, rotation=0.5, increments=40)
    assert path.bending_moment[-1] == pytest.approx(np.full_like(path.bending_moment[-1], path.torque[-1]))
    assert path.bending_energy[-1] == pytest.approx(path.work[-1], rel=1e-4)


@pytest.mark.parametrize("step", [5e-5, 1e-3])
def test_motion_keeps_its_energy(step):
    """The default motion loses and gains no energy with both effects of the curl, in steps of any length."""
    body = {"body_mass": 0.05, "body_moment_of_inertia": 1e-4, "control_points": 6}
    pivot = thin_pivot(0.02, thickness=1e-3, effects=CURLING, **body)
    run = solve_motion(pivot, start=np.pi / 2, duration=5 * step, step=step, check=False)
    assert drift(run) < 1e-10
