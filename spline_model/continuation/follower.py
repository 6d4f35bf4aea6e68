"""A path in its load factor.

It begins at rest, weight and pre-strain grown from nothing, or at a state that is given, and goes on:
predict, correct, check, halve.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from spline_model.continuation.followed import Followed
from spline_model.continuation.point import Point, reached
from spline_model.continuation.watch import Place, Watch
from spline_model.errors import InvalidParameter
from spline_model.newton import Newton, solve

Array = NDArray[np.float64]

KNOWN_STATES = 3
"""States that the predictor looks back on."""
SMALLEST_STEP = 2.0**-14
"""Least fraction of an increment before the path is given up."""


class Follower:
    """The state of a path while it is followed.

    ``points`` holds the states that were asked for, ``trail`` those on the way to the next one;
    ``done``: int P_lambda d(lambda) from the first state to each of points, and to here [J].
    """

    def __init__(self, watch: Watch, begin: Point, norms: tuple[float, ...]) -> None:
        self.work, self.watch, self.here = watch.work, watch, begin
        self.known: deque[Point] = deque([begin], maxlen=KNOWN_STATES)
        self.points, self.trail = [begin], []  # type: list[Point], list[Point]
        self.done, self.done_here = [0.0], 0.0
        self.history = [norms]

    def advance(self, target: float) -> str:
        """Go on to ``target`` and keep its state; returns why it failed, or nothing."""
        begin = self.here.load_factor
        step = whole = target - begin
        if len(self.known) > 1 and whole * (begin - self.known[-2].load_factor) < 0:
            self.known = deque([self.here], maxlen=KNOWN_STATES)  # the path turns back
        while self.here.load_factor != target:
            at = self.here.load_factor
            aim = target if abs(target - at) <= abs(step) * (1 + 1e-9) else at + step
            newton, reason = self._try(aim)
            self.history.append(newton.norms)
            if reason:
                self.work.counters.halved_increments += 1
                step /= 2
                if abs(step) < SMALLEST_STEP * abs(whole):
                    return self._stop(at + 2 * step, reason)
            elif self.here.load_factor != aim:  # on another branch, and somewhere else
                begin = self.here.load_factor
                step = whole = target - begin
            elif (abs(aim - begin) / abs(step)) % 2 == 0 and abs(step) < abs(whole):
                step *= 2  # after an easy part the next may be twice as long, on the grid of halves
        self.points.append(self.here)
        self.done.append(self.done_here)
        self.trail.clear()
        return ""

    def _stop(self, aim: float, reason: str) -> str:
        """Keep the last state of a path that stopped, whether or not it was asked for; says why it did."""
        while self.trail and not self.watch.is_resolved(self.trail[-1]):
            self.trail.pop()
        self.points += self.trail[-1:]
        self.done += [self.done_here] * len(self.trail[-1:])
        return self.watch.stopped(self.here, aim, reason)

    def _try(self, load_factor: float) -> tuple[Newton, str]:
        """One step to ``load_factor``; on success the follower stands there, or on another branch."""
        predicted = self._predict(load_factor)
        newton = solve(self.work, predicted, load_factor)
        reason = newton.reason or self.watch.refuse(self.here, predicted, newton.z, load_factor)
        if reason:
            return newton, reason
        point, reason = reached(self.work, newton, load_factor)
        if point is None:
            return newton, reason
        end, done, reason = self.watch.go(self.here, point, load_factor - self.here.load_factor)
        if not reason:
            if end is not point:
                self.known.clear()
            self.done_here += done
            self.here = end
            self.known.append(end)
            self.trail.append(end)
        return newton, reason

    def _predict(self, load_factor: float) -> Array:
        """Extrapolate the last states and rates; further than twice their distance, the tangent only."""
        known = list(self.known)
        at = self.here.load_factor
        if len(known) > 1 and abs(load_factor - at) > 2 * abs(at - known[-2].load_factor):
            known = known[-1:]
        return hermite_extrapolation([(p.load_factor, p.z, p.rate) for p in known], load_factor)


def hermite_extrapolation(known: Sequence[tuple[float, Array, Array]], at: float) -> Array:
    """The polynomial through (place, value, slope) triples, evaluated at a place, values (N,).

    Newton's divided differences with every node doubled: degree 2 k - 1 for k triples. Three
    of them halve the Newton iterations of a smooth path against two.
    """
    nodes = [place for place, _, _ in known for _ in range(2)]
    table = [value for _, value, _ in known for _ in range(2)]
    result, weight = table[0], 1.0
    for order in range(1, len(nodes)):
        weight = weight * (at - nodes[order - 1])
        table = [
            known[i // 2][2]
            if nodes[i + order] == nodes[i]
            else (table[i + 1] - table[i]) / (nodes[i + order] - nodes[i])
            for i in range(len(nodes) - order)
        ]
        result = result + weight * table[0]
    return np.asarray(result)


def equilibrium(work: Followed, load_factor: float, unknowns: Array) -> Newton:
    """The equilibrium that Newton finds from the scene's unknowns, if an accepted state's checks pass.

    Raises InvalidParameter if these have another size, are not finite, or lead to no such state.
    """
    size = work.system.layout.size
    if np.shape(unknowns) != (size,) or not np.isfinite(unknowns).all():
        raise InvalidParameter("start", np.shape(unknowns), f"finite unknowns of shape ({size},)")
    newton = solve(work, work.state(np.asarray(unknowns, dtype=float)), load_factor)
    reason = newton.reason or work.refuse(newton.z) or work.unresolved(newton.z, load_factor)
    if reason:
        raise InvalidParameter("start", reason, "a state from which Newton finds an equilibrium")
    return newton


def first_point(watch: Watch, start: tuple[float, Array] | None) -> tuple[Point, tuple[float, ...]]:
    """The point where a path begins, and the residual norms: rest, or load factor and unknowns given.

    Raises InvalidParameter where there is none, or where nothing holds the scene.
    """
    work = watch.work
    newton = _settle(watch) if start is None else equilibrium(work, *start)
    return _held(work, newton, 0.0 if start is None else start[0]), newton.norms


def _held(work: Followed, newton: Newton, load_factor: float) -> Point:
    """The point where Newton ended; refused where nothing holds the scene."""
    point, reason = reached(work, newton, load_factor)
    if point is None:
        raise InvalidParameter("scene", reason, "strips that can move, but not freely")
    return point


def _settle(watch: Watch) -> Newton:
    """Equilibrium at load factor 0: weight and pre-strain grow from nothing, watched like any path.

    Raises InvalidParameter where they cannot grow to their full size.
    """
    work = watch.work
    z = _grown(watch) if work.system.is_preloaded else work.state(work.system.rest)
    newton = solve(work, z, 0.0)
    if newton.reason:
        raise InvalidParameter("scene", newton.reason, "an equilibrium at load factor 0, near rest")
    return newton


def _grown(watch: Watch) -> Array:
    """The unknowns (N,) under full weight and pre-strain; what was met on the way is told to ``watch``."""
    growing = watch.work.growing()
    own = Watch(growing, leaves=watch.leaves, by_load=True, place=Place(system=None))
    newton = solve(growing, growing.state(growing.system.rest), 0.0)
    begin = _held(growing, newton, 0.0)
    follower = Follower(own, begin, newton.norms)
    own.first = (0.0, begin.z)
    message = follower.advance(1.0)
    if message:
        raise InvalidParameter("scene", message, "an equilibrium under all of its weight and pre-strain")
    watch.leaves, watch.before = own.leaves, own.remark()
    return follower.here.z
