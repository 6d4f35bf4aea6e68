"""Pivots that swing, and the energies of their motions."""

import math

import numpy as np

from spline_model import cross_axis_pivot, motion_penalty_stiffness
from spline_model.compile import compile_scene
from spline_model.motion.start import Start, set_in_motion
from spline_model.sequential_impulse import Stepper
from spline_model.solution import Later
from spline_model.statics import static_state
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
#: Of a strip of that polymer.
SECTION = {"area": 8e-6, "second_moment_of_area": 4e-13, "youngs_modulus": 2e9, "density": 1100.0}


def pivot(design=TABLE_ONE, **settings):
    """A pivot in motion with its penalty stiffness, of six control points unless said otherwise."""
    n = settings.setdefault("control_points", 6)
    settings.setdefault("penalty_stiffness", motion_penalty_stiffness(n))
    return cross_axis_pivot(**design, **settings)


def stepper(mechanism, start=None, v=None, **form):
    """Sequential impulses from the static state at a rotation, or from rest, with a velocity (Q,)."""
    system = compile_scene(mechanism.released())
    z = system.rest if start is None else static_state(mechanism, start)[: system.layout.size]
    speed = np.zeros(system.layout.coordinate_count) if v is None else v
    return Stepper(Start(set_in_motion(system), Later(z[None].copy), speed), **form)


def total(trajectory):
    """Kinetic and strain energy."""
    return trajectory.kinetic_energy + trajectory.strain_energy


def drift(trajectory):
    """Largest relative change of the energy."""
    energy = total(trajectory)
    return np.abs(energy / energy[0] - 1.0).max()
