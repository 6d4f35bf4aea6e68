"""From a scene to flat operator tables: ``compile_scene``."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from spline_model.effects import (
    GROUND,
    MEASURES,
    AppliedForce,
    AppliedMoment,
    Bending,
    Clamp,
    DrivenRotation,
    MixedStretching,
    Stretching,
)
from spline_model.effects.base import Constraint
from spline_model.kernels.assemble import Tables
from spline_model.kernels.axial_force import AxialForceTable
from spline_model.kernels.bending import BendingTable
from spline_model.kernels.clamps import ClampTable
from spline_model.kernels.drives import DriveTable, LoadTable
from spline_model.kernels.stretching import StretchingTable
from spline_model.layout import Layout
from spline_model.quadrature import Points, strip_points
from spline_model.scales import Scales, scene_scales
from spline_model.scene import Scene

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class System:
    """A compiled scene.

    Attributes
    ----------
    tables : the flat operator tables that the kernels walk.
    layout : what stands where in the vector of unknowns z.
    scales : the unit of each unknown, which makes residuals dimensionless.
    rest : z at rest, shape (layout.size,).
    """

    scene: Scene
    tables: Tables
    layout: Layout
    scales: Scales
    rest: Array


def compile_scene(scene: Scene) -> System:
    """Sort the effects once into flat tables; kinds that are not named stay empty."""
    layout = make_layout(scene)
    tables = Tables(
        bending=_bending(scene, layout),
        stretching=_stretching(scene, layout),
        axial_force=_axial_force(scene, layout),
        clamps=_clamps(scene, layout),
        drives=_drives(scene, layout),
        loads=_loads(scene, layout),
    )
    rest = np.zeros(layout.size)
    for strip in scene.strips:
        rest[layout.strip(strip.name)] = strip.control_points.ravel()
    for body in scene.bodies:
        rest[layout.body(body.name)][:2] = body.centre
    return System(scene=scene, tables=tables, layout=layout, scales=scene_scales(scene, layout), rest=rest)


def make_layout(scene: Scene) -> Layout:
    """Count the unknowns off: control points, bodies, axial forces, multipliers."""
    at, strips, bodies, modes, rows = 0, {}, {}, [], []
    for strip in scene.strips:
        strips[strip.name] = (at, strip.basis.control_points)
        at += 2 * strip.basis.control_points
    for body in scene.bodies:
        bodies[body.name] = at
        at += 3
    coordinates = at
    for effect in scene.of(MixedStretching):
        modes.append((at, effect.modes.count))
        at += effect.modes.count
    for constraint in scene.of(Constraint):
        rows.append((at, constraint.rows))
        at += constraint.rows
    return Layout(
        strips=strips,
        bodies=bodies,
        modes=tuple(modes),
        multipliers=tuple(rows),
        coordinate_count=coordinates,
        size=at,
    )


def _bending(scene: Scene, layout: Layout) -> BendingTable:
    effects = scene.of(Bending)
    points = strip_points([(scene.strip(e.strip), e.gauss_points) for e in effects], layout)
    return BendingTable(
        first=points.first,
        width=points.width,
        d1=points.d1,
        d2=points.d2,
        weight=points.weight,
        speed=points.speed,
        curvature=points.curvature,
        rigidity=points.spread([e.flexural_rigidity for e in effects]),
        measure=_measures(points, effects),
    )


def _stretching(scene: Scene, layout: Layout) -> StretchingTable:
    effects = scene.of(Stretching)
    points = strip_points([(scene.strip(e.strip), e.gauss_points) for e in effects], layout)
    return StretchingTable(
        first=points.first,
        width=points.width,
        d1=points.d1,
        weight=points.weight,
        speed=points.speed,
        rigidity=points.spread([e.axial_rigidity for e in effects]),
        measure=_measures(points, effects),
    )


def _axial_force(scene: Scene, layout: Layout) -> AxialForceTable:
    effects = scene.of(MixedStretching)
    points = strip_points([(scene.strip(e.strip), e.gauss_points) for e in effects], layout)
    values = np.zeros((len(points.u), max((e.modes.width for e in effects), default=0)))
    first = np.zeros(len(points.u), dtype=np.int64)
    width = np.zeros(len(points.u), dtype=np.int64)
    for i, effect in enumerate(effects):
        mine = points.source == i
        support, modes = effect.modes.evaluate(points.u[mine])
        values[mine, : effect.modes.width] = modes
        first[mine] = layout.modes[i][0] + support
        width[mine] = effect.modes.width
    return AxialForceTable(
        first=points.first,
        width=points.width,
        d1=points.d1,
        weight=points.weight,
        speed=points.speed,
        compliance=points.spread([e.axial_compliance for e in effects]),
        mode_first=first,
        mode_width=width,
        modes=values,
        measure=_measures(points, effects),
    )


def _measures(points: Points, effects: Sequence[Bending | Stretching | MixedStretching]) -> NDArray[np.int64]:
    return points.spread([MEASURES.index(e.measure) for e in effects]).astype(np.int64)


def _clamps(scene: Scene, layout: Layout) -> ClampTable:
    constraints = scene.of(Constraint)
    rows = []
    for i, clamp in enumerate(constraints):
        if not isinstance(clamp, Clamp):
            continue
        strip = scene.strip(clamp.strip)
        start, count = layout.strips[clamp.strip]
        at_start = clamp.end == "start"
        end, inner = (0, 1) if at_start else (count - 1, count - 2)
        along = strip.control_points[inner] - strip.control_points[end]
        sign = 1.0 if at_start else -1.0
        centre = np.zeros(2) if clamp.to == GROUND else scene.body(clamp.to).centre
        rows.append(
            (
                start + 2 * end,
                start + 2 * inner,
                sign,
                -1 if clamp.to == GROUND else layout.bodies[clamp.to],
                strip.control_points[end] - centre,
                np.arctan2(sign * along[1], sign * along[0]),
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


def _drives(scene: Scene, layout: Layout) -> DriveTable:
    constraints = scene.of(Constraint)
    drives = [
        (c, layout.multipliers[i][0]) for i, c in enumerate(constraints) if isinstance(c, DrivenRotation)
    ]
    return DriveTable(
        coordinate=np.array([layout.bodies[d.body] + 2 for d, _ in drives], dtype=np.int64),
        target=np.array([d.angle for d, _ in drives], dtype=float),
        row=np.array([row for _, row in drives], dtype=np.int64),
    )


def _loads(scene: Scene, layout: Layout) -> LoadTable:
    rows: list[tuple[int, float]] = []
    for force in scene.of(AppliedForce):
        rows += [(layout.bodies[force.body] + i, force.force[i]) for i in range(2)]
    for moment in scene.of(AppliedMoment):
        rows.append((layout.bodies[moment.body] + 2, moment.moment))
    return LoadTable(
        coordinate=np.array([i for i, _ in rows], dtype=np.int64),
        value=np.array([value for _, value in rows], dtype=float),
    )
