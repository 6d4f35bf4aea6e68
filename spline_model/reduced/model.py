"""From a compiled scene to the reduced mechanism, and between the unknowns of both."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import BSpline

from spline_model.basis import SlideModes, SplineBasis
from spline_model.compile import System
from spline_model.effects import Bending, MixedStretching, RootCompliance, Shear, Stretching
from spline_model.effects.elastic import MEASURES
from spline_model.reduced.arrays import Arrays, Bodies, Space
from spline_model.reduced.ends import Ends, bodies_of, ends_of
from spline_model.reduced.numbers import numbers_of, orthonormal_modes, speeds
from spline_model.scene import Scene
from spline_model.strip.element import (
    CURL,
    CURVATURE,
    DROP,
    MODES,
    RIGIDITY,
    SHEAR,
    SPEED,
    SPRING,
    WHERE,
    Local,
    Shape,
    Strips,
)

Array = NDArray[np.float64]

LEAST_COMPLIANCE = 1e-4
"""Axial compliance in L^2/EI below which an axial force stays beside w (L/h above 29): condensed, it would be
the strain's round-off over the compliance; beside w it follows from equilibrium."""
GAIN = 100.0
"""Stiffness by which such a force is condensed all the same, exactly: of the order of the bending's, so
that no digit is lost."""
ELASTIC: tuple[type[Bending | MixedStretching | Stretching], ...] = (Bending, MixedStretching, Stretching)
MOST_CONTROL_POINTS = 24
"""Longer B-splines are narrow bands, which the element's dense tangent does not use along a path."""


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

    @property
    def size(self) -> int:
        """Number of unknowns."""
        own = 2 * len(self.shape.order) - 6
        modes = int(self.strips.compliance.shape[1])
        return len(self.bodies.rest) + len(self.strips.roots) * (own + modes)

    def places(self, strip: int) -> tuple[slice, slice]:
        """Where w and a of a strip stand in y."""
        own, modes = 2 * len(self.shape.order) - 6, int(self.strips.compliance.shape[1])
        at = len(self.bodies.rest) + strip * (own + modes)
        return slice(at, at + own), slice(at + own, at + own + modes)

    @property
    def yields(self) -> bool:
        """Whether roots turn, by the first two of w: see ``spline_model.strip.ends``."""
        return bool(self.strips.numbers[0, SPRING] > 0.0)

    @property
    def shears(self) -> bool:
        """Whether strips shear, by the next two of w."""
        return bool(self.strips.numbers[0, SHEAR] > 0.0)

    @property
    def beside(self) -> int:
        """Number of a strip's points on no curve, which w begins with."""
        return self.yields + self.shears

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
        """That of a system in which nothing is driven, with the same strips and bodies."""
        every = np.arange(len(self.bodies.load))
        bodies = self.bodies._replace(free=every, held=every[:0], driven=-1)
        return replace(self, system=system, bodies=bodies)

    def as_slender(self, *, slender: bool) -> Reduced:
        """The same with, or without, the mean axial forces beside the bodies: see ``LEAST_COMPLIANCE``."""
        strips, modes = self.strips, int(self.strips.compliance.shape[1])
        bodies = bodies_of(self.system, ends_of(self.system), slender * len(strips.roots))
        assert bodies is not None, "the mechanism is known already"
        coupled = modes if strips.measure else (slender or self.shears) * strips.split
        strips = strips._replace(coupled=coupled, outer=int(slender), gain=np.full_like(strips.gain, GAIN))
        return replace(self, bodies=bodies, strips=strips)

    def arrays(self) -> Arrays:
        """What kernels know of it, with working arrays of their own."""
        space = Space.of(self.bodies, self.size)
        return Arrays(self.bodies, self.strips, self.shape, self.local(), space)

    def local(self) -> Local:
        """Working arrays of the strips."""
        s, g, k = self.strips.modes.shape
        return Local.of(s, len(self.shape.order), k, g, self.strips.coupled)


def reduced(system: System, *, longest: float = MOST_CONTROL_POINTS) -> Reduced | None:
    """The reduced mechanism of a scene, or None where the element does not know one of its parts.

    Strips of one basis and quadrature, clamped or free at their ends, with bending in the material
    or the spatial measure; longest: control points of a strip, at most. It is made once a system.
    """
    if not _known(system.scene, system, longest):
        return None
    made: Reduced | None = system.once("reduced", _reduced)
    return made


def _reduced(system: System) -> Reduced | None:
    scene = system.scene
    bending = {e.strip: e for e in scene.of(Bending)}
    basis, points = scene.strips[0].basis, next(iter(bending.values())).gauss_points
    length, energy = system.scales.length, system.scales.energy
    shape = shape_of(basis, points, bool(scene.of(RootCompliance)) + bool(scene.of(Shear)))
    ends = ends_of(system)
    strips, rest, to_modes = strips_of(system, shape, basis, points, ends)
    bodies = bodies_of(system, ends, strips.outer * len(scene.strips))
    if bodies is None:
        return None
    return Reduced(
        system=system,
        bodies=bodies,
        strips=strips,
        shape=shape,
        rest=rest,
        to_modes=to_modes,
        length=length,
        energy=energy,
    )


def _known(scene: Scene, system: System, longest: float) -> bool:
    bending = scene.of(Bending)
    grids = {(e.gauss_points, e.measure) for kind in ELASTIC for e in scene.of(kind)}
    bases = {strip.basis for strip in scene.strips}
    return (
        not system.open_potentials
        and len(bases) == 1
        and len(grids) == 1
        and "printed" not in {measure for _, measure in grids}
        and sorted(e.strip for e in bending) == sorted(strip.name for strip in scene.strips)
        and all(e.flexural_rigidity > 0.0 for e in bending)
        and 4 <= next(iter(bases)).control_points <= longest
    )


@lru_cache(maxsize=64)
def shape_of(basis: SplineBasis, points: int, beside: int) -> Shape:
    """The basis at the Gauss points; beside: points more on no curve (``spline_model.strip.ends``)."""
    n = basis.control_points
    order = np.array([*range(2, n - 2), 1, n - 2, n - 1, 0], dtype=np.int64)
    u, weight = basis.gauss_rule(points)
    whole = BSpline(basis.knots, np.eye(n), basis.degree).antiderivative()
    values = [basis.evaluate(u, k) for k in range(3)] + [whole(1.0) - whole(u)]
    tables = np.ascontiguousarray(np.array(values)[:, :, order])
    if beside:
        order = np.concatenate((np.arange(n, n + beside), order))
        tables = np.concatenate((np.zeros((*tables.shape[:2], beside)), tables), axis=2)
    return Shape.of(order, tables, np.array((u, weight)))


def strips_of(
    system: System, shape: Shape, basis: SplineBasis, points: int, ends: Ends
) -> tuple[Strips, Array, Array]:
    """The strips' arrays, their curvature at rest (S, G), and the scene's axial forces from theirs."""
    scene, length, energy = system.scene, system.scales.length, system.scales.energy
    bending, consistent = {e.strip: e for e in scene.of(Bending)}, {e.strip: e for e in scene.of(Stretching)}
    mixed: dict[str, list[MixedStretching]] = {strip.name: [] for strip in scene.strips}
    for effect in scene.of(MixedStretching):
        mixed[effect.strip].append(effect)
    parts, bends = list(mixed.values()), [bending[name] for name in mixed]
    speed, rest = speeds(shape, np.array([strip.control_points for strip in scene.strips]) / length)
    modes, to_modes = orthonormal_modes(
        [tuple(e.modes for e in each) for each in parts], basis, points, speed
    )
    split = sum(e.modes.count for e in parts[0] if not isinstance(e.modes, SlideModes))
    measure = MEASURES.index(bends[0].measure)
    c = np.array([[e.axial_compliance for e in each for _ in range(e.modes.count)] for each in parts])
    c *= energy / length
    small = c < LEAST_COMPLIANCE
    outer = int(small[:, :split].any())
    for shear in scene.of(Shear):
        c[list(mixed).index(shear.strip), :split] -= shear.compliance * energy / length
    beside_w = bool(scene.of(Shear)) or outer
    small |= c < 0.0
    starts, tips = ([ends[name, end] for name in mixed] for end in ("start", "end"))
    strips = Strips(
        along=_along(system, bends, shape.rule[WHERE], speed, rest, modes),
        compliance=c,
        gain=np.where(small, GAIN, 1.0 / np.where(small, 1.0, c)),
        numbers=numbers_of(system, shape, parts, consistent, starts, tips),
        roots=np.array([end.body for end in starts], dtype=np.int64),
        tips=np.array([end.body for end in tips], dtype=np.int64),
        split=split,
        coupled=c.shape[1] if measure else beside_w * split,
        outer=outer,
        measure=measure,
    )
    return strips, rest, to_modes


def _along(system: System, bends: list[Bending], u: Array, speed: Array, rest: Array, modes: Array) -> Array:
    """What changes along the strips (S, G, 5 + K), at Gauss points u (G,)."""
    basis, (length, energy) = system.scene.strips[0].basis, (system.scales.length, system.scales.energy)
    along = np.zeros((*speed.shape, MODES + modes.shape[-1]))
    along[..., SPEED], along[..., MODES:] = speed, modes
    along[..., CURVATURE] = rest + np.array([[e.natural_curvature * length] for e in bends])
    along[..., RIGIDITY] = np.array([e.rigidity_at(basis, u) for e in bends]) / (energy * length)
    for row, curl in zip(along, (e.curl for e in bends), strict=True):
        if curl is not None:
            row[:, DROP], row[:, CURL] = curl.drop(basis, u), curl.flattening / length
    return along


def at_rest(model: Reduced) -> Array:
    """The state y at rest."""
    y, bodies = np.zeros(model.size), model.bodies
    y[: len(bodies.rest)] = bodies.rest
    for s, strip in enumerate(model.system.scene.strips):
        w, _ = model.places(s)
        y[w] = [*([0.0] * (2 * model.beside)), *(strip.control_points[2:-2] / model.length).ravel(), 1.0, 1.0]
    return y


def from_unknowns(model: Reduced, z: Array) -> Array:
    """The states y (..., Y) of unknowns z (..., N) of the scene, whose clamps hold."""
    scene, layout, strips = model.system.scene, model.system.layout, model.strips
    y = np.empty((*z.shape[:-1], model.size))
    for i, body in enumerate(scene.bodies):
        y[..., 3 * i : 3 * i + 3] = z[..., layout.body(body.name)] / [model.length, model.length, 1.0]
    for s, strip in enumerate(scene.strips):
        (w, a), n = model.places(s), strip.basis.control_points
        points = z[..., layout.strip(strip.name)].reshape(*z.shape[:-1], n, 2) / model.length
        apart = np.zeros((*z.shape[:-1], 2))
        if model.shears:  # the force of the clamp at the root is minus that along the strip
            unit = model.length / model.energy / strips.numbers[s, SHEAR]
            apart = z[..., scene.clamps[strip.name, "start"]][..., :2] * unit
            at = w.start + 2 * model.yields
            y[..., at : at + 2] = apart
        y[..., w.stop + 6 - 2 * n : w.stop - 2] = points[..., 2:-2, :].reshape(*z.shape[:-1], -1)
        for end, (bodies, frames, outer, inner) in enumerate(
            ((strips.roots, strips.root, 0, 1), (strips.tips, strips.tip, n - 1, n - 2))
        ):
            chord = (1 - 2 * end) * (points[..., inner, :] - points[..., outer, :])
            y[..., w.stop - 2 + end] = np.hypot(chord[..., 0], chord[..., 1]) / strips.reach[s, end]
            turn = np.arctan2(chord[..., 1], chord[..., 0]) - frames[s, 2]
            if bodies[s] >= len(scene.bodies):  # a free end is its own body
                place = 3 * bodies[s]
                y[..., place : place + 2] = points[..., outer, :] - (apart if end else 0.0)
                y[..., place + 2] = np.arctan2(np.sin(turn), np.cos(turn))
            if model.yields:
                turn = turn - (y[..., 3 * bodies[s] + 2] if bodies[s] >= 0 else 0.0)
                y[..., w.start + end] = np.arctan2(np.sin(turn), np.cos(turn))
        effects = [i for i, e in enumerate(scene.of(MixedStretching)) if e.strip == strip.name]
        forces = np.concatenate([z[..., layout.axial_modes(i)] for i in effects] or [z[..., :0]], axis=-1) * (
            model.length / model.energy
        )
        y[..., a] = forces @ np.linalg.inv(model.to_modes[s]).T
    return y
