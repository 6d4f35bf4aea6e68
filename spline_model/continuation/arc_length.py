"""Following an equilibrium path in its arc length, through limit points of the load factor."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import System
from spline_model.continuation.followed import Corrected, Followed, correct
from spline_model.continuation.follower import KNOWN_STATES, first_point, hermite_extrapolation
from spline_model.continuation.point import Point, directed, reached
from spline_model.continuation.watch import BRANCHES, Watch
from spline_model.errors import require_choice
from spline_model.reduced.elements import followed
from spline_model.solution import Path

Array = NDArray[np.float64]

LARGEST_STEP = 0.25
"""Longest step, in lengths of a strip, rad and load factor together."""
SMALLEST_STEP = 2.0**-14
"""Shortest step over the first one before the path is given up."""
SHARPEST_TURN = 0.5
"""Least cosine between the tangents at both ends of a step: sharper, and forward is in doubt."""
EASY, HARD = 4, 7
"""Newton iterations up to which the next step is longer, and from which it is shorter."""
MOST_STEPS = 2000


def follow_arc(
    system: System,
    end: float = 1.0,
    *,
    increments: int = 20,
    start: tuple[float, Array] | None = None,
    branch: str = "primary",
    progress: Callable[[int, int], None] | None = None,
    method: str = "condensed",
) -> Path:
    """The path from rest, or from load factor and unknowns ``start``, until its load factor is ``end``.

    The first step changes the load factor by 1 / increments of the way; later ones follow
    the ease of the path. Every accepted state is in the result. The load factor may go down
    and up again; ``end`` is where it is first reached. branch and method as in ``spline_model.path.follow``.
    Source: Riks, J Appl Mech 39 (1972) 1060, with Newton on planes normal to the tangent.
    """
    require_choice("branch", branch, BRANCHES)
    follower = _ArcFollower(followed(system, method), start, end, increments, branch)
    message = ""
    for taken in range(MOST_STEPS):
        if follower.here.load_factor == end or message:
            break
        message = follower.advance()
        if progress is not None:
            progress(taken + 1, MOST_STEPS)
    else:
        message = f"load factor {end:g} is not reached in {MOST_STEPS} steps"
    return follower.path(message)


class _ArcFollower:
    """The state of a path while it is followed."""

    def __init__(
        self, work: Followed, start: tuple[float, Array] | None, end: float, increments: int, branch: str
    ) -> None:
        self.work, self.end = work, end
        self.watch = Watch(work, leaves=branch == "follow", by_load=False)
        point, norms = first_point(self.watch, start)
        onward = math.copysign(1.0, end - point.load_factor)
        self.here = directed(work, point, onward * point.rate / work.unit, onward)
        self.step = self.first = min(
            LARGEST_STEP, abs(end - point.load_factor) / increments / abs(self.here.slope)
        )
        self.at = 0.0
        self.known: deque[tuple[float, Point]] = deque([(0.0, self.here)], maxlen=KNOWN_STATES)
        self.points, self.done = [self.here], [0.0]
        self.history = [norms]

    def advance(self) -> str:
        """One step, in halves where it has to be; returns why it failed, or nothing."""
        while True:
            found, reason = self._try()
            self.history.append(found.norms)
            if not reason:
                break
            self.work.counters.halved_increments += 1
            self.step /= 2
            if self.step < SMALLEST_STEP * self.first:
                while len(self.points) > 1 and not self.watch.is_resolved(self.points[-1]):
                    self.points.pop()
                return f"stopped at load factor {self.here.load_factor:.6g}: {reason}"
        self.work.counters.increments += 1
        iterations = len(found.norms) - 1
        if iterations <= EASY:
            self.step = min(1.5 * self.step, max(LARGEST_STEP, self.first))
        elif iterations >= HARD:
            self.step *= 0.7
        return ""

    def _try(self) -> tuple[Corrected, str]:
        """One step of the present length; on success the follower stands at its end."""
        work, here = self.work, self.here
        z, load_factor = self._predict()
        normal, along = self._across()
        if (self.end - here.load_factor) * (self.end - load_factor) <= 0.0:
            z, load_factor = self._predict_end(z, load_factor)
            normal, along = np.zeros_like(z), 1.0
        found = correct(work, z, load_factor, normal, along)
        reason = found.reason or self.watch.refuse(here, z, found.z, found.load_factor)
        if reason:
            return found, reason
        point, reason = reached(work, found, found.load_factor)
        if point is None:
            return found, reason
        point = directed(work, point, *self._across())
        if (self.end - here.load_factor) * (self.end - point.load_factor) < 0.0:
            return found, "the step goes beyond the end"
        if self._cosine(point) < SHARPEST_TURN:
            return found, "the path turns sharply"
        step = self._distance(point)
        end, done, reason = self.watch.go(here, point, step)
        if not reason:
            if end is not point:
                self.known.clear()
                step = self._distance(end)
            self._go_to(end, step, done)
        return found, reason

    def _go_to(self, point: Point, step: float, done: float) -> None:
        """Stand at a point, a step further on; done: int P_lambda d(lambda) over the step [J]."""
        self.at += step
        self.here = point
        self.known.append((self.at, point))
        self.points.append(point)
        self.done.append(self.done[-1] + done)

    def _across(self) -> tuple[Array, float]:
        """The tangent here, in dimensionless coordinates, and its load-factor part."""
        normal = self.here.rate / self.work.unit
        normal[self.work.count :] = 0.0
        return normal, self.here.slope

    def _cosine(self, point: Point) -> float:
        """Cosine of the angle between the tangents here and at a point."""
        normal, along = self._across()
        return float(normal @ (point.rate / self.work.unit) + along * point.slope)

    def _distance(self, point: Point) -> float:
        """Distance from here to a point, in the measure of the arc length."""
        moved = ((point.z - self.here.z) / self.work.unit)[: self.work.count]
        return float(np.hypot(np.linalg.norm(moved), point.load_factor - self.here.load_factor))

    def _predict(self) -> tuple[Array, float]:
        """Extrapolate the last states; further than twice their distance, the tangent only."""
        known = list(self.known)
        if len(known) > 1 and self.step > 2 * (known[-1][0] - known[-2][0]):
            known = known[-1:]
        to = self.at + self.step
        z = hermite_extrapolation([(s, p.z, p.rate) for s, p in known], to)
        factors = [(s, np.array(p.load_factor), np.array(p.slope)) for s, p in known]
        return z, float(hermite_extrapolation(factors, to))

    def _predict_end(self, z: Array, load_factor: float) -> tuple[Array, float]:
        """A state at the end of the path, between here and a predicted one beyond it."""
        share = (self.end - self.here.load_factor) / (load_factor - self.here.load_factor)
        linear = self.here.z + share * (z - self.here.z)
        return linear, self.end

    def path(self, message: str) -> Path:
        """What was followed, as a result; ``message`` says why it ended early, if it did."""
        rows = self.work.rows(self.points, self.done[: len(self.points)])
        return self.watch.path(rows, message, self.history)
