"""One table a class of effect: from frozen values to the arrays that the kernels walk."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from spline_model.effects import (
    GROUND,
    MEASURES,
    AppliedForce,
    AppliedMoment,
    Bending,
    BodyGravity,
    Clamp,
    DrivenDisplacement,
    DrivenRotation,
    MixedStretching,
    Stretching,
    StripGravity,
    TipForce,
)
from spline_model.effects.base import Constraint, Load
from spline_model.effects.history import STEADY, History
from spline_model.kernels.axial_force import AxialForceTable
from spline_model.kernels.bending import BendingTable
from spline_model.kernels.clamps import ClampTable
from spline_model.kernels.drives import DriveTable, LoadTable
from spline_model.kernels.stretching import StretchingTable
from spline_model.layout import Layout
from spline_model.quadrature import Points, modes_at, strip_points
from spline_model.scene import Scene

Array = NDArray[np.float64]
Sized = AppliedForce | AppliedMoment | TipForce
SIZED = (AppliedForce, AppliedMoment, TipForce)


def bending_table(scene: Scene, layout: Layout, effects: Sequence[Bending]) -> BendingTable:
    """Gauss points of bending effects; the stress-free curvature is the one at rest and the natural one."""
    points = strip_points([(scene.strip(e.strip), e.gauss_points) for e in effects], layout)
    return BendingTable(
        first=points.first,
        width=points.width,
        d1=points.d1,
        d2=points.d2,
        weight=points.weight,
        speed=points.speed,
        curvature=points.curvature + points.spread([e.natural_curvature for e in effects]),
        rigidity=points.spread([e.flexural_rigidity for e in effects]),
        measure=_measures(points, effects),
    )


def stretching_table(scene: Scene, layout: Layout, effects: Sequence[Stretching]) -> StretchingTable:
    """Gauss points of stretching by quadrature."""
    points = strip_points([(scene.strip(e.strip), e.gauss_points) for e in effects], layout)
    return StretchingTable(
        first=points.first,
        width=points.width,
        d1=points.d1,
        weight=points.weight,
        speed=points.speed,
        strain=points.spread([e.natural_strain for e in effects]),
        rigidity=points.spread([e.axial_rigidity for e in effects]),
        measure=_measures(points, effects),
    )


def axial_force_table(
    scene: Scene, layout: Layout, effects: Sequence[MixedStretching], places: Sequence[int]
) -> AxialForceTable:
    """Gauss points of mixed stretching; ``places`` are the effects' numbers in the scene."""
    points = strip_points([(scene.strip(e.strip), e.gauss_points) for e in effects], layout)
    values = np.zeros((len(points.u), max((e.modes.width for e in effects), default=0)))
    first = np.zeros(len(points.u), dtype=np.int64)
    width = np.zeros(len(points.u), dtype=np.int64)
    for i, (effect, place) in enumerate(zip(effects, places, strict=True)):
        mine = points.source == i
        support, modes = modes_at(effect.modes, scene.strip(effect.strip).basis, effect.gauss_points)
        values[mine, : effect.modes.width] = modes
        first[mine] = layout.modes[place][0] + support
        width[mine] = effect.modes.width
    return AxialForceTable(
        first=points.first,
        width=points.width,
        d1=points.d1,
        weight=points.weight,
        speed=points.speed,
        strain=points.spread([e.natural_strain for e in effects]),
        compliance=points.spread([e.axial_compliance for e in effects]),
        mode_first=first,
        mode_width=width,
        modes=values,
        measure=_measures(points, effects),
    )


def _measures(points: Points, effects: Sequence[Bending | Stretching | MixedStretching]) -> NDArray[np.int64]:
    return points.spread([MEASURES.index(e.measure) for e in effects]).astype(np.int64)


def clamp_table(scene: Scene, layout: Layout) -> ClampTable:
    """The clamped strip ends."""
    rows = []
    for i, clamp in enumerate(scene.of(Constraint)):
        if not isinstance(clamp, Clamp):
            continue
        strip = scene.strip(clamp.strip)
        start, count = layout.strips[clamp.strip]
        at_start = clamp.end == "start"
        end, inner = (0, 1) if at_start else (count - 1, count - 2)
        sign = 1.0 if at_start else -1.0
        along = sign * (strip.control_points[inner] - strip.control_points[end])
        centre = np.zeros(2) if clamp.to == GROUND else scene.body(clamp.to).centre
        rows.append(
            (
                start + 2 * end,
                start + 2 * inner,
                sign,
                -1 if clamp.to == GROUND else layout.bodies[clamp.to],
                strip.control_points[end] - centre,
                np.arctan2(along[1], along[0]),
                layout.multipliers[i][0],
            )
        )
    end_, inner_, sign_, body, point, direction, row = zip(*rows, strict=True) if rows else ((),) * 7
    return ClampTable(
        end=np.array(end_, dtype=np.int64),
        inner=np.array(inner_, dtype=np.int64),
        sign=np.array(sign_, dtype=float),
        body=np.array(body, dtype=np.int64),
        point=np.array(point, dtype=float).reshape(-1, 2),
        direction=np.array(direction, dtype=float),
        row=np.array(row, dtype=np.int64),
    )


def drive_table(scene: Scene, layout: Layout) -> DriveTable:
    """The driven rotations and displacements, one row a coordinate."""
    rows: list[tuple[int, float, float, int, int, float, float]] = []
    histories: list[History] = []
    for i, drive in enumerate(scene.of(Constraint)):
        if isinstance(drive, DrivenRotation):
            parts = [(2, 0.0, drive.angle)]
        elif isinstance(drive, DrivenDisplacement):
            centre = scene.body(drive.body).centre
            grown = 0.0 if drive.steady else 1.0
            parts = [
                (k, float(centre[k]) + (1.0 - grown) * moved, grown * moved)
                for k, moved in enumerate(drive.displacement)
            ]
        else:
            continue
        for k, (offset, origin, target) in enumerate(parts):
            place = layout.bodies[drive.body] + offset
            rows.append((place, origin, target, layout.multipliers[i][0] + k, int(offset == 2), *drive.held))
            histories.append(drive.history or STEADY)
    coordinate, origin_, target_, row, turns, begin, until = zip(*rows, strict=True) if rows else ((),) * 7
    return DriveTable(
        coordinate=np.array(coordinate, dtype=np.int64),
        origin=np.array(origin_, dtype=float),
        target=np.array(target_, dtype=float),
        row=np.array(row, dtype=np.int64),
        turns=np.array(turns, dtype=np.int64),
        begin=np.array(begin, dtype=float),
        until=np.array(until, dtype=float),
        **_histories(histories),
    )


def load_table(scene: Scene, layout: Layout) -> LoadTable:
    """Forces on bodies and strip ends and moments on bodies that grow, one row a component."""
    rows: list[tuple[int, float, int]] = []
    histories: list[History] = []
    for load in scene.of(Load):
        if isinstance(load, SIZED) and not load.steady:
            parts = _components(load, layout)
            rows += parts
            histories += [load.history] * len(parts)
    return LoadTable(
        coordinate=np.array([row[0] for row in rows], dtype=np.int64),
        value=np.array([row[1] for row in rows], dtype=float),
        turns=np.array([row[2] for row in rows], dtype=np.int64),
        **_histories(histories),
    )


def _components(load: Sized, layout: Layout) -> list[tuple[int, float, int]]:
    """Place, value and kind (1: a moment) of each component of a load."""
    if isinstance(load, AppliedMoment):
        return [(layout.bodies[load.body] + 2, load.moment, 1)]
    if isinstance(load, AppliedForce):
        return [(layout.bodies[load.body] + k, load.force[k], 0) for k in range(2)]
    start, count = layout.strips[load.strip]
    end = start if load.end == "start" else start + 2 * count - 2
    return [(end + k, load.force[k], 0) for k in range(2)]


def _histories(histories: Sequence[History]) -> dict[str, Any]:
    """Histories end to end: first and number of pairs of each, and all times and factors."""
    counts = np.array([len(history) for history in histories], dtype=np.int64)
    pairs = np.array([pair for history in histories for pair in history], dtype=float).reshape(-1, 2)
    return {
        "first": np.concatenate(([0], np.cumsum(counts)))[:-1].astype(np.int64),
        "pairs": counts,
        "times": pairs[:, 0].copy(),
        "factors": pairs[:, 1].copy(),
    }


def steady_loads(scene: Scene, layout: Layout) -> list[tuple[int, float]]:
    """Place and value of each component of the loads that act in full at any load factor."""
    steady = [load for load in scene.of(Load) if isinstance(load, SIZED) and load.steady]
    return [(place, value) for load in steady for place, value, _ in _components(load, layout)]


def weight(scene: Scene, layout: Layout) -> Array:
    """Generalised force of gravity and steady loads, (Q,) [N, N m]; empty where no effect names any."""
    strips, bodies = scene.of(StripGravity), scene.of(BodyGravity)
    steady = steady_loads(scene, layout)
    if not (strips or bodies or steady):
        return np.zeros(0)
    force = np.zeros(layout.coordinate_count)
    for strip in strips:
        share = strip.linear_density * scene.strip(strip.strip).share_of_length()
        force[layout.strip(strip.strip)] += np.outer(share, strip.acceleration).ravel()
    for body in bodies:
        force[layout.body(body.body)][:2] += body.mass * np.asarray(body.acceleration)
    for place, value in steady:
        force[place] += value
    return force
