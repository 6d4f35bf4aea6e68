"""Damping of a body against the closed form of one degree of freedom, in both models."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from studies.answers.adapters import answer_modes, answer_release
from studies.answers.settings import FeSettings, SplineSettings
from tests import gates
from tests.agreement import loaded

#: Rotation of the start [rad], small enough for a linear swing; distance of the centre from the crossing [m].
START, ARM, SWINGS = 1e-3, 0.05, 2
DAMPERS = {"translation": {"translation": 0.8}, "rotation": {"rotation": 2e-3}}
SETTINGS = [
    (SplineSettings(control_points=7), {}),
    (FeSettings(elements=8), {"integrator": "generalised-alpha"}),
]


def swinging(damper):
    """A heavy body on light crossed strips, its centre beside the crossing, with one soft motion."""
    design = loaded.whiskered(loaded.scene(), START)
    light = [replace(strip, density=1e-3) for strip in design.strips if strip.name != "whisker"]
    body = replace(design.bodies[0], centre=(0.03 + ARM, 0.03))
    effects = replace(
        design.effects, names=(*design.effects.names, "body_damping"), tables={"body_damping": damper}
    )
    return replace(design, strips=tuple(light), bodies=(body,), effects=effects)


def decay(damper, settings, **options):
    """Relative difference of the rate at which the energy falls in whole swings from its closed form."""
    design = swinging(damper)
    moment = loaded.BODY_MOMENT_OF_INERTIA + loaded.BODY_MASS * ARM**2
    grip = damper.get("rotation", 0.0) + damper.get("translation", 0.0) * ARM**2
    rate = grip / (2.0 * moment)
    first = 2.0 * np.pi * answer_modes(design, settings, rotation=START, count=1).frequency[0]
    duration = SWINGS * 2.0 * np.pi / np.sqrt(first**2 - rate**2)
    step = {"step": duration / 1600} | options
    motion = answer_release(design, settings, duration=duration, records=20, **step)
    energy = motion.kinetic_energy + motion.strain_energy
    return abs(np.log(energy[0] / energy[-1]) / (2.0 * rate * duration) - 1.0)


@pytest.mark.slow
@pytest.mark.parametrize("settings, options", SETTINGS, ids=["spline", "fe"])
@pytest.mark.parametrize("damper", DAMPERS)
def test_body_damping_makes_a_swing_die_away_at_its_rate(damper, settings, options):
    """Requirement: energy falls by exp(-(c_r + c_t d^2) / (J + m d^2) t), from either part of the damping."""
    error = partial(decay, DAMPERS[damper], settings, **options)
    gates.check("body_damping_decay", error())
    if settings.model == "spline":
        gates.refuse("body_damping_decay", error)
