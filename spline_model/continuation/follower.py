"""Going on along a path in its load factor: predict, correct, check, halve."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from spline_model.continuation.point import Point, done_by_load_factor, stand
from spline_model.continuation.watch import Watch
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
        try:
            point = stand(self.work, newton.z, load_factor, newton.energies)
        except np.linalg.LinAlgError as error:
            return newton, str(error)
        step = load_factor - self.here.load_factor
        reached, reason = self.watch.go(self.here, point, step)
        if not reason:
            if reached is point:
                self.done_here += done_by_load_factor(self.here, point, step)
            else:  # across a kink the work is the potential gained
                self.known.clear()
                self.done_here += reached.potential - self.here.potential
            self.here = reached
            self.known.append(reached)
            self.trail.append(reached)
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
