"""From a compiled scene to the reduced mechanism, and between the unknowns of both."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import System
from spline_model.effects import Bending, MixedStretching, Stretching
from spline_model.errors import InvalidParameter
from spline_model.followers import Followers
from spline_model.reduced.arrays import Arrays, Bodies, Space
from spline_model.reduced.numbers import GAIN, along_of, ends_of, shape_at, shape_of, speeds_of, strips_of
from spline_model.scene import Scene
from spline_model.strip.element import Local, Shape, Strips

Array = NDArray[np.float64]

ELASTIC: tuple[type[Bending | MixedStretching | Stretching], ...] = (Bending, MixedStretching, Stretching)


@dataclass(frozen=True, kw_only=True, eq=False)
class Reduced:
    """A scene in reduced coordinates y: the bodies' poses, free strip ends among them, then w and a a strip.

    rest (S, G): the strips' curvature; to_modes (S, K, K): the scene's axial forces from the element's.
    """

    system: System
    bodies: Bodies
    strips: Strips
    shape: Shape
    rest: Array
    to_modes: Array
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
        every = np.arange(len(self.bodies.load))
        free = np.delete(every, self.bodies.frames.carried)
        bodies = self.bodies._replace(free=free, held=every[:0], driven=-1)
        return replace(self, system=system, bodies=bodies)

    def as_slender(self, *, slender: bool) -> Reduced:
        """The same with, or without, the mean axial forces beside the bodies: see ``LEAST_COMPLIANCE``."""
        strips = self.strips
        bodies = _bodies_of(self.system, slender * len(strips.roots))
        coupled = slender * strips.split
        strips = strips._replace(coupled=coupled, outer=int(slender), gain=np.full_like(strips.gain, GAIN))
        return replace(self, bodies=bodies, strips=strips)

    def arrays(self) -> Arrays:
        """What kernels know of it, with working arrays of their own."""
        space = Space.of(self.bodies, self.size, self.strips.along.dtype)
        return Arrays(self.bodies, self.strips, self.shape, self.local(), space)

    def local(self) -> Local:
        """Return working arrays of the strips."""
        return Local.of(self.strips, len(self.shape.order))

    def at_stations(self, stations: Array) -> Reduced:
        """Return the same with stations u (P,) [1] for Gauss points, where sections are recovered."""
        system = self.system
        shape = shape_at(system.scene.strips[0].basis, stations, np.zeros(len(stations)))
        speeds = speeds_of(system.scene, shape, self.length)
        strips = self.strips._replace(along=along_of(system, shape, speeds, self.to_modes))
        return replace(self, shape=shape, strips=strips, rest=speeds[1])


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


def _reduced(system: System) -> Reduced | None:
    scene = system.scene
    if not _known(scene):
        return None
    bending = {e.strip: e for e in scene.of(Bending)}
    basis, points = scene.strips[0].basis, next(iter(bending.values())).gauss_points
    length, energy = system.scales.length, system.scales.energy
    shape = shape_of(basis, points)
    ends = ends_of(system)
    strips, rest, to_modes = strips_of(system, shape, basis, points, ends)
    return Reduced(
        system=system,
        bodies=_bodies_of(system, strips.outer * len(scene.strips)),
        strips=strips,
        shape=shape,
        rest=rest,
        to_modes=to_modes,
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


def _bodies_of(system: System, outer: int) -> Bodies:
    """The bodies, free ends among them, and what acts on them."""
    scene, layout, loads, drives = system.scene, system.layout, system.loads, system.drives
    length, force, begin = (
        system.scales.length,
        system.scales.energy / system.scales.length,
        layout.poses.start,
    )
    rest = [v for body in scene.bodies for v in (*(at / length for at in body.centre.tolist()), 0.0)]
    for strip in scene.strips:
        for end, at in (("start", 0), ("end", -1)):
            if (strip.name, end) not in scene.clamps:
                rest += [*(strip.control_points[at] / length), 0.0]
    load, weight = np.zeros(len(rest) + outer), np.zeros(len(rest) + outer)
    if loads.value.size:
        np.add.at(load, loads.coordinate - begin, loads.value)
    if system.weight.size:
        weight[: layout.poses.stop - begin] = system.weight[layout.poses]
    for part in (load, weight):
        part[: len(rest)] /= force
        part[2 : len(rest) : 3] /= length
    held, rows = drives.coordinate - begin, drives.row.tolist()
    frames = system.frames.among(begin, length)
    fixed = {*held.tolist(), *frames.carried}
    return Bodies(
        rest=np.array(rest),
        load=load,
        weight=weight,
        free=np.array([i for i in range(len(load)) if i not in fixed], dtype=np.int64),
        held=held,
        driven=-1 if scene.driven_row is None else rows.index(scene.driven_row),
        springs=in_units(system, system.springs),
        frames=frames,
    )


def in_units(system: System, matrix: Array) -> Array:
    """Return a matrix over the poses of all bodies, or (0, 0), over units of work."""
    if not matrix.size:
        return matrix
    unit = np.tile(system.scales.pose, len(matrix) // 3)
    return np.asarray(matrix * (unit[:, None] * unit / system.scales.energy))


def at_rest(model: Reduced) -> Array:
    """Return the state y (Y,) at rest [1]: lengths over L, turns [rad], axial forces over EI/L^2."""
    y, bodies = np.zeros(model.size), model.bodies
    y[: len(bodies.rest)] = bodies.rest
    for s, strip in enumerate(model.system.scene.strips):
        w, _ = model.places(s)
        y[w] = [*(strip.control_points[2:-2] / model.length).ravel(), 1.0, 1.0]
    return y


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
