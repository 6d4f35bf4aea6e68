"""A path in its load factor or its arc length: predict, correct, check, halve.

Source of the arc length: Riks, J Appl Mech 39 (1972) 1060, with Newton on planes normal to the tangent.
"""

from __future__ import annotations

import math
from collections import deque

import numpy as np
from numpy.typing import NDArray

from spline_model.continuation.followed import Point
from spline_model.continuation.points import BIFURCATION, corrected, directed, hermite, reached
from spline_model.continuation.watch import Watch, place
from spline_model.newton import Newton, correct, solve
from spline_model.solution import CriticalPoint

Array = NDArray[np.float64]

KNOWN_STATES = 3
"""States that the predictor looks back on."""
SMALLEST_STEP = 2.0**-14
"""Least fraction of an increment, or of the first step of an arc length, before the path is given up."""
LARGEST_STEP = 0.25
"""Longest step of an arc length, in lengths of a strip, rad and load factor together."""
SHARPEST_TURN = 0.5
"""Least cosine between the tangents at both ends of a step: sharper, and forward is in doubt."""
EASY, HARD = 4, 7
"""Newton iterations up to which the next step of an arc length is longer, and from which it is shorter."""
BEYOND = 24
"""Steps in the arc length that look for what lies beyond a path's last state."""
AROUND = 2.0**-10
"""Part of the way to the next state after which the load factor is a path's parameter again."""


class Follower:
    """The state of a path while it is followed in a parameter, by default its load factor.

    at: the parameter here; known: the last states, with their parameters. ``points`` holds the states that
    were asked for; ``done``: int P_lambda d(lambda) from the first state to each of points, and to here [J].
    """

    at = 0.0

    def __init__(self, watch: Watch, begin: Point, norms: tuple[float, ...]) -> None:
        self.work, self.watch, self.here = watch.work, watch, begin
        self.at = self._parameter(begin)
        self.known: deque[tuple[float, Point]] = deque([(self.at, begin)], maxlen=KNOWN_STATES)
        self.points, self.done, self.done_here = [begin], [0.0], 0.0
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
        return hermite([(at, p.z, p.rate) for at, p in self._near(aim)], aim), aim

    def _near(self, aim: float) -> list[tuple[float, Point]]:
        """The states to extrapolate; further than twice their distance, the tangent only."""
        known = list(self.known)
        far = len(known) > 1 and abs(aim - self.at) > 2 * abs(self.at - known[-2][0])
        return known[-1:] if far else known

    def try_to(self, aim: float) -> tuple[Newton, str]:
        """Make one step to the load factor or arc length ``aim`` [1].

        Returns the last iteration and why it failed; else the follower stands there, or on another branch.
        """
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
        step = self._parameter(point) - self.at
        end, done, reason = self.watch.go(self.here, point, step)
        if not reason:
            if end is not point:
                self.known.clear()
            self.done_here += done
            self.at, self.here = self._parameter(end), end
            self.known.append((self.at, end))
        return found, reason

    def advance(self, target: float) -> str:
        """Go on to the load factor or arc length ``target`` [1] and keep its state.

        Returns why it failed, or nothing.
        """
        begin, whole, parts, done = self.at, target - self.at, 1, 0
        if len(self.known) > 1 and whole * (begin - self.known[-2][0]) < 0:
            self.known = deque([(begin, self.here)], maxlen=KNOWN_STATES)  # the path turns back
        while self.at != target:
            aim = target if done + 1 == parts else begin + whole * ((done + 1) / parts)
            _, reason = self.try_to(aim)
            if not reason and self.at == aim:
                done += 1
                if done % 2 == 0:  # after an easy part the next may be twice as long, on the grid of halves
                    parts, done = parts // 2, done // 2
                continue
            if reason:
                self.work.counters.halved_increments += 1
                parts, done = 2 * parts, 2 * done
                if parts * SMALLEST_STEP <= 1.0:
                    continue
                if told := self._turn(target, aim, reason):
                    return told
            begin, whole, parts, done = self.at, target - self.at, 1, 0  # somewhere else
        self._keep()
        return ""

    def _keep(self) -> None:
        """Keep the state here as one that was asked for."""
        self.points.append(self.here)
        self.done.append(self.done_here)

    def _turn(self, target: float, aim: float, reason: str) -> str:
        """Go on in the arc length where the path turns too sharply for steps of its load factor, as that of a
        strip with a small imperfection does at its Euler load; returns why the path stops, or nothing.

        A limit point that lies ahead is kept as a critical point.
        """
        limit, onward = _beyond(self.watch, self.here, aim, target)
        if onward is not None:
            self.here, self.at = onward.here, onward.here.load_factor
            self.done_here += onward.done_here
            self.known = deque([(self.at, self.here)], maxlen=KNOWN_STATES)
            return ""
        if self.here is not self.points[-1]:
            self._keep()
        if limit is not None:
            self.watch.critical.append(limit)
            reason = f"it buckles, a {limit.kind}: the stiffness vanishes there ({reason})"
        return f"stopped between {place(self.work, aim, last=self.here.load_factor)}: {reason}"


class ArcFollower(Follower):
    """The same in the arc length towards a load factor ``end``, in steps that follow the ease of the path.

    All its states are asked for. step: the next one; the first one changes the load factor by ``change``.
    """

    def __init__(
        self, watch: Watch, begin: Point, norms: tuple[float, ...], end: float, change: float
    ) -> None:
        onward, self.end = math.copysign(1.0, end - begin.load_factor), end
        across = onward * begin.rate / watch.work.unit
        super().__init__(watch, directed(watch.work, begin, across, onward), norms)
        self.step = self.first = change / abs(self.here.slope)

    def go_on(self) -> str:
        """Make one step, in halves where it has to be; return why it failed, or nothing."""
        while True:
            found, reason = self.try_to(self.at + self.step)
            if not reason:
                break
            self.work.counters.halved_increments += 1
            self.step /= 2
            if self.step < SMALLEST_STEP * self.first:
                return f"stopped at load factor {self.here.load_factor:.6g}: {reason}"
        self._keep()
        self.work.counters.increments += 1
        iterations = len(found.norms) - 1
        if iterations <= EASY:
            self.step = min(1.5 * self.step, max(LARGEST_STEP, self.first))
        elif iterations >= HARD:
            self.step *= 0.7
        return ""

    def _parameter(self, point: Point) -> float:
        """The arc length from the path's begin to a point that follows on here."""
        moved = ((point.z - self.here.z) / self.work.unit)[: self.work.count]
        step = np.hypot(np.linalg.norm(moved), point.load_factor - self.here.load_factor)
        return float(self.at + step)

    def _predict(self, aim: float) -> tuple[Array, float]:
        """The state where the arc length is ``aim``, or at the end of the path where that is beyond it."""
        z, here = super()._predict(aim)[0], self.here
        load_factor = hermite([(at, p.load_factor, p.slope) for at, p in self._near(aim)], aim)
        if (self.end - here.load_factor) * (self.end - load_factor) <= 0.0:
            share = (self.end - here.load_factor) / (load_factor - here.load_factor)
            return here.z + share * (z - here.z), self.end
        return z, load_factor

    def _correct(self, z: Array, load_factor: float) -> Newton:
        """The equilibrium on the plane across the path through a predicted state, or at the path's end."""
        normal, along = self._across()
        if load_factor == self.end:
            normal, along = np.zeros_like(z), 1.0
        return correct(self.work, z, load_factor, normal, along)

    def _judged(self, point: Point) -> tuple[Point, str]:
        """The point with the arc length as parameter, before the end and no sharp turn away."""
        normal, along = self._across()
        point = directed(self.work, point, normal, along)
        if (self.end - self.here.load_factor) * (self.end - point.load_factor) < 0.0:
            return point, "the step goes beyond the end"
        ahead = normal @ ((point.z - self.here.z) / self.work.unit)
        ahead += along * (point.load_factor - self.here.load_factor)
        turned = normal @ (point.rate / self.work.unit) + along * point.slope
        # a prediction that fails may lie behind, and so does the state on its plane
        if min(turned, ahead / (self._parameter(point) - self.at)) < SHARPEST_TURN:
            return point, "the path turns sharply"
        return point, ""

    def _across(self) -> tuple[Array, float]:
        """The tangent here, in dimensionless coordinates, and its load-factor part."""
        normal = self.here.rate / self.work.unit
        normal[self.work.count :] = 0.0
        return normal, self.here.slope


def _beyond(
    watch: Watch, here: Point, aim: float, target: float
) -> tuple[CriticalPoint | None, ArcFollower | None]:
    """Follow a path in its arc length from a state whose next step, to ``aim``, failed.

    Returns the limit point that the path goes over, if it does; or the follower, at a state with the load
    factor as its parameter, if it comes a part of the way to the load factor ``target``.
    """
    onward, beyond = aim - here.load_factor, Watch(watch.work, leaves=False, by_load=False)
    follower = ArcFollower(beyond, here, (), math.copysign(math.inf, onward), 2.0 * abs(onward))
    for _ in range(BEYOND):
        _, reason = follower.try_to(follower.at + follower.step)
        if beyond.critical:
            return next((each for each in beyond.critical if each.kind != BIFURCATION), None), None
        way = (follower.here.load_factor - here.load_factor) / (target - here.load_factor)
        if AROUND <= way <= 1.0:
            z = follower.here.z
            point = corrected(watch.work, z, follower.here.load_factor, np.zeros_like(z), 1.0)
            if point is None:
                return None, None
            follower.here = point
            return None, follower
        follower.step *= 0.25 if reason else 2.0
    return None, None
