"""Anticlastic bending: Ashwell's law, what it does in a scene, and what refuses it."""

import numpy as np
import pytest

from spline_model import (
    DEFAULT_EFFECTS,
    BodyDesign,
    StripDesign,
    compliant_mechanism,
    solve_many,
    solve_mechanism,
    solve_motion,
    solve_statics,
)
from tests import gates
from tests.spline.test_clamped_width import BARE, CLAMPED, thin_pivot

CURLING = (*CLAMPED, "anticlastic")
#: b^2 / (R t), factors of moment and stiffness in pure bending at nu = 0.3: Ashwell's law, printed digits.
ASHWELL = [
    (1.0, 1.0029, 1.0085),
    (2.0, 1.0106, 1.0293),
    (5.0, 1.0402, 1.0816),
    (10.0, 1.0634, 1.0854),
    (50.0, 1.0826, 1.0908),
    (1000.0, 1.0953, 1.0971),
]


def rolled(flatness, increments=4):
    """A strip of unit length that is bent to 1/R = 1/2 by its tip, b^2 / (R t) = flatness."""
    sides = {"width": 0.3, "thickness": 0.3**2 * 0.5 / flatness}
    strip = StripDesign(
        name="strip", start=(0.0, 0.0), end=(1.0, 0.0), tip="tip", youngs_modulus=2e11, density=1.0, **sides
    )
    tip = BodyDesign(name="tip", centre=(1.0, 0.0))
    made = compliant_mechanism(strips=[strip], bodies=[tip], effects=(*DEFAULT_EFFECTS, "anticlastic"))
    return made, solve_mechanism(made, rotation=0.5, increments=increments)


def test_anticlastic_bending_in_a_roll_up():
    """A strip rolled up by its end has the moment and the stiffness of Ashwell's law."""

    def error(poisson_ratio=0.3):
        found = []
        for flatness, *_ in ASHWELL:
            made, path = rolled(flatness)
            rigidity = made.design.strips[0].flexural_rigidity
            found.append((path.torque[-1] / (0.5 * rigidity), path.stiffness[-1] / rigidity))
        wrong = (0.3 / poisson_ratio) ** 2 - 1.0
        return np.abs(np.array(found) - 1.0 - (1.0 + wrong) * (np.array(ASHWELL)[:, 1:] - 1.0)).max()

    gates.hold("spline_anticlastic", error)


def test_roll_up_reports_the_moment_that_bends_it():
    """Sections carry the moment of the law, which is that of balance, and the energy is its work."""
    _, path = rolled(20.0, increments=40)
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
