"""From a scene to a system of unknowns, and to flat operator tables and matrices where they are asked for."""

from __future__ import annotations

import math
from collections.abc import Callable
from copy import copy
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from spline_model.effects import (
    Bending,
    BodyDamper,
    BodyInertia,
    Clamp,
    Driven,
    MixedStretching,
    SectionRotaryInertia,
    Stretching,
    StripDamping,
    StripDrag,
    StripInertia,
)
from spline_model.effects.base import Constraint
from spline_model.effects.boundary import FOLLOWER
from spline_model.errors import InvalidParameter
from spline_model.frames import Frames
from spline_model.scene import Layout, Scene, Strip
from spline_model.tables import (
    NO_FOLLOWERS,
    DriveTable,
    Followers,
    LoadTable,
    between_bodies,
    frames_of,
    weight,
)

Array = NDArray[np.float64]

UNTURNED = ("layout", "scales", "loads", "weight", "is_preloaded", "rest")
"""What of a system is the same at all rotations, and made once."""


@dataclass(frozen=True, kw_only=True, eq=False)
class System:
    """A scene with its units; each table and matrix is made when it is first asked for."""

    scene: Scene

    @cached_property
    def layout(self) -> Layout:
        """What stands where in the vector of unknowns z."""
        return self.scene.layout

    @cached_property
    def scales(self) -> _Scales:
        """The unit of each unknown, which makes residuals dimensionless."""
        return _Scales.of(self.scene)

    def turned_to(self, rotation: float) -> System:
        """The same with the driven rotation at ``rotation`` [rad]; all that it does not change is shared."""
        turned = self.scene.turned
        if turned is not None and turned.angle == rotation:
            return self
        for name in UNTURNED:
            getattr(self, name)
        scene, same, drives = self.scene.turned_to(rotation), copy(self), self.drives
        target = np.where(drives.row == scene.driven_row, rotation, drives.target)
        vars(same).update(scene=scene, drives=drives._replace(target=target), _made=self._made)
        return same

    def under(self, acting: LoadTable) -> System:
        """The same scene under other loads."""
        same = System(scene=self.scene)
        vars(same).update(acting=acting, loads=acting.rows(acting.turns != FOLLOWER), _made=self._made)
        return same

    @cached_property
    def drives(self) -> DriveTable:
        """Driven coordinates."""
        return DriveTable.of(self.scene)

    @cached_property
    def loads(self) -> LoadTable:
        """Loads that grow and have a potential, one row a component."""
        return LoadTable.of(self.scene)

    @cached_property
    def acting(self) -> LoadTable:
        """All loads that grow."""
        return LoadTable.of(self.scene, followers=True) if self.scene.followers else self.loads

    @cached_property
    def followers(self) -> Followers:
        """Forces that turn with bodies, growing and steady."""
        return Followers.of(self.scene, self.acting) if self.scene.followers else NO_FOLLOWERS

    @property
    def has_potential(self) -> bool:
        """Whether the forces are a gradient: all but followers and the published ones are."""
        scene = self.scene
        measures = {*(e.measure for e in scene.of(Bending)), *(e.measure for e in scene.of(Stretching))}
        return "published" not in measures and not self.followers.place.size

    @cached_property
    def weight(self) -> Array:
        """Generalised force of gravity and steady loads (Q,) [N, N m]; empty where no effect names any."""
        return weight(self.scene)

    @cached_property
    def springs(self) -> Array:
        """Stiffness of springs over all poses (3 B, 3 B) [N/m, N, N m]; empty where there are none."""
        return between_bodies(self.scene, "stiffness")

    @cached_property
    def frames(self) -> Frames:
        """Frames that bodies carry."""
        return frames_of(self.scene)

    @property
    def prescribed(self) -> NDArray[np.int64]:
        """Rows (K,) of the drives that are no props, by their number among the constraints."""
        shared = self.scene.structure
        if "prescribed" not in shared:
            shared["prescribed"] = np.flatnonzero(self.drives.prop == 0)
        found: NDArray[np.int64] = shared["prescribed"]
        return found

    def require_dead(self, what: str, remedy: str = "`solve` or `release`, which follow it") -> None:
        """Refuse followers; the message ends with the remedy."""
        if self.followers.place.size:
            expected = f"a fixed direction (follower = false), or {remedy}"
            raise InvalidParameter(what, "a load that follows its body", expected)

    def spring_energy(self, poses: Array) -> Array:
        """Return the energy of the springs (...) at poses (..., 3 B) of all bodies [J]."""
        moved = poses - self.rest[self.layout.poses]
        force = moved @ self.springs if self.springs.size else 0.0 * moved
        return np.asarray(0.5 * (force * moved).sum(axis=-1))

    def once(self, name: str, make: Callable[[System], Any]) -> Any:
        """Return what ``make`` makes of the system, kept with it under a name."""
        if name not in self._made:
            self._made[name] = make(self)
        return self._made[name]

    @cached_property
    def _made(self) -> dict[str, Any]:
        return {}

    @cached_property
    def mass(self) -> Array:
        """M in the coordinates q (Q, Q) [kg, kg m^2]; zero where no inertia acts."""
        scene, mass = self.scene, np.zeros((self.layout.coordinate_count,) * 2)
        for strip in scene.strips:
            if scene.of(StripInertia):
                self._add(mass, strip, strip.linear_density * strip.products())
            if scene.of(SectionRotaryInertia):
                self._add(mass, strip, strip.rotary_density * strip.slope_products())
        for body in scene.own_bodies if scene.of(BodyInertia) else ():
            at = self.layout.body(body.name)
            mass[at, at] += np.diag((body.mass, body.mass, body.moment_of_inertia))
        return mass

    @cached_property
    def drag(self) -> Array:
        """D of the force - D v (Q, Q) [N s/m, N m s]; (0, 0) where no effect names any."""
        strips, bodies = self.scene.of(StripDrag), self.scene.of(BodyDamper)
        between = between_bodies(self.scene, "damping")
        if not strips and not bodies and not between.size:
            return np.zeros((0, 0))
        drag = np.zeros((self.layout.coordinate_count,) * 2)
        for effect in strips:
            for strip in self.scene.strips:
                self._add(drag, strip, effect.rate * strip.linear_density * strip.products())
        for damper in bodies:
            for body in self.scene.own_bodies:
                at = self.layout.body(body.name)
                drag[at, at] += np.diag((damper.translation, damper.translation, damper.rotation))
        if between.size:
            drag[self.layout.poses, self.layout.poses] += between
        return drag

    @property
    def relaxation_time(self) -> float:
        """Of all strips [s]."""
        return sum((damping.relaxation_time for damping in self.scene.of(StripDamping)), 0.0)

    def _add(self, matrix: Array, strip: Strip, block: Array) -> None:
        """Add a matrix of a strip's control points (n, n), the same for x and y."""
        at = self.layout.strip(strip.name)
        matrix[at, at] += np.kron(block, np.eye(2))

    @cached_property
    def is_preloaded(self) -> bool:
        """Whether weight or pre-strain act."""
        scene = self.scene
        stretching: tuple[Stretching | MixedStretching, ...] = scene.of(Stretching)
        stretching += scene.of(MixedStretching)
        strains = (*(e.natural_curvature for e in scene.of(Bending)), *(e.natural_strain for e in stretching))
        return any(strains) or bool(self.weight.any())

    @cached_property
    def rest(self) -> Array:
        """Unknowns z at rest [m, rad, N], shape (layout.size,)."""
        rest = np.zeros(self.layout.size)
        for strip in self.scene.strips:
            rest[self.layout.strip(strip.name)] = strip.control_points.ravel()
        for body in self.scene.bodies:
            rest[self.layout.body(body.name)][:2] = body.centre
        return rest


def compile_scene(scene: Scene) -> System:
    """Return the scene as a system of equations."""
    return System(scene=scene)


@dataclass(frozen=True, kw_only=True, eq=False)
class _Scales:
    """Length L of the longest strip and energy EI / L of the largest flexural rigidity of a scene.

    Scaled by ``unit / energy`` a force row is in EI/L^2, a moment row in EI/L, a
    compatibility or constraint row in L or rad: no tolerance changes its meaning with the
    size, the material or the slenderness of a design.
    """

    scene: Scene
    length: float
    energy: float

    @classmethod
    def of(cls, scene: Scene) -> Self:
        """Those of a scene; the length of a curved strip is that of its control polygon, an upper bound."""
        polygons = (strip.control_points.tolist() for strip in scene.strips)
        length = max(sum(map(math.dist, points[:-1], points[1:])) for points in polygons)
        rigidity = max((e.flexural_rigidity for e in scene.of(Bending)), default=1.0)
        return cls(scene=scene, length=length, energy=rigidity / length)

    @property
    def pose(self) -> NDArray[np.float64]:
        """The unit of a body's pose (3,)."""
        return np.array([self.length, self.length, 1.0])

    @cached_property
    def unit(self) -> NDArray[np.float64]:
        """The unit of each unknown (N,)."""
        force, moment, layout = self.energy / self.length, self.energy, self.scene.layout
        unit = np.full(layout.size, self.length)
        for start in layout.bodies.values():
            unit[start + 2] = 1.0
        for start, count in layout.modes:
            unit[start : start + count] = force
        for constraint, (row, count) in zip(self.scene.of(Constraint), layout.multipliers, strict=True):
            if isinstance(constraint, Clamp):
                unit[row : row + count] = force, force, moment
            elif isinstance(constraint, Driven):
                unit[row : row + count] = [(force, force, moment)[axis] for axis in constraint.parts]
        return unit
