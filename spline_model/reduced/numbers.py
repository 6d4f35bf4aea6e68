"""What tells the strips' elements of a scene from one another: their ends, and what stands along each."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from spline_model.basis import AxialModes, Bezier, SlideModes
from spline_model.compile import System
from spline_model.effects import Bending, Clamp, MixedStretching, Stretching
from spline_model.effects.base import Constraint
from spline_model.effects.elastic import MEASURES, Taper
from spline_model.scene import Scene
from spline_model.strip.element import (
    CURL,
    CURVATURE,
    DROP,
    FIRST,
    GROUNDED,
    MODES,
    ON_POINTS,
    PER_U,
    REACH,
    RIGIDITY,
    ROOT,
    SECOND,
    SPEED,
    STRAIN,
    STRETCHING,
    TIP,
    WHERE,
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
ROUND_OFF = 1e-14
"""Difference of speeds along a strip, in its mean, that is none."""


class End(NamedTuple):
    """An end of a strip: its body or GROUNDED, point there [m], direction at rest."""

    body: int
    point: tuple[float, float]
    direction: float


Ends = dict[tuple[str, str], End]
"""Ends by (strip, \"start\" or \"end\")."""


def ends_of(system: System) -> Ends:
    """Return both ends of all strips by (strip, end); a free end is a body of its own, behind the scene's."""
    scene, free = system.scene, len(system.scene.bodies)
    ends: Ends = {}
    bodies = {body.name: (i, body.centre.tolist()) for i, body in enumerate(scene.bodies)}
    clamped = (c for c in scene.of(Constraint) if isinstance(c, Clamp))
    clamps: dict[tuple[str, str], str] = {(c.strip, c.end): c.to for c in clamped}
    for strip in scene.strips:
        points = strip.control_points.tolist()
        for end, at, inner, sign in (("start", 0, 1, 1.0), ("end", -1, -2, -1.0)):
            (x, y), (there_x, there_y) = points[at], points[inner]
            direction = math.atan2(sign * (there_y - y), sign * (there_x - x))
            if to := clamps.get((strip.name, end)):
                body, (left, low) = bodies.get(to, (GROUNDED, (0.0, 0.0)))
                ends[strip.name, end] = End(body, (x - left, y - low), direction)
            else:
                ends[strip.name, end] = End(free, (0.0, 0.0), direction)
                free += 1
    return ends


def in_order(points: Array, shape: Shape) -> Array:
    """Return values at control points (..., n, k) in the order of elimination."""
    return np.asarray(points[..., shape.order, :])


@lru_cache(maxsize=64)
def shape_of(basis: Bezier, points: int) -> Shape:
    """Return the basis at the Gauss points."""
    return shape_at(basis, *basis.gauss_rule(points))


def shape_at(basis: Bezier, u: Array, weight: Array) -> Shape:
    """Return the basis at any points u (P,) with weights."""
    n = basis.control_points
    order = np.array([*range(2, n - 2), 1, n - 2, n - 1, 0], dtype=np.int64)
    whole = np.ones(1)
    values = [basis.evaluate(u, k) for k in range(3)]
    values += [basis.areas(whole, power) - basis.areas(u, power) for power in range(3)]
    tables = np.ascontiguousarray(np.array(values)[:, :, order])
    return Shape.of(order, tables, np.array((u, weight)))


def strips_of(
    system: System, shape: Shape, basis: Bezier, points: int, ends: Ends
) -> tuple[Strips, Array, Array]:
    """Return the strips' arrays, their curvature at rest (S, G), and the scene's axial forces from theirs."""
    scene, length, energy = system.scene, system.scales.length, system.scales.energy
    parts, bends = list(_mixed_of(scene).values()), bends_of(scene)
    speed, rest = speeds_of(scene, shape, length)
    kinds = [tuple((e.modes, e.taper) for e in each) for each in parts]
    to_modes = _orthonormal_modes(kinds, basis, points, speed)
    split = sum(e.modes.count for e in parts[0] if not isinstance(e.modes, SlideModes))
    measure = MEASURES.index(bends[0].measure)
    c = np.array([[e.axial_compliance for e in each for _ in range(e.modes.count)] for each in parts])
    c *= energy / length
    small = c < LEAST_COMPLIANCE
    outer = int(small[:, :split].any())
    gain = np.where(small, GAIN, 1.0 / np.where(small, 1.0, c)) if small.any() else 1.0 / c
    roots, tips = ([ends[strip.name, end].body for strip in scene.strips] for end in ("start", "end"))
    strips = Strips(
        along=along_of(system, shape, (speed, rest), to_modes),
        compliance=c,
        gain=gain,
        numbers=_numbers_of(system, shape, ends),
        roots=np.array(roots, dtype=np.int64),
        tips=np.array(tips, dtype=np.int64),
        split=split,
        coupled=outer * split,
        outer=outer,
        measure=measure,
    )
    return strips, rest, to_modes


def bends_of(scene: Scene) -> list[Bending]:
    """Return the bending of each strip."""
    bends = {e.strip: e for e in scene.of(Bending)}
    return [bends[strip.name] for strip in scene.strips]


def _mixed_of(scene: Scene) -> dict[str, list[MixedStretching]]:
    """The mixed stretching of each strip, a part for each kind of modes."""
    mixed: dict[str, list[MixedStretching]] = {strip.name: [] for strip in scene.strips}
    for effect in scene.of(MixedStretching):
        mixed[effect.strip].append(effect)
    return mixed


def along_of(system: System, shape: Shape, speeds: tuple[Array, Array], to_modes: Array) -> Array:
    """Return what changes along the strips (S, P, 11 + K), at the points of a shape; speeds: as of
    ``speeds_of``."""
    scene, length, energy = system.scene, system.scales.length, system.scales.energy
    bends, u, degree = bends_of(scene), shape.rule[WHERE], scene.strips[0].basis.degree
    (speed, rest), at = speeds, u.tobytes()
    along = np.zeros((*speed.shape, MODES + to_modes.shape[-1]))
    along[..., SPEED] = speed
    along[..., CURVATURE] = rest
    for row, bend, parts, back in zip(along, bends, _mixed_of(scene).values(), to_modes, strict=True):
        row[:, CURVATURE] += bend.natural_curvature * length
        row[:, RIGIDITY] = bend.rigidity_at(degree, u) / (energy * length)
        if bend.curl is not None:
            row[:, DROP:MODES], row[:, CURL] = bend.curl.drop(degree, u), bend.curl.flattening / length
        if parts:
            row[:, MODES:] = _values(tuple(e.modes for e in parts), at) @ back
    return along


def _numbers_of(system: System, shape: Shape, ends: Ends) -> Array:
    """The numbers of ``Strips``, (S, 16 + 2 n)."""
    scene, length, energy = system.scene, system.scales.length, system.scales.energy
    numbers = np.zeros((len(scene.strips), ON_POINTS + 2 * len(shape.order)))
    mixed = {e.strip: e for e in reversed(scene.of(MixedStretching))}
    consistent = {e.strip: e for e in scene.of(Stretching)}
    for row, strip in zip(numbers, scene.strips, strict=True):
        name, points = strip.name, strip.control_points.tolist()
        if name in mixed:
            row[STRAIN] = mixed[name].natural_strain
        if name in consistent:
            row[STRAIN] = consistent[name].natural_strain
            row[STRETCHING] = consistent[name].axial_rigidity * length / energy
        for place, end in ((ROOT, "start"), (TIP, "end")):
            (x, y), direction = ends[name, end].point, ends[name, end].direction
            row[place : place + 3] = x / length, y / length, direction
        row[REACH] = math.dist(points[1], points[0]) / length
        row[REACH + 1] = math.dist(points[-1], points[-2]) / length
    if system.weight.size:
        _add_dead(system, shape, numbers)
    return numbers


def _add_dead(system: System, shape: Shape, numbers: Array) -> None:
    """Dead loads on the control points, in the order of elimination, and per du."""
    scene, weight = system.scene, system.weight
    force = system.scales.energy / system.scales.length
    for row, strip in zip(numbers, scene.strips, strict=True):
        dead = weight[system.layout.strip(strip.name)].reshape(-1, 2)
        row[ON_POINTS:] = in_order(dead, shape).ravel() / force
        row[PER_U:ON_POINTS] = scene.weight_of(strip.name).ravel() / force


def speeds_of(scene: Scene, shape: Shape, length: float) -> tuple[Array, Array]:
    """Return speed and curvature (S, P) [1] at rest of a scene's strips, over a length [m]."""
    points = np.array([strip.control_points for strip in scene.strips]) / length
    curve = shape.tables[FIRST : SECOND + 1, None] @ in_order(points, shape)
    (x1, x2), (y1, y2) = curve[..., 0], curve[..., 1]
    speed = np.hypot(x1, y1)
    return speed, (x1 * y2 - y1 * x2) / speed**3


def _orthonormal_modes(
    parts: list[tuple[tuple[AxialModes, Taper | None], ...]], basis: Bezier, points: int, speed: Array
) -> Array:
    """The scene's axial forces (S, K, K) by those of modes that are orthonormal along strips of a speed
    (S, G), weighed by their compliance over that at the start.

    Those of one distribution of the speed are kept: all straight strips have the same, but for round-off.
    """
    mean = speed.sum(axis=1, keepdims=True) / speed.shape[1]
    alike = np.rint(speed / mean / ROUND_OFF)
    found = [_modes_of(each, basis, points, v.tobytes()) for each, v in zip(parts, alike, strict=True)]
    return np.asarray(np.array(found) / np.sqrt(mean)[..., None])


@lru_cache(maxsize=64)
def _values(parts: tuple[AxialModes, ...], at: bytes) -> Array:
    """Values of the scene's modes at the numbers of a buffer (P, K)."""
    return np.column_stack([modes.evaluate(np.frombuffer(at)) for modes in parts])


@lru_cache(maxsize=64)
def _modes_of(
    parts: tuple[tuple[AxialModes, Taper | None], ...], basis: Bezier, points: int, speed: bytes
) -> Array:
    """The same of one strip of mean speed 1; speed: in ``ROUND_OFF``."""
    u, weight = basis.gauss_rule(points)
    weight = weight * (ROUND_OFF * np.frombuffer(speed))
    back = np.zeros((0, 0))
    for modes, taper in parts:
        full, to_part = modes.evaluate(u), np.eye(modes.count)
        soft = weight if taper is None else weight / taper.area(u)
        if not isinstance(modes, SlideModes):  # the mean first
            to_part[:, 0] = np.linalg.lstsq(full, np.ones(len(u)), rcond=None)[0]
            full = full @ to_part
        factor = np.linalg.cholesky(full.T @ (soft[:, None] * full))
        k, m = len(back), modes.count
        back = np.block([[back, np.zeros((k, m))], [np.zeros((m, k)), to_part @ np.linalg.inv(factor).T]])
    return back
