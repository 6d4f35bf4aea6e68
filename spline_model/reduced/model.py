"""From a compiled scene to the reduced mechanism, and between the unknowns of both."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from spline_model.basis import SlideModes
from spline_model.compile import System
from spline_model.effects import Bending, MixedStretching, Stretching
from spline_model.effects.elastic import MEASURES
from spline_model.errors import InvalidParameter
from spline_model.reduced.arrays import Arrays, Bodies, Space
from spline_model.reduced.numbers import (
    Designs,
    Ends,
    Numbers,
    arrays_of,
    shape_at,
    shape_of,
)
from spline_model.scene import Scene
from spline_model.strip.element import Local, Shape, Strips
from spline_model.tables import Followers

Array = NDArray[np.float64]

LEAST_COMPLIANCE = 1e-4
"""Axial compliance in L^2/EI below which an axial force stays beside w (L/h above 29): condensed, it would be
the strain's round-off over the compliance; beside w it follows from equilibrium."""
GAIN = 100.0
"""Stiffness by which such a force is condensed all the same, exactly: of the order of the bending's, so
that no digit is lost."""
ELASTIC: tuple[type[Bending | MixedStretching | Stretching], ...] = (Bending, MixedStretching, Stretching)


@dataclass(frozen=True, kw_only=True, eq=False)
class Reduced:
    """A scene in reduced coordinates y: the bodies' poses, free strip ends among them, then w and a a strip.

    rest (S, G): the strips' curvature; to_modes (S, K, K): the scene's axial forces from the element's; start
    (Y,): y at rest.
    """

    system: System
    bodies: Bodies
    strips: Strips
    shape: Shape
    rest: Array
    to_modes: Array
    start: Array
    length: float
    energy: float

    @cached_property
    def size(self) -> int:
        """Number of unknowns."""
        own = 2 * len(self.shape.order) - 6
        modes = int(self.strips.compliance.shape[1])
        return len(self.bodies.rest) + len(self.strips.roots) * (own + modes)

    def places(self, strip: int) -> tuple[slice, slice]:
        """Return where w and a of a strip stand in y."""
        own, modes = 2 * len(self.shape.order) - 6, int(self.strips.compliance.shape[1])
        at = len(self.bodies.rest) + strip * (own + modes)
        return slice(at, at + own), slice(at + own, at + own + modes)

    @property
    def fixed(self) -> list[int]:
        """Coordinates of bodies that are not free: held ones, and those of frames."""
        return [*self.bodies.held.tolist(), *self.bodies.frames.carried]

    @property
    def followers(self) -> Followers:
        """Forces that turn with bodies, at places in y."""
        return self.system.followers.among(self.system.layout.poses.start, self.energy / self.length)

    @cached_property
    def drive_length(self) -> Array:
        """Unit of each driven coordinate (D,): 1 rad or the length."""
        return np.where(self.system.drives.turns == 1, 1.0, self.length)

    @cached_property
    def drives(self) -> tuple[Array, Array]:
        """Driven coordinates at load factor 0, and their change to 1 (D,)."""
        drives = self.system.drives
        return drives.origin / self.drive_length, drives.target / self.drive_length

    def let_go(self, system: System) -> Reduced:
        """Return that of a system in which nothing is driven, with the same strips and bodies."""
        none = self.bodies.held[:0]
        bodies = _freed(self.bodies._replace(held=none, driven=-1), len(self.bodies.load))
        return replace(self, system=system, bodies=bodies)

    def as_slender(self, *, slender: bool) -> Reduced:
        """The same with, or without, the mean axial forces beside the bodies: see ``LEAST_COMPLIANCE``."""
        strips, coupled = self.strips, slender * self.strips.split
        bodies = _freed(self.bodies, len(self.bodies.rest) + slender * len(strips.roots))
        strips = strips._replace(coupled=coupled, outer=int(slender), gain=np.full_like(strips.gain, GAIN))
        return replace(self, bodies=bodies, strips=strips)

    def of_design(self, designs: Designs, d: int) -> Reduced:
        """The same with the arrays of one of the designs, which are over this length and energy."""
        own = {name: getattr(designs, name)[d] for name in ("along", "numbers", "compliance")}
        bodies = self.bodies._replace(
            rest=designs.start[d, : len(self.bodies.rest)],
            frames=self.bodies.frames._replace(lever=designs.levers[d]),
        )
        strips = self.strips._replace(**own)
        return replace(self, bodies=bodies, strips=strips, to_modes=designs.to_modes[d])

    @property
    def ends(self) -> Ends:
        """Bodies at the strips' ends."""
        return Ends(self.strips.roots, self.strips.tips)

    def designs(self, given: Numbers, length: Array, energy: Array, gauss: Shape | None = None) -> Designs:
        """Return the arrays of D designs of the scene, over lengths (D,) [m] and energies (D,) [J].

        gauss: the Gauss points, of a model at stations.
        """
        own = self.shape
        return arrays_of(self.system, own, own if gauss is None else gauss, self.ends, given, length, energy)

    def arrays(self) -> Arrays:
        """What kernels know of it, with working arrays of their own."""
        space = Space.of(self.bodies, self.size, self.strips.along.dtype)
        return Arrays(self.bodies, self.strips, self.shape, self.local(), space)

    def local(self) -> Local:
        """Return working arrays of the strips."""
        return Local.of(self.strips, len(self.shape.order))

    def at_stations(self, stations: Array) -> Reduced:
        """Return the same with stations u (P,) [1] for Gauss points, where sections are recovered."""
        shape = shape_at(self.system.scene.strips[0].basis, stations, np.zeros(len(stations)))
        units, at = (np.array([self.length]), np.array([self.energy])), replace(self, shape=shape)
        own = at.designs(Numbers.of(self.system.scene), *units, gauss=self.shape)
        return replace(at, strips=self.strips._replace(along=own.along[0]), rest=own.rest[0])


def reduced(system: System) -> Reduced | None:
    """Return the reduced mechanism of a scene, or None where the element does not know one of its parts.

    Strips of one basis and quadrature, clamped or free at their ends, with bending in the material or the
    spatial measure. It is made once, for a system and those of other rotations.
    """
    made: Reduced | None = system.once("reduced", _reduced)
    return made if made is None or made.system is system else replace(made, system=system)


def require_reduced(system: System) -> Reduced:
    """Return the reduced mechanism of a scene; InvalidParameter where there is none."""
    model = reduced(system)
    if model is None and any(e.measure == "published" for e in system.scene.of(Bending)):
        expected = "material or spatial: published forces are for static paths only"
        raise InvalidParameter("measure", "published", expected)
    if model is None:
        raise InvalidParameter("scene", "strips of several kinds", "what the strips' elements know")
    return model


class _Structure(NamedTuple):
    """What of a model does not go by its numbers: basis, ends of strips, axial forces of stretching, code of
    the measure, held coordinates and the driven rotation among them; free: the free coordinates of the bodies
    by the number of unknowns, as they are asked for."""

    shape: Shape
    ends: Ends
    split: int
    measure: int
    held: NDArray[np.int64]
    driven: int
    free: dict[int, NDArray[np.int64]]

    @classmethod
    def of(cls, system: System) -> Self:
        """That of a system that the elements know."""
        scene, drives = system.scene, system.drives
        bending, first = scene.of(Bending)[0], scene.strips[0]
        mixed = (e.modes for e in scene.of(MixedStretching) if e.strip == first.name)
        row = np.flatnonzero(drives.row == scene.driven_row)
        return cls(
            shape=shape_of(first.basis, bending.gauss_points),
            ends=Ends.of(scene),
            split=sum(modes.count for modes in mixed if not isinstance(modes, SlideModes)),
            measure=MEASURES.index(bending.measure),
            held=drives.coordinate - system.layout.poses.start,
            driven=int(row[0]) if row.size else -1,
            free={},
        )


def _reduced(system: System) -> Reduced | None:
    scene, shared = system.scene, system.scene.structure
    if "reduced" not in shared:
        shared["reduced"] = _Structure.of(system) if _known(scene) else None
    fixed: _Structure | None = shared["reduced"]
    if fixed is None:
        return None
    length, energy = system.scales.length, system.scales.energy
    shape, ends, split = fixed.shape, fixed.ends, fixed.split
    own = arrays_of(system, shape, shape, ends, Numbers.of(scene), np.array([length]), np.array([energy]))
    c = own.compliance[0]
    small = c < LEAST_COMPLIANCE
    outer = int(small[:, :split].any())
    strips = Strips(
        along=own.along[0],
        compliance=c,
        gain=np.where(small, GAIN, 1.0 / np.where(small, 1.0, c)) if small.any() else 1.0 / c,
        numbers=own.numbers[0],
        roots=ends.roots,
        tips=ends.tips,
        split=split,
        coupled=outer * split,
        outer=outer,
        measure=fixed.measure,
    )
    bodies = Bodies(
        rest=own.start[0, : own.force.shape[2]],
        load=own.force[0, 0],
        weight=own.force[0, 1],
        free=fixed.held,
        held=fixed.held,
        driven=fixed.driven,
        springs=own.springs[0],
        frames=system.frames.among(system.layout.poses.start, length),
    )
    return Reduced(
        system=system,
        bodies=_freed(bodies, len(bodies.rest) + outer * len(scene.strips), fixed.free),
        strips=strips,
        shape=shape,
        rest=own.rest[0],
        to_modes=own.to_modes[0],
        start=own.start[0],
        length=length,
        energy=energy,
    )


def _known(scene: Scene) -> bool:
    bending = scene.of(Bending)
    grids = {(e.gauss_points, e.measure) for kind in ELASTIC for e in scene.of(kind)}
    bases = {strip.basis for strip in scene.strips}
    return (
        len(bases) == 1
        and len(grids) == 1
        and "published" not in {measure for _, measure in grids}
        and sorted(e.strip for e in bending) == sorted(strip.name for strip in scene.strips)
        and all(e.flexural_rigidity > 0.0 for e in bending)
        and next(iter(bases)).control_points >= 4
    )


def _freed(bodies: Bodies, size: int, known: dict[int, NDArray[np.int64]] | None = None) -> Bodies:
    """The bodies with so many unknowns, mean axial forces behind poses, free but where held or carried;
    known: free ones by that number."""
    known = {} if known is None else known
    if size not in known:
        fixed = {*bodies.held.tolist(), *bodies.frames.carried}
        known[size] = np.array([place for place in range(size) if place not in fixed], dtype=np.int64)
    if size == len(bodies.load):
        return bodies._replace(free=known[size])
    poses, (load, weight) = len(bodies.rest), np.zeros((2, size))
    load[:poses], weight[:poses] = bodies.load[:poses], bodies.weight[:poses]
    return bodies._replace(load=load, weight=weight, free=known[size])


def in_units(system: System, matrix: Array) -> Array:
    """Return a matrix over the poses of all bodies, or (0, 0), over units of work."""
    if not matrix.size:
        return matrix
    unit = np.tile(system.scales.pose, len(matrix) // 3)
    return np.asarray(matrix * (unit[:, None] * unit / system.scales.energy))


def from_unknowns(model: Reduced, z: Array) -> Array:
    """Return the states y (..., Y) of unknowns z (..., N) of the scene, whose clamps hold."""
    scene, layout, strips = model.system.scene, model.system.layout, model.strips
    y = np.empty((*z.shape[:-1], model.size))
    for i, body in enumerate(scene.bodies):
        y[..., 3 * i : 3 * i + 3] = z[..., layout.body(body.name)] / [model.length, model.length, 1.0]
    for s, strip in enumerate(scene.strips):
        (w, a), n = model.places(s), strip.basis.control_points
        points = z[..., layout.strip(strip.name)].reshape(*z.shape[:-1], n, 2) / model.length
        y[..., w.stop + 6 - 2 * n : w.stop - 2] = points[..., 2:-2, :].reshape(*z.shape[:-1], -1)
        for end, (bodies, frames, outer, inner) in enumerate(
            ((strips.roots, strips.root, 0, 1), (strips.tips, strips.tip, n - 1, n - 2))
        ):
            chord = (1 - 2 * end) * (points[..., inner, :] - points[..., outer, :])
            y[..., w.stop - 2 + end] = np.hypot(chord[..., 0], chord[..., 1]) / strips.reach[s, end]
            turn = np.arctan2(chord[..., 1], chord[..., 0]) - frames[s, 2]
            if bodies[s] >= len(scene.bodies):  # a free end is its own body
                place = 3 * bodies[s]
                y[..., place : place + 2] = points[..., outer, :]
                y[..., place + 2] = np.arctan2(np.sin(turn), np.cos(turn))
        effects = [i for i, e in enumerate(scene.of(MixedStretching)) if e.strip == strip.name]
        forces = np.concatenate([z[..., layout.axial_modes(i)] for i in effects] or [z[..., :0]], axis=-1) * (
            model.length / model.energy
        )
        y[..., a] = forces @ np.linalg.inv(model.to_modes[s]).T
    return y
