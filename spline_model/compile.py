"""From a scene to flat operator tables: ``compile_scene``."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from spline_model import tables as build
from spline_model.effects import Bending, MixedStretching, Stretching
from spline_model.effects.base import Constraint, OpenPotential
from spline_model.kernels.assemble import Tables
from spline_model.layout import Layout
from spline_model.scales import Scales, scene_scales
from spline_model.scene import Scene

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class System:
    """A compiled scene.

    Attributes
    ----------
    tables : the flat operator tables that the kernels walk.
    open_potentials : the potentials whose derivatives are Python's.
    layout : what stands where in the vector of unknowns z.
    scales : the unit of each unknown, which makes residuals dimensionless.
    rest : z at rest, shape (layout.size,).
    """

    scene: Scene
    tables: Tables
    open_potentials: tuple[OpenPotential, ...]
    layout: Layout
    scales: Scales
    rest: Array

    @cached_property
    def rest_curvature(self) -> Array:
        """Curvature at rest at the points of bending (P,) [1/m]."""
        bending = self.scene.of(Bending)
        if not any(effect.natural_curvature for effect in bending):
            return self.tables.bending.curvature
        straight = [replace(effect, natural_curvature=0.0) for effect in bending]
        return build.bending_table(self.scene, self.layout, straight).curvature


def compile_scene(scene: Scene) -> System:
    """Sort the effects once into flat tables; kinds that are not named stay empty."""
    layout = make_layout(scene)
    bending, mixed = scene.of(Bending), scene.of(MixedStretching)
    tables = Tables(
        bending=build.bending_table(scene, layout, bending),
        stretching=build.stretching_table(scene, layout, scene.of(Stretching)),
        axial_force=build.axial_force_table(scene, layout, mixed, range(len(mixed))),
        clamps=build.clamp_table(scene, layout),
        drives=build.drive_table(scene, layout),
        loads=build.load_table(scene, layout),
        weight=build.weight(scene, layout),
    )
    rest = np.zeros(layout.size)
    for strip in scene.strips:
        rest[layout.strip(strip.name)] = strip.control_points.ravel()
    for body in scene.bodies:
        rest[layout.body(body.name)][:2] = body.centre
    return System(
        scene=scene,
        tables=tables,
        open_potentials=scene.of(OpenPotential),
        layout=layout,
        scales=scene_scales(scene, layout),
        rest=rest,
    )


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
