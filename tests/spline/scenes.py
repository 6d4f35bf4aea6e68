"""Pivots that swing with the energies of their motions, and scenes with any of the registered effects."""

import math

import numpy as np

from spline_model import (
    DEFAULT_EFFECTS,
    StripDesign,
    compliant_mechanism,
    cross_axis_pivot,
    motion_penalty_stiffness,
)
from spline_model.compile import compile_scene
from spline_model.motion.start import Start, set_in_motion
from spline_model.sequential_impulse import Stepper
from spline_model.solution import Later
from spline_model.statics import static_state
from tests.table_one import SIDES, SIX, TABLE_ONE

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


#: Parameters with which each registered effect is tried; a new effect without its own is tried without.
PARAMETERS = {
    "gravity": {"acceleration": (300.0, -500.0)},
    "strip_damping": {"relaxation_time": 1e-5},
    "strip_drag": {"rate": 30.0},
    "body_damping": {"translation": 2.0, "rotation": 0.01},
    "applied_force": {"force": (30.0, -50.0)},
    "applied_moment": {"moment": 30.0, "history": ((0.0, 0.0), (0.005, 1.0), (0.02, -1.0))},
    "tip_force": {"strip": "free", "force": (3.0, 5.0)},
    "driven_displacement": {"displacement": (-0.0148, -0.0011)},  # near the free path at 0.5 rad
    "pre_strain": {"curvature": 1.0, "strain": 1e-4},
}


def scene_with(*names, parameters=None, **settings):
    """Table 1 with a free strip on its body, whose scene holds the default effects and the named ones."""
    pivot = cross_axis_pivot(**SIX | SIDES).design
    strips = list(pivot.strips)
    if "tip_force" in names:
        section = {"area": 5e-6, "second_moment_of_area": 1e-12, "width": 3.2275e-3, "thickness": 1.5492e-3}
        section |= {"youngs_modulus": 206e9, "density": 7800.0}
        strips.append(StripDesign(name="free", start=(0.03, 0.06), end=(0.03, 0.12), root="body", **section))
    given = PARAMETERS if parameters is None else parameters
    effects = tuple(n for n in DEFAULT_EFFECTS if not (n == "stretching" and "inextensible" in names))
    return compliant_mechanism(
        strips=strips,
        bodies=pivot.bodies,
        effects=effects + names,
        parameters={name: given[name] for name in names if name in given},
        **({"control_points": 6} | settings),
    )
