"""Fields along the strips of any design, and its bodies: arrays that do not tell which model they are of."""

from dataclasses import dataclass, field, fields
from typing import Any

import numpy as np

from studies.answers.response import Answered
from studies.cases.design import Design
from studies.cases.keys import GROUND
from studies.cases.problem import Problem
from studies.kinds import Array


@dataclass(frozen=True, kw_only=True)
class Part:
    """A strip as its fields need it: what its root and its tip are on, and its section.

    Attributes:
        root, tip: "ground", the name of a body, or None for a free end.
        axial_rigidity: EA [N]; flexural_rigidity: EI [N m^2]; youngs_modulus: E [Pa]; depth: [m].
    """

    name: str
    root: str | None
    tip: str | None
    axial_rigidity: float
    flexural_rigidity: float
    youngs_modulus: float
    depth: float


@dataclass(frozen=True, kw_only=True)
class Block:
    """A rigid body as its fields need it: name, mass [kg], moment of inertia about the centre [kg m^2]."""

    name: str
    mass: float
    moment_of_inertia: float


@dataclass(frozen=True, kw_only=True)
class Fields(Answered):
    """Fields of a static path, a motion or natural modes: S states, G strips, P stations, B bodies.

    Attributes:
        analysis: "static", "release" or "modes".
        parts, blocks: the strips and bodies.
        driven: place of the body that is driven or let go among them; 0 where there is none.
        series: name of what runs over the states, "load_factor" [1], "time_s" [s] or "mode" [1].
        values: (S,) of it.
        arc_length: (G, P) at rest [m]; rest_shape: (G, P, 2) [m]; rest_bodies: (B, 2) centres at rest [m].
        shape: (S, G, P, 2) [m]; rotation: (S, G, P) of the sections from rest [rad]; curvature: [1/m];
            stretch: [1]; axial_force, shear_force: [N]; bending_moment: [N m].
        reactions: (S, G, 2, 3) force x, y [N] and moment [N m] on the strip at root and tip.
        bodies: (S, B, 3) centre x, y [m], rotation [rad].
        torque, stiffness: (S,) of the drive of a static path [N m], [N m/rad]; None without one.
        energies: (S,) by name [J]: "bending", "axial", "shear", "gravity" of a path; "kinetic", "strain",
            "gravity" of a motion, with what was lost to damping, "dissipated"; none of modes.
        frequency: (S,) of modes [Hz]; mode_shape: (S, G, P, 2), mode_bodies: (S, B, 3) displacement and
            rotation at unit modal mass; None of other analyses. The other fields of modes are those of the
            static state that the motion is about, the same in all.
    """

    analysis: str
    parts: tuple[Part, ...]
    blocks: tuple[Block, ...]
    driven: int
    series: str
    values: Array
    arc_length: Array
    rest_shape: Array
    rest_bodies: Array
    shape: Array
    rotation: Array
    curvature: Array
    stretch: Array
    axial_force: Array
    shear_force: Array
    bending_moment: Array
    reactions: Array
    bodies: Array
    torque: Array | None = None
    stiffness: Array | None = None
    energies: dict[str, Array] = field(default_factory=dict)
    frequency: Array | None = None
    mode_shape: Array | None = None
    mode_bodies: Array | None = None

    @property
    def displacement(self) -> Array:
        """(S, G, P, 2) from rest [m]."""
        return np.asarray(self.shape - self.rest_shape)

    @property
    def stress(self) -> Array:
        """(S, G, P) larger magnitude of axial and bending stress together at the two outer fibres [Pa]."""
        given = [
            (part.axial_rigidity, part.flexural_rigidity, part.youngs_modulus, part.depth)
            for part in self.parts
        ]
        axial, bending, modulus, depth = np.array(given).T[:, :, None]
        strain = np.abs(self.axial_force / axial) + np.abs(self.bending_moment * depth / (2.0 * bending))
        return np.asarray(modulus * strain)

    @property
    def strain_energy(self) -> Array:
        """(S,) of all strips [J]."""
        parts = ("strain",) if "strain" in self.energies else ("bending", "axial", "shear")
        return np.asarray(sum(self.energies[name] for name in parts if name in self.energies))

    @property
    def max_stress(self) -> Array:
        """(S,) largest of all strips [Pa]."""
        return np.asarray(self.stress.max(axis=(1, 2)))


def strip_arrays(found: Any) -> dict[str, Any]:
    """Return the arrays of a model's fields along the strips, by the names that `Fields` has."""
    return {field.name: np.asarray(getattr(found, field.name), dtype=float) for field in fields(found)}


def parts_of(design: Design) -> tuple[Part, ...]:
    """Return the strips of a design; a mechanism's sections are taken as rectangles, sqrt(12 I / A) deep."""
    if isinstance(design, Problem):
        shared = section_of(design) | {"depth": design.depth}
        return tuple(Part(name=f"strip_{k}", root=GROUND, tip="body", **shared) for k in (1, 2))
    return tuple(
        Part(name=strip.name, root=strip.root, tip=strip.tip, **section_of(strip)) for strip in design.strips
    )


def section_of(given: Any) -> dict[str, float]:
    """Return what a `Part` knows of its section: of whatever has A, I and E, as a rectangle."""
    return {
        "axial_rigidity": given.youngs_modulus * given.area,
        "flexural_rigidity": given.youngs_modulus * given.second_moment_of_area,
        "youngs_modulus": given.youngs_modulus,
        "depth": float(np.sqrt(12.0 * given.second_moment_of_area / given.area)),
    }


def blocks_of(design: Design) -> tuple[Block, ...]:
    """Return the bodies of a design."""
    if isinstance(design, Problem):
        return (Block(name="body", mass=design.body_mass, moment_of_inertia=design.body_moment_of_inertia),)
    return tuple(
        Block(name=body.name, mass=body.mass, moment_of_inertia=body.moment_of_inertia)
        for body in design.bodies
    )
