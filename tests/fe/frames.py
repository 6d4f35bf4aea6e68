"""Frames with published limit loads as finite elements, and the control that leads them."""

import itertools
import math
from typing import Any

import numpy as np

from fe_reference import BodyDesign, Model, StripDesign, compliant_mechanism
from fe_reference.control import Control
from fe_reference.loads import full_load
from fe_reference.structure import structure_of

EFFECTS = ("bending", "stretching", "applied_force")


def section_of(**given: float) -> dict[str, float]:
    """Return a section whose mass and shear do not matter."""
    return {"poisson_ratio": 0.3, "density": 1.0, **given}


def led(model: Model, *held: str) -> Control:
    """Return load control of a mechanism, with the centres of some bodies held in their places."""
    structure = structure_of(model)
    starts = [structure.body_slice(model.body_index(name)).start for name in held]
    at = np.array(sorted(start + k for start in starts for k in range(2)), dtype=np.int64)
    return Control(structure=structure, held=at, values=np.zeros((2, len(at))), load=full_load(structure))


def toggle(*, rise: float = 0.386, load: float = 60.0, **discretisation: Any) -> Control:
    """Williams' toggle (1964): members of 12.943 in, built in, EI = 9.27e3 lb in^2, EA = 1.885e6 lb."""
    half = math.sqrt(12.943**2 - rise**2)
    section = section_of(area=1.885e6, second_moment_of_area=9.27e3, youngs_modulus=1.0)
    strips = [
        StripDesign(name=name, start=(x, 0.0), end=(0.0, rise), tip="apex", **section)
        for name, x in (("left", -half), ("right", half))
    ]
    return led(
        compliant_mechanism(
            strips=strips,
            bodies=[BodyDesign(name="apex", centre=(0.0, rise))],
            effects=EFFECTS,
            parameters={"applied_force": {"body": "apex", "force": (0.0, -load)}},
            **discretisation,
        )
    )


def lees_frame(*, load: float = 3.0, **discretisation: Any) -> Control:
    """Lee's frame (1968): two members of 120, A = 6, I = 2, E = 720, load at 24, pinned ends."""
    section = section_of(area=6.0, second_moment_of_area=2.0, youngs_modulus=720.0)
    joints = {"foot": (0.0, 0.0), "corner": (0.0, 120.0), "loaded": (24.0, 120.0), "far": (120.0, 120.0)}
    strips = [
        StripDesign(name=f"{a}_{b}", start=joints[a], end=joints[b], root=a, tip=b, **section)
        for a, b in itertools.pairwise(joints)
    ]
    return led(
        compliant_mechanism(
            strips=strips,
            bodies=[BodyDesign(name=name, centre=place) for name, place in joints.items()],
            effects=EFFECTS,
            parameters={"applied_force": {"body": "loaded", "force": (0.0, -load)}},
            **discretisation,
        ),
        "foot",
        "far",
    )


def column(*, load: float, side: float = 0.0, slenderness: float = 1e3, **discretisation: Any) -> Control:
    """A column of length 1 and EI = 1, free at its tip, where `load` pushes, and `side` of it aside."""
    section = section_of(area=slenderness**2, second_moment_of_area=1.0, youngs_modulus=1.0)
    strip = StripDesign(name="column", start=(0.0, 0.0), end=(1.0, 0.0), tip="tip", **section)
    return led(
        compliant_mechanism(
            strips=[strip],
            bodies=[BodyDesign(name="tip", centre=(1.0, 0.0))],
            effects=EFFECTS,
            parameters={"applied_force": {"body": "tip", "force": (-load, side * load)}},
            **discretisation,
        )
    )
