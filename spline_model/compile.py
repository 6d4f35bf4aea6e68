"""From a scene to a system of unknowns, and to flat operator tables where they are asked for."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from spline_model import tables as build
from spline_model.effects import Bending, Clamp, DrivenDisplacement, MixedStretching
from spline_model.effects.base import Constraint, OpenPotential
from spline_model.layout import Layout
from spline_model.quadrature import PointTable, point_table
from spline_model.scene import Scene
from spline_model.tables import DriveTable, LoadTable, Tables

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
    def points(self) -> PointTable:
        """Gauss points of bending and stretching."""
        return self._table("points", lambda s: point_table(s.scene, s.layout))

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
        """All tables, which the bordered form and the motions walk."""
        return Tables(
            points=self.points,
            clamps=self._table("clamps", lambda s: build.clamp_table(s.scene, s.layout)),
            drives=self.drives,
            loads=self.loads,
            weight=self.weight,
        )

    def once(self, name: str, make: Callable[[System], Any]) -> Any:
        """What ``make`` makes of the system, kept with it under a name."""
        if name not in self._made:
            self._made[name] = make(self)
        return self._made[name]

    @cached_property
    def _made(self) -> dict[str, Any]:
        return {}

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


@dataclass(frozen=True, kw_only=True, eq=False)
class Scales:
    """Length L and energy EI / L of a scene.

    Scaled by ``unit / energy`` a force row is in EI/L^2, a moment row in EI/L, a
    compatibility or constraint row in L or rad: no tolerance changes its meaning with the
    size, the material or the slenderness of a design.
    """

    scene: Scene
    layout: Layout
    length: float
    energy: float

    @cached_property
    def unit(self) -> NDArray[np.float64]:
        """The unit of each unknown (N,)."""
        force, moment = self.energy / self.length, self.energy
        unit = np.full(self.layout.size, self.length)
        for start in self.layout.bodies.values():
            unit[start + 2] = 1.0
        for start, count in self.layout.modes:
            unit[start : start + count] = force
        for constraint, (row, count) in zip(self.scene.of(Constraint), self.layout.multipliers, strict=True):
            if isinstance(constraint, Clamp):
                unit[row : row + count] = (force, force, moment)
            else:
                unit[row : row + count] = force if isinstance(constraint, DrivenDisplacement) else moment
        return unit


def scene_scales(scene: Scene, layout: Layout) -> Scales:
    """Scales from the longest strip and the largest flexural rigidity."""
    length = max(_arc_length(strip.control_points) for strip in scene.strips)
    rigidity = max((e.flexural_rigidity for e in scene.of(Bending)), default=1.0)
    return Scales(scene=scene, layout=layout, length=length, energy=rigidity / length)


def _arc_length(control_points: NDArray[np.float64]) -> float:
    """Length of the control polygon: the arc length of a straight strip, an upper bound of a curved one."""
    points = control_points.tolist()
    return sum(map(math.dist, points[:-1], points[1:]))
