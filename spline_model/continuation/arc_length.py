"""Following an equilibrium path in its arc length, through limit points of the load factor."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import System
from spline_model.continuation.followed import Followed, Point
from spline_model.continuation.follower import Follower, first_point, hermite_extrapolation
from spline_model.continuation.point import directed
from spline_model.continuation.watch import BRANCHES, Watch
from spline_model.errors import require_choice
from spline_model.newton import Newton, correct
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
    branch: str = "primary",
    progress: Callable[[int, int], None] | None = None,
    method: str = "condensed",
) -> Path:
    """The path from rest until its load factor is ``end``.

    The first step changes the load factor by 1 / increments of the way; later ones follow
    the ease of the path. Every accepted state is in the result. The load factor may go down
    and up again; ``end`` is where it is first reached. branch and method as in ``spline_model.path.follow``.
    Source: Riks, J Appl Mech 39 (1972) 1060, with Newton on planes normal to the tangent.
    """
    require_choice("branch", branch, BRANCHES)
    follower = _ArcFollower(followed(system, method), end, increments, branch)
    message = ""
    for taken in range(MOST_STEPS):
        if follower.here.load_factor == end or message:
            break
        message = follower.go_on()
        if progress is not None:
            progress(taken + 1, MOST_STEPS)
    else:
        message = f"load factor {end:g} is not reached in {MOST_STEPS} steps"
    return follower.path(message)


class _ArcFollower(Follower):
    """The same in the arc length, whose states are all asked for."""

    def __init__(self, work: Followed, end: float, increments: int, branch: str) -> None:
        watch = Watch(work, leaves=branch == "follow", by_load=False)
        point, norms = first_point(watch)
        onward = math.copysign(1.0, end - point.load_factor)
        super().__init__(watch, directed(work, point, onward * point.rate / work.unit, onward), norms)
        self.end = end
        self.step = self.first = min(
            LARGEST_STEP, abs(end - point.load_factor) / increments / abs(self.here.slope)
        )

    def go_on(self) -> str:
        """One step, in halves where it has to be; returns why it failed, or nothing."""
        while True:
            found, reason = self._try(self.at + self.step)
            if not reason:
                break
            self.work.counters.halved_increments += 1
            self.step /= 2
            if self.step < SMALLEST_STEP * self.first:
                while len(self.points) > 1 and not self.watch.is_resolved(self.points[-1]):
                    self.points.pop()
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
        factors = [(at, np.array(p.load_factor), np.array(p.slope)) for at, p in self._near(aim)]
        load_factor = float(hermite_extrapolation(factors, aim))
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
        if normal @ (point.rate / self.work.unit) + along * point.slope < SHARPEST_TURN:
            return point, "the path turns sharply"
        return point, ""

    def _across(self) -> tuple[Array, float]:
        """The tangent here, in dimensionless coordinates, and its load-factor part."""
        normal = self.here.rate / self.work.unit
        normal[self.work.count :] = 0.0
        return normal, self.here.slope

    def path(self, message: str) -> Path:
        """What was followed, as a result; ``message`` says why it ended early, if it did."""
        rows = self.work.rows(self.points, self.done[: len(self.points)])
        return self.watch.path(rows, message, self.history)
