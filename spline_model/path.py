"""Following an equilibrium path in the load factor: predict, correct, check, halve."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import asdict

import numpy as np
from numpy.typing import NDArray

from spline_model.checks import left_the_branch, refuse
from spline_model.compile import System
from spline_model.continuation.balance import jumped
from spline_model.continuation.branch import BRANCHES, leave
from spline_model.continuation.critical import BIFURCATION, between
from spline_model.continuation.integration import UNCONFIRMED, Finer
from spline_model.continuation.point import Point, stand
from spline_model.continuation.predict import KNOWN_STATES, hermite_extrapolation
from spline_model.continuation.remark import left, remark
from spline_model.continuation.resolution import Resolution
from spline_model.continuation.start import equilibrium
from spline_model.errors import require_choice
from spline_model.newton import Newton, Workspace, solve
from spline_model.preload import settle
from spline_model.solution import CriticalPoint, Path, Status
from spline_model.work import external_work

Array = NDArray[np.float64]

SMALLEST_STEP = 2.0**-10
"""Least fraction of an increment before the path is given up."""


def follow(
    system: System,
    load_factors: Sequence[float],
    progress: Callable[[int, int], None] | None = None,
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
    """The state of a path while it is followed; ``points`` holds the states that were asked for."""

    def __init__(self, work: Workspace, start: tuple[float, Array] | None, branch: str) -> None:
        self.work, self.resolution = work, Resolution(work.system)
        self.leaves = branch == "follow"
        begin = settle(work) if start is None else equilibrium(work, self.resolution, *start)
        load_factor = 0.0 if start is None else start[0]
        self.here = stand(work, begin.z, load_factor, begin.energies)
        self.known: deque[Point] = deque([self.here], maxlen=KNOWN_STATES)
        self.points = [self.here]
        self.history = [begin.norms]
        self.critical: list[CriticalPoint] = []
        self.note = ""
        self.finer: Finer | None = None

    def path(self, message: str) -> Path:
        """What was followed, as a result; ``message`` says why it ended early, if it did."""
        t, states, rates = (
            np.array([getattr(p, name) for p in self.points]) for name in ("load_factor", "z", "rate")
        )
        return Path(
            status=Status.NOT_CONVERGED if message else Status.CONVERGED,
            message=message or self.note or remark(self.critical),
            load_factor=t,
            states=states,
            rates=rates,
            energies=np.array([p.energies for p in self.points]),
            work=external_work(self.work.system, t, states, rates),
            inertia=np.array([p.inertia for p in self.points]),
            moment_defect=np.array([self.resolution.defect(p.z) for p in self.points]),
            critical_points=tuple(self.critical),
            counters=asdict(self.work.counters),
            history=tuple(self.history),
        )

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
                    self._keep_sound()
                    return f"stopped between load factor {at:.6g} and {at + 2 * step:.6g}: {reason}"
            elif self.here.load_factor != aim:  # on another branch, and somewhere else
                begin = self.here.load_factor
                step = whole = target - begin
            elif (abs(aim - begin) / abs(step)) % 2 == 0 and abs(step) < abs(whole):
                step *= 2  # after an easy part the next may be twice as long, on the grid of halves
        self.points.append(self.here)
        return ""

    def _keep_sound(self) -> None:
        """Keep the last state before a stop, and none that a vanishing stiffness has spoilt."""
        if self.here is not self.points[-1]:
            self.points.append(self.here)
        while self.finer is not None and len(self.points) > 1 and not self.finer.agrees(self.points[-1]):
            self.points.pop()

    def _try(self, load_factor: float) -> tuple[Newton, str]:
        """One step to ``load_factor``; on success the follower stands there, or on another branch."""
        predicted = self._predict(load_factor)
        newton = solve(self.work, predicted, load_factor)
        system = self.work.system
        reason = newton.reason or refuse(system, newton.z)
        reason = reason or left_the_branch(system, self.here.z, predicted, newton.z)
        reason = reason or self.resolution.refuse(newton.z)
        if reason:
            return newton, reason
        try:
            point = stand(self.work, newton.z, load_factor, newton.energies)
        except np.linalg.LinAlgError as error:
            return newton, str(error)
        step = load_factor - self.here.load_factor
        reason = jumped(self.here, point, step, system.scales.energy)
        return newton, reason or self._accept(point, step)

    def _accept(self, point: Point, step: float) -> str:
        """Go to the next point, or from a bifurcation before it to the branch that crosses there."""
        found = between(self.work, self.here, point, step)
        if found and self.resolution.judged:
            self.finer = self.finer or Finer(self.work.system)
            if not self.finer.confirms(self.work, self.here, point, step):
                return UNCONFIRMED.format(kind=found[0].kind)
        crossing = next((c for c in found if c.kind == BIFURCATION), None) if self.leaves else None
        if crossing is not None:
            found = found[: found.index(crossing) + 1]
            branched = leave(self.work, crossing, self.resolution)
            if branched is None or (branched.load_factor - crossing.load_factor) * step <= 0.0:
                return (
                    f"the branch that crosses at load factor {crossing.load_factor:.6g} goes back from there"
                )
            self.leaves, self.note = False, left(crossing)
            self.known.clear()
            point = branched
        self.critical += found
        self.here = point
        self.known.append(point)
        return ""

    def _predict(self, load_factor: float) -> Array:
        """Extrapolate the last states and rates; further than twice their distance, the tangent only."""
        known = list(self.known)
        at = self.here.load_factor
        if len(known) > 1 and abs(load_factor - at) > 2 * abs(at - known[-2].load_factor):
            known = known[-1:]
        return hermite_extrapolation([(p.load_factor, p.z, p.rate) for p in known], load_factor)
