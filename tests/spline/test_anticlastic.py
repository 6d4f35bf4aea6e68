"""Strips by their sides: clamps over the whole width and anticlastic bending, in a scene and in a batch."""

import numpy as np
import pytest

import spline_model
from spline_model import (
    DEFAULT_EFFECTS,
    cross_axis_pivot,
    solve_many,
    solve_mechanism,
    solve_motion,
    solve_statics,
)
from tests.agreement.test_section_laws import strips
from tests.spline.swings import drift
from tests.table_one import BARE

CLAMPED = (*DEFAULT_EFFECTS, "clamped_width")
CURLED, CURLING = (*DEFAULT_EFFECTS, "anticlastic"), (*CLAMPED, "anticlastic")


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


def test_curl_never_exceeds_the_plate():
    """With both effects no strip is stiffer than one that is held flat, and each adds to the other."""
    flat, torque = 1.0 / (1.0 - BARE["poisson_ratio"] ** 2), []
    for effects in (DEFAULT_EFFECTS, CLAMPED, CURLED, CURLING):
        pivot = thin_pivot(0.02, thickness=5e-4, effects=effects)
        torque.append(solve_statics(pivot, rotation=1.0, increments=4).torque[-1])
    plain, clamped, curved, both = np.array(torque) / torque[0]
    assert 1.0 == plain < clamped < curved < both < flat


@pytest.mark.parametrize(
    ("effects", "changed"),
    [
        (CLAMPED, {"thickness": 2e-4, "youngs_modulus": 1e11}),
        (CURLED, {"thickness": 3e-4, "width": 0.02}),
    ],
)
def test_a_batch_has_the_profile_and_the_curl_of_its_designs(effects, changed):
    """Designs of other sides keep the plate's profile in a batch, as b/L stays, or have their own curl."""
    alone = thin_pivot(**{"width": 0.01, "effects": effects} | changed)
    path = solve_statics(alone, rotation=1.0, increments=4)
    values = {name: [value] for name, value in changed.items()}
    found = solve_many(thin_pivot(0.01, effects=effects), values, rotation=1.0, increments=4)
    assert found.torque[0] == pytest.approx(path.torque, rel=1e-9)


@pytest.mark.parametrize("step", [5e-5, 1e-3])
def test_motion_keeps_its_energy(step):
    """The default motion loses and gains no energy with both effects of the curl, in steps of any length."""
    body = {"body_mass": 0.05, "body_moment_of_inertia": 1e-4, "control_points": 6}
    pivot = thin_pivot(0.02, thickness=1e-3, effects=CURLING, **body)
    run = solve_motion(pivot, start=np.pi / 2, duration=5 * step, step=step, check=False)
    assert drift(run) < 1e-10
