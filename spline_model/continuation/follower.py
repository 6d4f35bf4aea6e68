"""A path in a parameter: predict, correct, check, halve.

It begins at rest, weight and pre-strain grown from nothing, or at a state that is given. The parameter is the
load factor, or the arc length (``spline_model.continuation.arc_length``).
"""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from spline_model.continuation.followed import Followed, Point
from spline_model.continuation.point import reached
from spline_model.continuation.watch import Watch
from spline_model.errors import InvalidParameter, Unsettled
from spline_model.newton import Newton, solve

Array = NDArray[np.float64]

KNOWN_STATES = 3
"""States that the predictor looks back on."""
SMALLEST_STEP = 2.0**-14
"""Least fraction of an increment before the path is given up."""


class Follower:
    """The state of a path while it is followed in a parameter, by default its load factor.

    at: the parameter here; known: the last states, with their parameters. ``points`` holds the states that
    were asked for, ``trail`` those on the way to the next one; ``done``: int P_lambda d(lambda) from the
    first state to each of points, and to here [J].
    """

    at = 0.0

    def __init__(self, watch: Watch, begin: Point, norms: tuple[float, ...]) -> None:
        self.work, self.watch, self.here = watch.work, watch, begin
        self.at = self._parameter(begin)
        self.known: deque[tuple[float, Point]] = deque([(self.at, begin)], maxlen=KNOWN_STATES)
        self.points, self.trail = [begin], []  # type: list[Point], list[Point]
        self.done, self.done_here = [0.0], 0.0
        self.history = [norms]

    def _parameter(self, point: Point) -> float:
        """The parameter of the path at a point that follows on here."""
        return point.load_factor

    def _correct(self, z: Array, load_factor: float) -> Newton:
        """The equilibrium near a predicted state."""
        return solve(self.work, z, load_factor)

    def _judged(self, point: Point) -> tuple[Point, str]:
        """A point that was found, with its rates in the parameter, and why it is not the next one."""
        return point, ""

    def _predict(self, aim: float) -> tuple[Array, float]:
        """The state where the parameter is ``aim``, by the last states and rates, and its load factor."""
        return hermite_extrapolation([(at, p.z, p.rate) for at, p in self._near(aim)], aim), aim

    def _near(self, aim: float) -> list[tuple[float, Point]]:
        """The states to extrapolate; further than twice their distance, the tangent only."""
        known = list(self.known)
        far = len(known) > 1 and abs(aim - self.at) > 2 * abs(self.at - known[-2][0])
        return known[-1:] if far else known

    def _try(self, aim: float) -> tuple[Newton, str]:
        """One step to ``aim``, and why it failed; else the follower stands there, or on another branch."""
        predicted, load_factor = self._predict(aim)
        found = self._correct(predicted, load_factor)
        self.history.append(found.norms)
        reason = found.reason or self.watch.refuse(self.here, predicted, found.z, found.load_factor)
        if reason:
            return found, reason
        point, reason = reached(self.work, found)
        if point is None:
            return found, reason
        point, reason = self._judged(point)
        if reason:
            return found, reason
        end, done, reason = self.watch.go(self.here, point, self._parameter(point) - self.at)
        if not reason:
            if end is not point:
                self.known.clear()
            self.at, self.here = self._parameter(end), end
            self.done_here += done
            self.known.append((self.at, end))
            self.trail.append(end)
        return found, reason

    def advance(self, target: float) -> str:
        """Go on to ``target`` and keep its state; returns why it failed, or nothing."""
        begin = self.at
        step = whole = target - begin
        if len(self.known) > 1 and whole * (begin - self.known[-2][0]) < 0:
            self.known = deque([(begin, self.here)], maxlen=KNOWN_STATES)  # the path turns back
        while self.at != target:
            at = self.at
            aim = target if abs(target - at) <= abs(step) * (1 + 1e-9) else at + step
            _, reason = self._try(aim)
            if reason:
                self.work.counters.halved_increments += 1
                step /= 2
                if abs(step) < SMALLEST_STEP * abs(whole):
                    return self._stop(at + 2 * step, reason)
            elif self.at != aim:  # on another branch, and somewhere else
                begin = self.at
                step = whole = target - begin
            elif (abs(aim - begin) / abs(step)) % 2 == 0 and abs(step) < abs(whole):
                step *= 2  # after an easy part the next may be twice as long, on the grid of halves
        self._keep()
        return ""

    def _keep(self) -> None:
        """Keep the state here as one that was asked for."""
        self.points.append(self.here)
        self.done.append(self.done_here)
        self.trail.clear()

    def _stop(self, aim: float, reason: str) -> str:
        """Keep the last state of a path that stopped, whether or not it was asked for; says why it did."""
        while self.trail and not self.watch.is_resolved(self.trail[-1]):
            self.trail.pop()
        self.points += self.trail[-1:]
        self.done += [self.done_here] * len(self.trail[-1:])
        return self.watch.stopped(self.here, aim, reason)


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


def equilibrium(work: Followed, unknowns: Array) -> Newton:
    """The equilibrium at load factor 0 that Newton finds from the scene's unknowns, if its checks pass.

    Raises InvalidParameter if they lead to no such state.
    """
    newton = solve(work, work.state(unknowns), 0.0)
    reason = newton.reason or work.refuse(newton.z) or work.unresolved(newton.z, 0.0)
    if reason:
        raise InvalidParameter("start", reason, "a state from which Newton finds an equilibrium")
    return newton


def first_point(watch: Watch, start: Array | None = None) -> tuple[Point, tuple[float, ...]]:
    """The point where a path begins, and the residual norms: rest, or the unknowns that are given.

    Raises InvalidParameter where there is none, or where nothing holds the scene.
    """
    work = watch.work
    newton = _settle(watch) if start is None else equilibrium(work, start)
    return _held(work, newton), newton.norms


def _held(work: Followed, newton: Newton) -> Point:
    """The point where Newton ended; refused where nothing holds the scene."""
    point, reason = reached(work, newton)
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
    growing = replace(watch.work, grows=True)
    own = Watch(growing, leaves=watch.leaves, by_load=True)
    newton = solve(growing, growing.state(growing.system.rest), 0.0)
    begin = _held(growing, newton)
    follower = Follower(own, begin, newton.norms)
    message = follower.advance(1.0)
    shared = (
        replace(each, load_factor=0.0, rotation=0.0 * each.rotation, preload=each.load_factor)
        for each in own.critical
    )
    watch.settled = tuple(shared)
    if message:
        raise Unsettled(message, watch.settled)
    watch.leaves, watch.before = own.leaves, own.remark()
    return follower.here.z
