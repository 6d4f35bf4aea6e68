"""What tells the strips' elements of a scene from one another: the numbers of each, in one row."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from spline_model.basis import AxialModes, SlideModes, SplineBasis, all_modes
from spline_model.compile import System
from spline_model.effects import MixedStretching, RootCompliance, Shear, Stretching, StripGravity
from spline_model.reduced.ends import End
from spline_model.strip.element import (
    FIRST,
    ON_POINTS,
    PER_U,
    REACH,
    ROOT,
    SECOND,
    SHEAR,
    SPRING,
    STRAIN,
    STRETCHING,
    TIP,
    Shape,
)
from spline_model.tables import steady_loads

Array = NDArray[np.float64]


def in_order(points: Array, shape: Shape) -> Array:
    """Values at control points (..., n, k) in the order of elimination, zero at those on no curve."""
    on_none = np.zeros((*points.shape[:-2], 2, points.shape[-1]))
    return np.asarray(np.concatenate((points, on_none), axis=-2)[..., shape.order, :])


def speeds(shape: Shape, control_points: Array) -> tuple[Array, Array]:
    """Speed and curvature at rest (S, G) of strips of control points (S, n, 2)."""
    curve = shape.tables[FIRST : SECOND + 1, None] @ in_order(control_points, shape)
    (x1, x2), (y1, y2) = curve[..., 0], curve[..., 1]
    speed = np.hypot(x1, y1)
    return speed, (x1 * y2 - y1 * x2) / speed**3


def numbers_of(
    system: System,
    shape: Shape,
    mixed: list[list[MixedStretching]],
    consistent: dict[str, Stretching],
    starts: list[End],
    tips: list[End],
) -> Array:
    """The numbers of ``Strips``, (S, 15 + 2 n)."""
    scene, length, energy = system.scene, system.scales.length, system.scales.energy
    numbers = np.zeros((len(scene.strips), ON_POINTS + 2 * len(shape.order)))
    for row, strip, parts in zip(numbers, scene.strips, mixed, strict=True):
        stretching, points = consistent.get(strip.name), strip.control_points.tolist()
        row[STRETCHING] = 0.0 if stretching is None else stretching.axial_rigidity * length / energy
        row[STRAIN] = _natural_strain(parts, stretching)
        row[REACH:SPRING] = (
            math.dist(points[1], points[0]) / length,
            math.dist(points[-1], points[-2]) / length,
        )
    roots = {(e.strip, e.end): 1.0 / e.compliance for e in scene.of(RootCompliance)}
    if roots:  # a free end has a frame of its own, against which it does not turn
        for row, strip in zip(numbers, scene.strips, strict=True):
            springs = [roots.get((strip.name, end), energy) / energy for end in ("start", "end")]
            row[SPRING:SHEAR] = springs
    for shear in scene.of(Shear):
        s = [strip.name for strip in scene.strips].index(shear.strip)
        whole = float(scene.strips[s].share_of_length().sum())
        numbers[s, SHEAR] = length**2 / (energy * shear.compliance * whole)
    numbers[:, ROOT:TIP], numbers[:, TIP:REACH] = _frames(starts, length), _frames(tips, length)
    if system.weight.size:
        numbers[:, ON_POINTS:], numbers[:, PER_U:ON_POINTS] = _dead(system, shape)
    return numbers


def _frames(ends: list[End], length: float) -> Array:
    """Point over the length and direction of each end, (S, 3)."""
    return np.array([(e.point[0] / length, e.point[1] / length, e.direction) for e in ends])


def _dead(system: System, shape: Shape) -> tuple[Array, Array]:
    """Dead load on the control points (S, 2 n), in the order of elimination, and per du (S, 2)."""
    scene, weight = system.scene, system.weight.copy()
    for place, value in steady_loads(scene, system.layout):  # they act on bodies and free ends
        weight[place] -= value
    force = system.scales.energy / system.scales.length
    dead, per_u = np.zeros((len(scene.strips), 2 * len(shape.order))), np.zeros((len(scene.strips), 2))
    for s, strip in enumerate(scene.strips):
        dead[s] = in_order(weight[system.layout.strip(strip.name)].reshape(-1, 2), shape).ravel() / force
        for effect in scene.of(StripGravity):
            if effect.strip == strip.name:
                mass = effect.linear_density * float(strip.share_of_length().sum())
                per_u[s] += mass * np.asarray(effect.acceleration) / force
    return dead, per_u


ROUND_OFF = 1e-14
"""Difference of speeds along a strip, in its mean, that is none."""


def orthonormal_modes(
    parts: list[tuple[AxialModes, ...]], basis: SplineBasis, points: int, speed: Array
) -> tuple[Array, Array]:
    """Modes (S, G, K) orthonormal along strips of a speed (S, G), and the scene's modes from them (S, K, K).

    Those of one distribution of the speed are kept: all straight strips have the same, but for round-off.
    """
    mean = speed.sum(axis=1, keepdims=True) / speed.shape[1]
    alike = np.rint(speed / mean / ROUND_OFF)
    found = [_modes_of(each, basis, points, v.tobytes()) for each, v in zip(parts, alike, strict=True)]
    longer = np.sqrt(mean)[..., None]
    values, back = (np.array(each) / longer for each in zip(*found, strict=True))
    return values, back


@lru_cache(maxsize=64)
def _modes_of(
    parts: tuple[AxialModes, ...], basis: SplineBasis, points: int, speed: bytes
) -> tuple[Array, Array]:
    """The same of one strip of mean speed 1; speed: in ``ROUND_OFF``."""
    u, weight = basis.gauss_rule(points)
    weight = weight * (ROUND_OFF * np.frombuffer(speed))
    values, back = np.zeros((len(u), 0)), np.zeros((0, 0))
    for modes in parts:
        full, to_part = all_modes(modes, u), np.eye(modes.count)
        if not isinstance(modes, SlideModes):  # the mean first
            to_part[:, 0] = np.linalg.lstsq(full, np.ones(len(u)), rcond=None)[0]
            full = full @ to_part
        factor = np.linalg.cholesky(full.T @ (weight[:, None] * full))
        values = np.column_stack((values, np.linalg.solve(factor, full.T).T))
        k, m = len(back), modes.count
        back = np.block([[back, np.zeros((k, m))], [np.zeros((m, k)), to_part @ np.linalg.inv(factor).T]])
    return values, back


def _natural_strain(parts: list[MixedStretching], consistent: Stretching | None) -> float:
    """Stress-free strain of a strip."""
    if consistent is not None:
        return consistent.natural_strain
    return parts[0].natural_strain if parts else 0.0
