"""Rotary inertia of the sections against the rigid turn of a curved strip, a closed form."""

import numpy as np
import pytest

from spline_model import StripDesign, compliant_mechanism
from spline_model.compile import compile_scene

SECTION = {"area": 5e-5, "second_moment_of_area": 1e-10, "youngs_modulus": 2e9, "density": 1200.0}


def kinetic_energy(rise, *effects, chord=0.1):
    """Twice the kinetic energy of a strip that turns rigidly with 1 rad/s about its root [kg m^2]."""
    strip = StripDesign(name="strip", start=(0.0, 0.0), end=(chord, 0.0), rise=rise, tip=None, **SECTION)
    scene = compliant_mechanism(
        strips=[strip], effects=("bending", "stretching", *effects), control_points=12
    ).scene
    system = compile_scene(scene)
    velocity = np.zeros(system.layout.coordinate_count)
    for name in system.layout.strips:
        points = system.rest[system.layout.strip(name)].reshape(-1, 2)
        velocity[system.layout.strip(name)] = np.column_stack((-points[:, 1], points[:, 0])).ravel()
    return float(velocity @ system.mass @ velocity)


@pytest.mark.parametrize("rise", [0.0, 0.01, -0.03, 0.045, 0.1])
def test_sections_of_a_curved_strip_turn_with_their_own_inertia(rise):
    """Requirement: a rigid turn of any arc has rho I times its length beside the inertia of its line."""
    chord = 0.1
    half = 2.0 * np.arctan(2.0 * abs(rise) / chord)  # of the arc's angle
    length = chord if rise == 0.0 else chord * half / np.sin(half)
    own = kinetic_energy(rise, "strip_inertia", "section_rotary_inertia") - kinetic_energy(
        rise, "strip_inertia"
    )
    assert own == pytest.approx(SECTION["density"] * SECTION["second_moment_of_area"] * length, rel=1e-7)
