"""From a compiled scene to the reduced mechanism, and between the unknowns of both."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import BSpline

from spline_model.basis import AxialModes, SlideModes, SplineBasis
from spline_model.compile import System
from spline_model.effects import Bending, MixedStretching, Stretching, StripGravity
from spline_model.effects.elastic import MEASURES
from spline_model.reduced.assembly import Bodies
from spline_model.reduced.ends import Ends, bodies_of, ends_of, frames_of
from spline_model.scene import Scene
from spline_model.strip.element import Local, Shape, Strips, local_arrays

Array = NDArray[np.float64]

LEAST_COMPLIANCE = 1e-4
"""Axial compliance in L^2/EI below which an axial force stays beside w (L/h above 29): condensed, it would be
the strain's round-off over the compliance; beside w it follows from equilibrium."""
GAIN = 100.0
"""Stiffness by which such a force is condensed all the same, exactly: of the order of the bending's, so
that no digit is lost."""
MOST_CONTROL_POINTS = 24
"""Longer B-splines are narrow bands, which the element's dense tangent does not use along a path."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Reduced:
    """A scene in reduced coordinates y: the bodies' poses, free strip ends among them, then w and a a strip.

    frame (S, 6): of each strip root and tip, direction of each at rest, as in ``Strips``;
    to_modes (S, K, K): the scene's axial forces from the element's.
    """

    system: System
    bodies: Bodies
    strips: Strips
    shape: Shape
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

    @cached_property
    def drive_length(self) -> Array:
        """Unit of each driven coordinate (D,): 1 rad or the length."""
        return np.where(self.system.tables.drives.turns == 1, 1.0, self.length)

    @cached_property
    def drives(self) -> tuple[Array, Array]:
        """Driven coordinates at load factor 0, and their change to 1 (D,)."""
        drives = self.system.tables.drives
        return drives.origin / self.drive_length, drives.target / self.drive_length

    def local(self) -> Local:
        """Working arrays of the strips."""
        s, g, k = self.strips.modes.shape
        return local_arrays(s, len(self.shape.order), k, g, self.strips.coupled)


def reduced(system: System, *, longest: float = MOST_CONTROL_POINTS) -> Reduced | None:
    """The reduced mechanism of a scene, or None where the element does not know one of its parts.

    Strips of one basis and quadrature, clamped or free at their ends, with bending in the material
    or the spatial measure; longest: control points of a strip, at most.
    """
    scene = system.scene
    if not _known(scene, system, longest):
        return None
    bending = {e.strip: e for e in scene.of(Bending)}
    basis, points = scene.strips[0].basis, next(iter(bending.values())).gauss_points
    length, energy = system.scales.length, system.scales.energy
    shape = _shape(basis, points)
    ends = ends_of(system)
    strips, to_modes = _strips(system, shape, basis, points, ends)
    bodies = bodies_of(system, ends, strips.outer * len(scene.strips))
    if bodies is None:
        return None
    return Reduced(
        system=system,
        bodies=bodies,
        strips=strips,
        shape=shape,
        to_modes=to_modes,
        length=length,
        energy=energy,
    )


def _known(scene: Scene, system: System, longest: float) -> bool:
    bending = scene.of(Bending)
    grids = {(e.gauss_points, e.measure) for e in bending}
    grids |= {(e.gauss_points, e.measure) for e in scene.of(MixedStretching)}
    grids |= {(e.gauss_points, e.measure) for e in scene.of(Stretching)}
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
def _shape(basis: SplineBasis, points: int) -> Shape:
    n = basis.control_points
    order = np.array([*range(2, n - 2), 1, n - 2, n - 1, 0], dtype=np.int64)
    u, weight = basis.gauss_rule(points)
    whole = BSpline(basis.knots, np.eye(n), basis.degree).antiderivative()
    values = [basis.evaluate(u, k) for k in range(3)] + [whole(1.0) - whole(u)]
    d0, d1, d2, beyond = (np.ascontiguousarray(v[:, order]) for v in values)
    return Shape(order=order, d0=d0, d1=d1, d2=d2, beyond=beyond, u=u, weight=weight)


def _strips(
    system: System, shape: Shape, basis: SplineBasis, points: int, ends: Ends
) -> tuple[Strips, Array]:
    scene, tables = system.scene, system.tables
    length, energy = system.scales.length, system.scales.energy
    count, gauss = len(scene.strips), len(shape.weight)
    order = {e.strip: i for i, e in enumerate(scene.of(Bending))}
    rows = [slice(order[s.name] * gauss, (order[s.name] + 1) * gauss) for s in scene.strips]
    speed = np.array([tables.bending.speed[r] for r in rows]) / length
    mixed = [[e for e in scene.of(MixedStretching) if e.strip == s.name] for s in scene.strips]
    consistent = {e.strip: e for e in scene.of(Stretching)}
    split = len_modes(mixed[0], slide=False)
    modes, compliance, to_modes = [], [], []
    for parts, v in zip(mixed, speed, strict=True):
        values, back = orthonormal_modes(tuple(e.modes for e in parts), basis, points, tuple(v))
        modes.append(values)
        each = [e.axial_compliance for e in parts for _ in range(e.modes.count)]
        compliance.append(np.array(each) * energy / length)
        to_modes.append(back)
    measure = MEASURES.index(scene.of(Bending)[0].measure)
    c = np.array(compliance).reshape(count, -1)
    small = c < LEAST_COMPLIANCE
    outer = int(small[:, :split].any())
    coupled = c.shape[1] if measure else outer * split
    dead, per_u = _dead(system, shape)
    return Strips(
        speed=speed,
        curvature=np.array([tables.bending.curvature[r] for r in rows]) * length,
        rigidity=np.array([tables.bending.rigidity[r] for r in rows]) / (energy * length),
        stretching=np.array(
            [consistent[s.name].axial_rigidity if s.name in consistent else 0.0 for s in scene.strips]
        )
        / (energy / length),
        strain=np.array(
            [
                natural_strain(parts, consistent.get(s.name))
                for s, parts in zip(scene.strips, mixed, strict=True)
            ]
        ),
        modes=np.ascontiguousarray(np.array(modes).reshape(count, gauss, -1)),
        split=split,
        compliance=c,
        gain=np.where(small, GAIN, 1.0 / np.where(small, 1.0, c)),
        coupled=coupled,
        outer=outer,
        roots=np.array([ends[s.name, "start"].body for s in scene.strips], dtype=np.int64),
        tips=np.array([ends[s.name, "end"].body for s in scene.strips], dtype=np.int64),
        root=frames_of([ends[s.name, "start"] for s in scene.strips], length),
        tip=frames_of([ends[s.name, "end"] for s in scene.strips], length),
        reach=np.array(
            [
                [
                    np.hypot(*(s.control_points[a] - s.control_points[b])) / length
                    for a, b in ((1, 0), (-1, -2))
                ]
                for s in scene.strips
            ]
        ),
        dead=dead,
        weight=per_u,
        measure=measure,
    ), np.array(to_modes).reshape(count, c.shape[1], c.shape[1])


def len_modes(parts: list[MixedStretching], *, slide: bool) -> int:
    """Number of axial forces of a strip that belong to the stretching, or to the sliding."""
    return sum(e.modes.count for e in parts if isinstance(e.modes, SlideModes) == slide)


def values_at(modes: AxialModes, u: Array) -> Array:
    """All axial modes at points u, (len(u), count)."""
    first, shown = modes.evaluate(np.asarray(u))
    full = np.zeros((len(u), modes.count))
    np.put_along_axis(full, first[:, None] + np.arange(shown.shape[1]), shown, axis=1)
    return full


@lru_cache(maxsize=64)
def orthonormal_modes(
    parts: tuple[AxialModes, ...], basis: SplineBasis, points: int, speed: tuple[float, ...]
) -> tuple[Array, Array]:
    """Modes (G, K) orthonormal along the strip, and the scene's modes from them; kept."""
    u, weight = basis.gauss_rule(points)
    weight = weight * speed
    values, back = np.zeros((len(u), 0)), np.zeros((0, 0))
    for modes in parts:
        full, to_part = values_at(modes, u), np.eye(modes.count)
        if not isinstance(modes, SlideModes):  # the mean first
            to_part[:, 0] = np.linalg.lstsq(full, np.ones(len(u)), rcond=None)[0]
            full = full @ to_part
        factor = np.linalg.cholesky(full.T @ (weight[:, None] * full))
        values = np.column_stack((values, np.linalg.solve(factor, full.T).T))
        k, m = len(back), modes.count
        back = np.block([[back, np.zeros((k, m))], [np.zeros((m, k)), to_part @ np.linalg.inv(factor).T]])
    return values, back


def natural_strain(parts: list[MixedStretching], consistent: Stretching | None) -> float:
    """Stress-free strain of a strip."""
    if consistent is not None:
        return consistent.natural_strain
    return parts[0].natural_strain if parts else 0.0


def _dead(system: System, shape: Shape) -> tuple[Array, Array]:
    """Dead load on the control points (S, 2 n), in the order of elimination, and per du (S, 2)."""
    scene, weight = system.scene, system.tables.weight
    force = system.scales.energy / system.scales.length
    dead, per_u = np.zeros((len(scene.strips), 2 * len(shape.order))), np.zeros((len(scene.strips), 2))
    for s, strip in enumerate(scene.strips):
        if weight.size:
            dead[s] = weight[system.layout.strip(strip.name)].reshape(-1, 2)[shape.order].ravel() / force
        for effect in scene.of(StripGravity):
            if effect.strip == strip.name:
                mass = effect.linear_density * float(strip.share_of_length().sum())
                per_u[s] += mass * np.asarray(effect.acceleration) / force
    return dead, per_u


def at_rest(model: Reduced) -> Array:
    """The state y at rest."""
    return from_unknowns(model, model.system.rest)


def from_unknowns(model: Reduced, z: Array) -> Array:
    """The states y (..., Y) of unknowns z (..., N) of the scene, whose clamps hold."""
    scene, layout, strips, n = model.system.scene, model.system.layout, model.strips, len(model.shape.order)
    y = np.empty((*z.shape[:-1], model.size))
    for i, body in enumerate(scene.bodies):
        y[..., 3 * i : 3 * i + 3] = z[..., layout.body(body.name)] / [model.length, model.length, 1.0]
    for s, strip in enumerate(scene.strips):
        w, a = model.places(s)
        points = z[..., layout.strip(strip.name)].reshape(*z.shape[:-1], n, 2) / model.length
        y[..., w.start : w.stop - 2] = points[..., 2:-2, :].reshape(*z.shape[:-1], -1)
        for end, (bodies, frames, outer, inner) in enumerate(
            ((strips.roots, strips.root, 0, 1), (strips.tips, strips.tip, n - 1, n - 2))
        ):
            chord = (1 - 2 * end) * (points[..., inner, :] - points[..., outer, :])
            y[..., w.stop - 2 + end] = np.hypot(chord[..., 0], chord[..., 1]) / strips.reach[s, end]
            if bodies[s] >= len(scene.bodies):  # a free end is its own body
                turn = np.arctan2(chord[..., 1], chord[..., 0]) - frames[s, 2]
                place = 3 * bodies[s]
                y[..., place : place + 2] = points[..., outer, :]
                y[..., place + 2] = np.arctan2(np.sin(turn), np.cos(turn))
        effects = [i for i, e in enumerate(scene.of(MixedStretching)) if e.strip == strip.name]
        forces = np.concatenate([z[..., layout.axial_modes(i)] for i in effects] or [z[..., :0]], axis=-1) * (
            model.length / model.energy
        )
        y[..., a] = forces @ np.linalg.inv(model.to_modes[s]).T
    return y
