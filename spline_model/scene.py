"""A scene: strips, bodies and the effects that act on them, and their places among its unknowns."""

from __future__ import annotations

from collections.abc import Callable
from copy import copy
from dataclasses import dataclass, replace
from functools import cached_property, wraps
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from spline_model.basis import Bezier
from spline_model.effects import GROUND, AppliedLoad, Clamp, Driven, DrivenRotation, Gravity, MixedStretching
from spline_model.effects.base import Constraint, Dissipation, Inertia, Load, Potential
from spline_model.effects.elastic import Taper
from spline_model.errors import InvalidParameter

AXES = ("x", "y", "rotation")
"""What the coordinates of a body are called."""
Effect = Potential | Inertia | Dissipation | Load | Constraint
Kind = TypeVar("Kind", bound=Effect)
T = TypeVar("T")


def _structural(make: Callable[[Any], T]) -> cached_property[T]:
    """Return a property that is made once for all scenes of one structure (``Scene.structure``)."""
    name = make.__name__

    @wraps(make)
    def made(own: Scene) -> T:
        if name not in own.structure:
            own.structure[name] = make(own)
        return own.structure[name]  # type: ignore[no-any-return]

    return cached_property(made)


@dataclass(frozen=True, kw_only=True, eq=False)
class Strip:
    """A flexure or a piece of one: a curve C(u) of control points, given at rest.

    control_points: (n, 2) positions at rest [m]; of: name of the flexure that it is a piece of, if it is one;
    taper: of its section, None for a constant one; linear_density rho A [kg/m], rotary_density rho I [kg m],
    those at the start of a taper.
    """

    name: str
    basis: Bezier
    control_points: NDArray[np.float64]
    of: str | None = None
    taper: Taper | None = None
    linear_density: float = 0.0
    rotary_density: float = 0.0

    def gauss_points(self, of: str = "area") -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return points u (P,) and weights p ds0 (P,) [m], exact for products of two basis functions.

        p: "area" or "second_moment" of the section over that at the start, 1 of a constant one.
        """
        u, weight = self.basis.gauss_rule(self.basis.degree + (1 if self.taper is None else 2))
        length = weight * np.hypot(*(self.basis.evaluate(u, 1) @ self.control_points).T)
        return u, length if self.taper is None else length * getattr(self.taper, of)(u)

    def share_of_length(self) -> NDArray[np.float64]:
        """Return int N p ds0 of each basis function with the area as p, shape (n,) [m]."""
        u, length = self.gauss_points()
        return np.asarray(length @ self.basis.evaluate(u))

    def products(self) -> NDArray[np.float64]:
        """Return int N^T N p ds0 (n, n) with the area as p [m]."""
        u, length = self.gauss_points()
        values = self.basis.evaluate(u)
        return np.asarray(values.T @ (length[:, None] * values))

    def slope_products(self) -> NDArray[np.float64]:
        """Return int (dN/ds0)^T (dN/ds0) p ds0 (n, n) with the second moment as p [1/m]."""
        u, length = self.gauss_points("second_moment")
        slopes = self.basis.evaluate(u, 1)
        speed = np.hypot(*(slopes @ self.control_points).T)
        return np.asarray(slopes.T @ ((length / speed**2)[:, None] * slopes))

    def length_to(self, stations: NDArray[np.float64], taper: Taper | None = None) -> NDArray[np.float64]:
        """Return the arc length at rest from the start to ``stations`` (P,), u in [0, 1], shape (P,) [m].

        taper: where it is given, the length is weighed by the area over that at the start.
        """
        u, weight = self.basis.gauss_rule(self.basis.degree + 1)
        inner = np.asarray(stations)[:, None] * u
        tangent = self.basis.evaluate(inner.ravel(), 1) @ self.control_points
        speed = np.hypot(*tangent.T).reshape(inner.shape)
        return np.asarray(stations * ((speed if taper is None else speed * taper.area(inner)) @ weight))


@dataclass(frozen=True, kw_only=True, eq=False)
class Body:
    """A rigid body, given by its centre at rest (2,) [m]; its rotation at rest is zero.

    mass [kg], moment_of_inertia [kg m^2].
    joint: whether it is a frame without mass, between two pieces of a strip or at its end, or where a load
    acts, behind all bodies; on: what carries its centre, if it is not free, and whether it then turns freely.
    """

    name: str
    centre: NDArray[np.float64]
    joint: bool = False
    on: str | None = None
    turns: bool = True
    mass: float = 0.0
    moment_of_inertia: float = 0.0


@dataclass(frozen=True, kw_only=True)
class Layout:
    """Slices of the unknowns z = (q, a, lambda).

    q holds the control points of the strips (x0, y0, x1, y1, ...) and then x, y, theta
    of each body (the generalised coordinates of Eq 4); a the axial-force modes of the
    mixed strips; lambda the multipliers in the order of the scene's constraints.

    Attributes
    ----------
    strips : start of each strip's control points, and their number, by name.
    bodies : start of each body's three coordinates, by name.
    modes : start and number of axial-force modes of each MixedStretching effect, in scene order.
    multipliers : start and number of rows of each constraint, in scene order.
    """

    strips: dict[str, tuple[int, int]]
    bodies: dict[str, int]
    modes: tuple[tuple[int, int], ...]
    multipliers: tuple[tuple[int, int], ...]
    coordinate_count: int
    size: int

    @property
    def multiplier_start(self) -> int:
        """First multiplier, behind the coordinates and the axial forces."""
        return self.coordinate_count + sum(count for _, count in self.modes)

    def strip(self, name: str) -> slice:
        """Return the slice of a strip's control points, 2 n entries [m]."""
        start, count = self.strips[name]
        return slice(start, start + 2 * count)

    def body(self, name: str) -> slice:
        """Return the slice of a body's x, y, theta [m, m, rad]."""
        start = self.bodies[name]
        return slice(start, start + 3)

    def coordinate_of(self, place: int) -> tuple[str, int]:
        """The body that a place in q belongs to, and which of its coordinates."""
        return next((name, place - at) for name, at in self.bodies.items() if 0 <= place - at < 3)

    @property
    def poses(self) -> slice:
        """Slice of x, y, theta of all bodies."""
        return slice(self.coordinate_count - 3 * len(self.bodies), self.coordinate_count)

    def axial_modes(self, effect: int) -> slice:
        """Return the slice of the axial-force modes [N] of a MixedStretching effect."""
        start, count = self.modes[effect]
        return slice(start, start + count)

    def rows(self, constraint: int) -> slice:
        """Return the slice of a constraint's multipliers [N, N m]."""
        start, count = self.multipliers[constraint]
        return slice(start, start + count)


@dataclass(frozen=True, kw_only=True, eq=False)
class Scene:
    """Strips, bodies and a tuple of effects; what no effect names does not exist in it."""

    strips: tuple[Strip, ...]
    bodies: tuple[Body, ...]
    effects: tuple[Effect, ...]

    def __post_init__(self) -> None:
        names = [strip.name for strip in self.strips] + [body.name for body in self.bodies]
        if len(set(names)) != len(names) or GROUND in names:
            raise InvalidParameter("names", names, f"different names, none of them {GROUND!r}")
        strips, bodies = names[: len(self.strips)], names[len(self.strips) :]
        driven: list[tuple[str, int]] = []
        for effect in self.effects:
            strip, body = getattr(effect, "strip", None), getattr(effect, "body", None)
            if strip is not None and strip not in strips:
                raise InvalidParameter("strip", strip, f"one of {strips}")
            if body is None:
                continue
            for name in (body, getattr(effect, "other", None)):
                if name is not None and name not in bodies:
                    raise InvalidParameter("body", name, f"one of {bodies}")
            if isinstance(effect, Driven):
                driven += [(body, axis) for axis in effect.parts]
        if len(set(driven)) < len(driven):
            body, axis = next(each for each in driven if driven.count(each) > 1)
            expected = "one drive, support or rotation of the path for each coordinate of a body"
            raise InvalidParameter(f"{AXES[axis]} of {body}", "two", expected)

    @cached_property
    def structure(self) -> dict[Any, Any]:
        """What does not go by the numbers of a scene, by name: it is that of all scenes which share it."""
        return {}

    def sharing(self, structure: dict[Any, Any]) -> Scene:
        """The scene itself, with that structure: of scenes that differ in numbers only."""
        vars(self).update(structure=structure)
        return self

    def with_effects(self, *more: Effect) -> Scene:
        """The scene with some effects more."""
        return replace(self, effects=(*self.effects, *more))

    def strip(self, name: str) -> Strip:
        """The strip of that name."""
        return next(strip for strip in self.strips if strip.name == name)

    def body(self, name: str) -> Body:
        """The body of that name."""
        return next(body for body in self.bodies if body.name == name)

    @cached_property
    def whole(self) -> dict[str, tuple[Strip, ...]]:
        """The pieces of each flexure, root first, by its name."""
        found: dict[str, tuple[Strip, ...]] = {}
        for strip in self.strips:
            name = strip.of or strip.name
            found[name] = (*found.get(name, ()), strip)
        return found

    @property
    def own_bodies(self) -> tuple[Body, ...]:
        """The bodies of the design, without joints."""
        return tuple(body for body in self.bodies if not body.joint)

    def of(self, kind: type[Kind]) -> tuple[Kind, ...]:
        """The scene's effects of this class, in scene order; sorted out once."""
        found = self._sorted.get(kind)
        if found is None:
            places = self.structure.get(kind)
            if places is None:
                places = [i for i, effect in enumerate(self.effects) if isinstance(effect, kind)]
                self.structure[kind] = places
            found = self._sorted[kind] = tuple([self.effects[i] for i in places])
        return found

    @cached_property
    def _sorted(self) -> dict[type, tuple[Any, ...]]:
        return {}

    def weight_of(self, strip: str) -> NDArray[np.float64]:
        """Return the weight of a strip per du: its parts (3, 2) with 1, u and u^2, as the area [N]."""
        total = np.zeros((3, 2))
        for gravity in self.of(Gravity):
            own = self.strip(strip)
            mass = own.linear_density * own.length_to(np.ones(1))
            parts = (1.0, 0.0, 0.0) if own.taper is None else own.taper.powers
            total += np.outer(parts, mass * gravity.acceleration)
        return total

    @property
    def followers(self) -> bool:
        """Whether a load turns with its body."""
        return any(load.follower for load in self.of(AppliedLoad))

    @property
    def turned(self) -> DrivenRotation | None:
        """The rotation that a path drives, if there is one."""
        for each in self.of(DrivenRotation):
            if not (each.prop or each.beside):
                return each
        return None

    def turned_to(self, angle: float) -> Scene:
        """The scene with another angle [rad] of its driven rotation, on which nothing else depends."""
        turned, same = self.turned, copy(self)
        assert turned is not None, "there is a driven rotation"
        aimed = tuple(replace(turned, angle=angle) if each is turned else each for each in self.effects)
        vars(same).update(effects=aimed, _sorted={})
        return same

    @_structural
    def driven_row(self) -> int | None:
        """Index in z of the driven rotation's torque, if there is one."""
        turned = self.turned
        held = zip(self.of(Constraint), self.layout.multipliers, strict=True)
        return next((row for each, (row, _) in held if each is turned), None)

    @_structural
    def free_ends(self) -> tuple[str, ...]:
        """The strips whose tips are free, with a frame or without one."""
        held = {each.strip for each in self.of(Clamp) if each.end == "end" and not each.free}
        return tuple(strip.name for strip in self.strips if strip.name not in held)

    @_structural
    def clamps(self) -> dict[tuple[str, str], slice]:
        """Rows of the clamps by strip and end, "start" or "end"."""
        held = enumerate(self.of(Constraint))
        return {(c.strip, c.end): self.layout.rows(i) for i, c in held if isinstance(c, Clamp)}

    @_structural
    def layout(self) -> Layout:
        """The unknowns counted off: control points, bodies, axial forces, multipliers."""
        at, strips, bodies, modes, rows = 0, {}, {}, [], []
        for strip in self.strips:
            strips[strip.name] = (at, strip.basis.control_points)
            at += 2 * strip.basis.control_points
        for body in self.bodies:
            bodies[body.name] = at
            at += 3
        coordinates = at
        for effect in self.of(MixedStretching):
            modes.append((at, effect.modes.count))
            at += effect.modes.count
        for constraint in self.of(Constraint):
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
