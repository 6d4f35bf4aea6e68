"""Anticlastic bending: Ashwell's law, what it does in a scene, and what refuses it."""

import numpy as np
import pytest

import spline_model
from spline_model import (
    DEFAULT_EFFECTS,
    solve_many,
    solve_mechanism,
    solve_motion,
    solve_statics,
)
from tests.agreement.test_section_laws import strips
from tests.spline.test_clamped_width import BARE, CLAMPED, thin_pivot

CURLING = (*CLAMPED, "anticlastic")


def test_roll_up_reports_the_moment_that_bends_it():
    """Sections carry the moment of the law, which is that of balance, and the energy is its work."""
    made = strips(spline_model, 0.3, 0.3**2 * 0.5 / 20.0, effects=("anticlastic",))
    path = solve_mechanism(made, rotation=0.5, increments=40)
    assert path.bending_moment[-1] == pytest.approx(np.full_like(path.bending_moment[-1], path.torque[-1]))
    assert path.bending_energy[-1] == pytest.approx(path.work[-1], rel=1e-4)


def test_curl_never_exceeds_the_plate():
    """With both effects no strip is stiffer than one that is held flat, and each adds to the other."""
    flat, torque = 1.0 / (1.0 - BARE["poisson_ratio"] ** 2), []
    for effects in (DEFAULT_EFFECTS, CLAMPED, (*DEFAULT_EFFECTS, "anticlastic"), CURLING):
        pivot = thin_pivot(0.02, thickness=5e-4, effects=effects)
        torque.append(solve_statics(pivot, rotation=1.0, increments=4).torque[-1])
    plain, clamped, curved, both = np.array(torque) / torque[0]
    assert 1.0 == plain < clamped < curved < both < flat


def test_a_batch_scales_the_curl():
    """Designs of other sides and another length have their own flattening in a batch."""
    pivot = thin_pivot(0.01, effects=(*DEFAULT_EFFECTS, "anticlastic"))
    changed = {"thickness": 3e-4, "width": 0.02}
    one = thin_pivot(effects=pivot.effects, **changed)
    alone = solve_statics(one, rotation=1.0, increments=4)
    found = solve_many(pivot, {k: [v] for k, v in changed.items()}, rotation=1.0, increments=4)
    assert found.torque[0] == pytest.approx(alone.torque, rel=1e-9)


@pytest.mark.parametrize("step", [5e-5, 1e-3])
def test_motion_keeps_its_energy(step):
    """The default motion loses and gains no energy with both effects of the curl, in steps of any length."""
    body = {"body_mass": 0.05, "body_moment_of_inertia": 1e-4, "control_points": 6}
    pivot = thin_pivot(0.02, thickness=1e-3, effects=CURLING, **body)
    run = solve_motion(pivot, start=np.pi / 2, duration=5 * step, step=step, check=False)
    energy = run.kinetic_energy + run.strain_energy
    assert np.abs(energy / energy[0] - 1.0).max() < 1e-10
