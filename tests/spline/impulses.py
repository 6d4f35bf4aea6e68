"""Pivots that the tests of sequential impulses use."""

import math

from spline_model import cross_axis_pivot, swinging_slide_stiffness
from tests.table_one import TABLE_ONE

QUARTER = math.pi / 2
POLYMER = TABLE_ONE | {
    "area": 8e-6,
    "second_moment_of_area": 1e-2 * 8e-4**3 / 12,
    "youngs_modulus": 2e9,
    "density": 1100.0,
    "body_mass": 0.05,
    "body_moment_of_inertia": 2e-5,
}
"""Strips of a polymer, 10 mm x 0.8 mm: a swing of 2.8 Hz."""


def pivot(design=TABLE_ONE, **settings):
    """A pivot in motion with its slide stiffness."""
    n = settings.setdefault("control_points", 6)
    settings.setdefault("slide_stiffness", swinging_slide_stiffness(n))
    return cross_axis_pivot(**design, **settings)


def total(trajectory):
    """Kinetic and strain energy."""
    return trajectory.kinetic_energy + trajectory.strain_energy
