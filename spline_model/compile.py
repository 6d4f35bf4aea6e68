"""From a scene to a system of unknowns, and to flat operator tables where they are asked for."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from spline_model import tables as build
from spline_model.effects import Bending, MixedStretching, Stretching
from spline_model.effects.base import Constraint, OpenPotential
from spline_model.kernels.assemble import Tables
from spline_model.kernels.axial_force import AxialForceTable
from spline_model.kernels.bending import BendingTable
from spline_model.kernels.drives import DriveTable, LoadTable
from spline_model.kernels.stretching import StretchingTable
from spline_model.layout import Layout
from spline_model.scales import Scales, scene_scales
from spline_model.scene import Scene

Array = NDArray[np.float64]
Table = TypeVar("Table")


@dataclass(frozen=True, kw_only=True, eq=False)
class System:
    """A scene with its unknowns counted off and its units; each table is made when it is first asked for.

    Attributes
    ----------
    layout : what stands where in the vector of unknowns z.
    scales : the unit of each unknown, which makes residuals dimensionless.
    changed : tables that are not those of the scene, by name.
    """

    scene: Scene
    layout: Layout
    scales: Scales
    changed: Mapping[str, Any] = field(default_factory=dict)

    def with_tables(self, **changed: Any) -> System:
        """The same scene with other tables of these names."""
        return replace(self, changed={**self.changed, **changed})

    @cached_property
    def bending(self) -> BendingTable:
        """Gauss points of bending."""
        return self._table("bending", lambda s: build.bending_table(s.scene, s.layout, s.scene.of(Bending)))

    @cached_property
    def stretching(self) -> StretchingTable:
        """Gauss points of stretching by quadrature."""
        return self._table(
            "stretching", lambda s: build.stretching_table(s.scene, s.layout, s.scene.of(Stretching))
        )

    @cached_property
    def axial_force(self) -> AxialForceTable:
        """Gauss points of mixed stretching."""
        mixed = self.scene.of(MixedStretching)
        return self._table(
            "axial_force", lambda s: build.axial_force_table(s.scene, s.layout, mixed, range(len(mixed)))
        )

    @cached_property
    def drives(self) -> DriveTable:
        """Driven coordinates."""
        return self._table("drives", lambda s: build.drive_table(s.scene, s.layout))

    @cached_property
    def loads(self) -> LoadTable:
        """Loads, one row a component."""
        return self._table("loads", lambda s: build.load_table(s.scene, s.layout))

    @cached_property
    def weight(self) -> Array:
        """Generalised force of gravity and steady loads (Q,) [N, N m]; empty where no effect names any."""
        return self._table("weight", lambda s: build.weight(s.scene, s.layout))

    @cached_property
    def tables(self) -> Tables:
        """The flat operator tables that the kernels of the bordered system walk."""
        return Tables(
            bending=self.bending,
            stretching=self.stretching,
            axial_force=self.axial_force,
            clamps=self._table("clamps", lambda s: build.clamp_table(s.scene, s.layout)),
            drives=self.drives,
            loads=self.loads,
            weight=self.weight,
        )

    def _table(self, name: str, make: Callable[[System], Table]) -> Table:
        changed: Table = self.changed[name] if name in self.changed else make(self)
        return changed

    @property
    def open_potentials(self) -> tuple[OpenPotential, ...]:
        """The potentials whose derivatives are Python's."""
        return self.scene.of(OpenPotential)

    @cached_property
    def rest(self) -> Array:
        """z at rest, shape (layout.size,)."""
        rest = np.zeros(self.layout.size)
        for strip in self.scene.strips:
            rest[self.layout.strip(strip.name)] = strip.control_points.ravel()
        for body in self.scene.bodies:
            rest[self.layout.body(body.name)][:2] = body.centre
        return rest

    @cached_property
    def rest_curvature(self) -> Array:
        """Curvature at rest at the points of bending (P,) [1/m]."""
        bending = self.scene.of(Bending)
        if not any(effect.natural_curvature for effect in bending):
            return self.bending.curvature
        straight = [replace(effect, natural_curvature=0.0) for effect in bending]
        return build.bending_table(self.scene, self.layout, straight).curvature


def compile_scene(scene: Scene) -> System:
    """The scene as a system: its unknowns counted off, its units chosen."""
    layout = make_layout(scene)
    return System(scene=scene, layout=layout, scales=scene_scales(scene, layout))


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
