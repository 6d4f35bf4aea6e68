"""Following an equilibrium path in the load factor: predict, correct, check, halve."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import System
from spline_model.continuation.branch import BRANCHES
from spline_model.continuation.point import Point, stand
from spline_model.continuation.predict import KNOWN_STATES, hermite_extrapolation
from spline_model.continuation.start import first_point
from spline_model.continuation.watch import Watch
from spline_model.errors import require_choice
from spline_model.newton import Newton, Workspace, solve
from spline_model.solution import Path
from spline_model.work import external_work

Array = NDArray[np.float64]

Progress = Callable[[int, int], None]
"""What is called with the increments done and the increments in all."""
SMALLEST_STEP = 2.0**-10
"""Least fraction of an increment before the path is given up."""


def follow(
    system: System,
    load_factors: Sequence[float],
    progress: Progress | None = None,
    *,
    start: tuple[float, Array] | None = None,
    branch: str = "primary",
) -> Path:
    """Solve the scene at each load factor in turn, from rest at load factor 0.

    An increment whose Newton fails, or whose solution does not pass the checks, is taken
    in halves; when a part below SMALLEST_STEP still fails, the path ends with its last
    good state and the reason. start: load factor and unknowns (N,) of an equilibrium to go
    on from instead of rest. branch: "primary" stays on the branch it is on where another one
    crosses; "follow" leaves it there, along the critical mode.
    """
    require_choice("branch", branch, BRANCHES)
    work = Workspace.of(system)
    follower = _Follower(work, start, branch)
    message = ""
    for i, target in enumerate(load_factors):
        message = follower.advance(float(target))
        if message:
            break
        work.counters.increments += 1
        if progress is not None:
            progress(i + 1, len(load_factors))
    return follower.path(message)


class _Follower:
    """The state of a path while it is followed.

    ``points`` holds the states that were asked for, ``trail`` those on the way to the next one.
    """

    def __init__(self, work: Workspace, start: tuple[float, Array] | None, branch: str) -> None:
        self.work = work
        self.watch = Watch(work, leaves=branch == "follow", by_load=True)
        self.here, norms = first_point(work, self.watch.resolution, start)
        self.known: deque[Point] = deque([self.here], maxlen=KNOWN_STATES)
        self.points = [self.here]
        self.trail: list[Point] = []
        self.history = [norms]

    def path(self, message: str) -> Path:
        """What was followed, as a result; ``message`` says why it ended early, if it did."""
        t, states, rates = (
            np.array([getattr(p, name) for p in self.points]) for name in ("load_factor", "z", "rate")
        )
        work = external_work(self.work.system, t, states, rates)
        return self.watch.path(self.points, work, message, self.history)

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
                    self._keep_last_good()
                    return f"stopped between load factor {at:.6g} and {at + 2 * step:.6g}: {reason}"
            elif self.here.load_factor != aim:  # on another branch, and somewhere else
                begin = self.here.load_factor
                step = whole = target - begin
            elif (abs(aim - begin) / abs(step)) % 2 == 0 and abs(step) < abs(whole):
                step *= 2  # after an easy part the next may be twice as long, on the grid of halves
        self.points.append(self.here)
        self.trail.clear()
        return ""

    def _keep_last_good(self) -> None:
        """Keep the last state of a path that stopped, whether or not it was asked for."""
        kept = [*self.points, *self.trail]
        self.watch.keep_sound(kept)
        self.points = kept[: len(self.points)] + kept[len(self.points) :][-1:]

    def _try(self, load_factor: float) -> tuple[Newton, str]:
        """One step to ``load_factor``; on success the follower stands there, or on another branch."""
        predicted = self._predict(load_factor)
        newton = solve(self.work, predicted, load_factor)
        reason = newton.reason or self.watch.refuse(self.here, predicted, newton.z)
        if reason:
            return newton, reason
        try:
            point = stand(self.work, newton.z, load_factor, newton.energies)
        except np.linalg.LinAlgError as error:
            return newton, str(error)
        reached, reason = self.watch.go(self.here, point, load_factor - self.here.load_factor)
        if not reason:
            if reached is not point:
                self.known.clear()
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
