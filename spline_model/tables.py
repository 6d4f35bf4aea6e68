"""From frozen values to the flat tables that the paper's bordered form and the motions walk."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import accumulate
from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from spline_model.effects import (
    GROUND,
    BodyGravity,
    Clamp,
    Driven,
    Spring,
    StripGravity,
)
from spline_model.effects.base import Constraint
from spline_model.effects.boundary import STEADY, History, Sized
from spline_model.frames import NO_FRAMES, Frames
from spline_model.scene import Scene

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

END, INNER, BODY, ROW = range(4)
"""Columns of ``ClampTable.place``."""
SIGN, ACROSS, ALONG, DIRECTION = range(4)
"""Columns of ``ClampTable.numbers``."""
PLACES = ("coordinate", "row", "turns", "prop")
"""Columns of whole numbers of the other two tables."""


class ClampTable(NamedTuple):
    """One row a clamp, C in all.

    place (C, 4): indices in z of x of the end's control point, of its neighbour and of the body, -1 for the
    ground, and of the first of its three multipliers. numbers (C, 4): sign, +1 at the start of a strip and -1
    at its end, so that sign * (inner - end) points along C'; clamped point from the body's centre [m];
    angle of m at rest [rad].
    """

    place: Indices
    numbers: Array

    @classmethod
    def of(cls, scene: Scene) -> Self:
        """The clamped strip ends of a scene."""
        places, numbers = [], []
        for i, clamp in enumerate(scene.of(Constraint)):
            if not isinstance(clamp, Clamp):
                continue
            strip = scene.strip(clamp.strip)
            start, count = scene.layout.strips[clamp.strip]
            at_start = clamp.end == "start"
            end, inner = (0, 1) if at_start else (count - 1, count - 2)
            sign = 1.0 if at_start else -1.0
            along = sign * (strip.control_points[inner] - strip.control_points[end])
            centre = np.zeros(2) if clamp.to == GROUND else scene.body(clamp.to).centre
            body = -1 if clamp.to == GROUND else scene.layout.bodies[clamp.to]
            places.append((start + 2 * end, start + 2 * inner, body, scene.layout.multipliers[i][0]))
            point = strip.control_points[end] - centre
            numbers.append((sign, *point, np.arctan2(along[1], along[0])))
        return cls(
            place=np.array(places, dtype=np.int64).reshape(-1, 4),
            numbers=np.array(numbers, dtype=float).reshape(-1, 4),
        )


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
        growing = [load for load in scene.of(Sized) if not load.steady]
        if not followers:
            growing = [load for load in growing if not getattr(load, "follower", False)]
        return _table_of_loads(scene, growing) if growing else NO_LOADS

    def rows(self, kept: NDArray[np.bool_]) -> LoadTable:
        """Return the rows (R,) that are ``kept``, in N and N m."""
        own = {name: getattr(self, name)[kept] for name in ("coordinate", "value", "turns", "first", "pairs")}
        return self._replace(**own)


def frames_of(scene: Scene) -> Frames:
    """Return the frames that bodies of a scene carry, among its unknowns [m]."""
    places, levers = [], []
    for frame in (body for body in scene.bodies if body.on is not None):
        on = None if frame.on == GROUND else scene.body(str(frame.on))
        carrier = -1 if on is None else scene.layout.bodies[on.name]
        places.append((scene.layout.bodies[frame.name], carrier, 2 if frame.turns else 3))
        levers.append(frame.centre if on is None else frame.centre - on.centre)
    return Frames(np.array(places, dtype=np.int64), np.array(levers)) if places else NO_FRAMES


def _table_of_loads(scene: Scene, growing: Sequence[Sized]) -> LoadTable:
    parts = [(load.history, part) for load in growing for part in load.components(scene.layout)]
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
    strips, bodies = scene.of(StripGravity), scene.of(BodyGravity)
    steady = [load for load in scene.of(Sized) if load.steady and not getattr(load, "follower", False)]
    if not (strips or bodies or steady):
        return np.zeros(0)
    force = np.zeros(scene.layout.coordinate_count)
    for strip in strips:
        share = strip.linear_density * scene.strip(strip.strip).share_of_length()
        force[scene.layout.strip(strip.strip)] += np.outer(share, strip.acceleration).ravel()
    for body in bodies:
        force[scene.layout.body(body.body)][:2] += body.mass * np.asarray(body.acceleration)
    for load in steady:
        for place, value, _ in load.components(scene.layout):
            force[place] += value
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
