"""From frozen values to the flat tables of drives, loads, followers, springs and frames."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import accumulate
from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from spline_model.effects import GROUND, AppliedLoad, Driven, Gravity, Spring
from spline_model.effects.base import Constraint
from spline_model.effects.boundary import FOLLOWER, STEADY, History
from spline_model.frames import NO_FRAMES, Frames
from spline_model.scene import Scene

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

PLACES = ("coordinate", "row", "turns", "prop")
"""Columns of whole numbers."""


class DriveTable(NamedTuple):
    """One row a driven coordinate, D in all.

    coordinate (D,) its index in z; origin (D,) its value at rest; target (D,) its change at
    factor 1; row (D,) index of its multiplier; turns (D,) 1 for a rotation; prop (D,) 1 for one; first, pairs
    (D,) its piece of times and factors (H,), the history in a motion; begin, until (D,) when it
    holds [s].
    """

    coordinate: Indices
    origin: Array
    target: Array
    row: Indices
    turns: Indices
    prop: Indices
    first: Indices
    pairs: Indices
    times: Array
    factors: Array
    begin: Array
    until: Array

    @classmethod
    def of(cls, scene: Scene) -> Self:
        """The driven rotations and displacements, one row a coordinate."""
        shared, turned = scene.structure, scene.turned
        alone = scene.of(Driven) == (turned,)
        if turned is not None and alone and not turned.steady and "drives" in shared:
            known: Self = shared["drives"]
            return known._replace(target=np.array([turned.angle]))
        rows, histories = [], []  # type: list[tuple[float, ...]], list[History]
        for i, drive in enumerate(scene.of(Constraint)):
            if not isinstance(drive, Driven):
                continue
            place, at_rest = scene.layout.bodies[drive.body], (*scene.body(drive.body).centre.tolist(), 0.0)
            grown = 0.0 if drive.steady else 1.0
            for k, (axis, part) in enumerate(drive.parts.items()):
                origin, row = at_rest[axis] + (1.0 - grown) * part, scene.layout.multipliers[i][0] + k
                kind = place + axis, origin, grown * part, row, int(axis == 2), int(drive.prop)
                rows.append((*kind, *drive.held))
                histories.append(drive.history or STEADY)
        names = ("coordinate", "origin", "target", "row", "turns", "prop", "begin", "until")
        table = cls(**_columns(names, rows), **_histories(histories))
        if alone:
            shared["drives"] = table
        return table


class LoadTable(NamedTuple):
    """One row a generalised force, F in all.

    coordinate (F,) its index in z; value (F,) at factor 1; turns (F,) 1 for a moment, 2 for a part of a
    follower; first, pairs (F,) its piece of times and factors (H,), the history in a motion.
    """

    coordinate: Indices
    value: Array
    turns: Indices
    first: Indices
    pairs: Indices
    times: Array
    factors: Array

    @classmethod
    def of(cls, scene: Scene, followers: bool = False) -> LoadTable:
        """Return dead forces and moments on bodies that grow, and ``followers``, one row a component."""
        growing = [load for load in scene.of(AppliedLoad) if not load.steady]
        if not growing:
            return NO_LOADS
        table = _table_of_loads(scene, growing)
        return table if followers else table.rows(table.turns != FOLLOWER)

    def rows(self, kept: NDArray[np.bool_]) -> LoadTable:
        """Return the rows (R,) that are ``kept``, in N and N m."""
        own = {name: getattr(self, name)[kept] for name in ("coordinate", "value", "turns", "first", "pairs")}
        return self._replace(**own)


class Followers(NamedTuple):
    """P forces [N] that turn with bodies: they have no potential, and their tangent is not symmetric.

    place (P,): of their x among the unknowns, followed by y and theta; growing, steady (P, 2): force at load
    factor 1, and at any load factor [N].
    """

    place: Indices
    growing: Array
    steady: Array

    @classmethod
    def of(cls, scene: Scene, loads: LoadTable) -> Self:
        """Return those of all loads of a scene that grow, and its steady ones, among its unknowns [N]."""
        own = loads.rows(loads.turns == FOLLOWER)
        full = [each for each in scene.of(AppliedLoad) if each.follower and each.steady]
        places = [*own.coordinate[::2], *(scene.layout.bodies[each.body] for each in full)]
        force = np.concatenate((own.value.reshape(-1, 2), np.reshape([each.force for each in full], (-1, 2))))
        grows = np.arange(len(places))[:, None] < len(own.value) // 2
        return cls(np.array(places, dtype=np.int64), force * grows, force * ~grows)

    def turned(self, z: Array, load_factor: float) -> Array:
        """Return the forces (P, 2) [N] at unknowns z (N,) and a load factor [1]."""
        (x, y), turn = (load_factor * self.growing + self.steady).T, z[self.place + 2]
        cos, sin = np.cos(turn), np.sin(turn)
        return np.stack((cos * x - sin * y, sin * x + cos * y), axis=-1)

    def subtract(self, z: Array, load_factor: float, gradient: Array, hessian: Array) -> None:
        """Subtract the forces [N] from the gradient (N,), and their derivatives from its hessian (N, N).

        z (N,): unknowns [m, rad, N]; load_factor [1].
        """
        if not self.place.size:
            return
        force, at = self.turned(z, load_factor), self.place
        for k, across in enumerate((-force[:, 1], force[:, 0])):
            np.subtract.at(gradient, at + k, force[:, k])
            np.subtract.at(hessian, (at + k, at + 2), across)

    def push(self, z: Array) -> Array:
        """Return the derivative (N,) [N] of the forces in the load factor at z (N,)."""
        found = np.zeros(len(z))
        for k, part in enumerate(self._replace(steady=0.0 * self.steady).turned(z, 1.0).T):
            np.add.at(found, self.place + k, part)
        return found

    def among(self, begin: int, force: float) -> Followers:
        """Return the same divided by ``force`` [N], among coordinates whose poses begin at ``begin``."""
        if not self.place.size:
            return self
        return Followers(self.place - begin, self.growing / force, self.steady / force)


NO_FOLLOWERS = Followers(np.zeros(0, dtype=np.int64), np.zeros((0, 2)), np.zeros((0, 2)))


def frames_of(scene: Scene) -> Frames:
    """Return the frames that bodies of a scene carry, among its unknowns [m]."""
    places, levers = [], []
    for frame in (body for body in scene.bodies if body.on is not None):
        on = None if frame.on == GROUND else scene.body(str(frame.on))
        carrier = -1 if on is None else scene.layout.bodies[on.name]
        places.append((scene.layout.bodies[frame.name], carrier, 2 if frame.turns else 3))
        levers.append(frame.centre if on is None else frame.centre - on.centre)
    return Frames(np.array(places, dtype=np.int64), np.array(levers)) if places else NO_FRAMES


def _table_of_loads(scene: Scene, growing: Sequence[AppliedLoad]) -> LoadTable:
    parts = [
        (load.history, (scene.layout.bodies[load.body] + axis, value, kind))
        for load in growing
        for axis, value, kind in load.components
    ]
    columns = _columns(("coordinate", "value", "turns"), [part for _, part in parts])
    return LoadTable(**columns, **_histories([history for history, _ in parts]))


def _columns(names: Sequence[str], rows: Sequence[tuple[float, ...]]) -> dict[str, Any]:
    """The columns of rows by their names; those of places are whole numbers."""
    columns = zip(*rows, strict=True) if rows else [()] * len(names)
    return {
        name: np.array(column, dtype=np.int64 if name in PLACES else float)
        for name, column in zip(names, columns, strict=True)
    }


def _histories(histories: Sequence[History]) -> dict[str, Any]:
    """Histories end to end: first and number of pairs of each, and all times and factors."""
    counts = [len(history) for history in histories]
    pairs = [pair for history in histories for pair in history]
    return {
        "first": np.array(list(accumulate(counts, initial=0))[:-1], dtype=np.int64),
        "pairs": np.array(counts, dtype=np.int64),
        "times": np.array([time for time, _ in pairs], dtype=float),
        "factors": np.array([factor for _, factor in pairs], dtype=float),
    }


NO_LOADS = _table_of_loads(Scene(strips=(), bodies=(), effects=()), ())


def weight(scene: Scene) -> Array:
    """Return the generalised force of gravity and steady loads, (Q,) [N, N m]; empty where no effect names
    any."""
    steady = [load for load in scene.of(AppliedLoad) if load.steady]
    dead = [(load.body, part) for load in steady for part in load.components if part[2] != FOLLOWER]
    if not (scene.of(Gravity) or dead):
        return np.zeros(0)
    force, layout = np.zeros(scene.layout.coordinate_count), scene.layout
    for gravity in scene.of(Gravity):
        for strip in scene.strips:
            share = strip.linear_density * strip.share_of_length()
            force[layout.strip(strip.name)] += np.outer(share, gravity.acceleration).ravel()
        for heavy in scene.own_bodies:
            force[layout.body(heavy.name)][:2] += heavy.mass * np.asarray(gravity.acceleration)
    for body, (axis, value, _) in dead:
        force[layout.bodies[body] + axis] += value
    return force


NO_SPRINGS = np.zeros((0, 0))


def between_bodies(scene: Scene, name: str) -> Array:
    """Return the matrix (3 B, 3 B) of the springs' "stiffness" [N/m, N m/rad] or "damping" over the poses of
    bodies.

    It is (0, 0) if no spring has any.
    """
    springs = [spring for spring in scene.of(Spring) if any(getattr(spring, name))]
    if not springs:
        return NO_SPRINGS
    matrix, begin = np.zeros((3 * len(scene.bodies), 3 * len(scene.bodies))), scene.layout.poses.start
    for spring in springs:
        ends = [scene.layout.body(each) for each in (spring.body, spring.other) if each is not None]
        block = np.diag(getattr(spring, name))
        for i, one in enumerate(ends):
            for j, another in enumerate(ends):
                rows, columns = (slice(at.start - begin, at.stop - begin) for at in (one, another))
                matrix[rows, columns] += block if i == j else -block
    return matrix
