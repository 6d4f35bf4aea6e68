"""Following an equilibrium path in its arc length, through limit points of the load factor."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable
from dataclasses import asdict

import numpy as np
from numpy.typing import NDArray

from spline_model.checks import left_the_branch, refuse
from spline_model.compile import System
from spline_model.continuation.balance import done_by_load_factor, jumped
from spline_model.continuation.branch import BRANCHES, leave
from spline_model.continuation.corrector import Corrected, correct
from spline_model.continuation.critical import BIFURCATION, between
from spline_model.continuation.integration import UNCONFIRMED, Finer
from spline_model.continuation.point import Point, directed, stand
from spline_model.continuation.predict import KNOWN_STATES, hermite_extrapolation
from spline_model.continuation.remark import left, remark
from spline_model.continuation.resolution import Resolution
from spline_model.continuation.start import equilibrium
from spline_model.errors import require_choice
from spline_model.newton import Workspace
from spline_model.preload import settle
from spline_model.solution import CriticalPoint, Path, Status

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
) -> Path:
    """The path from rest, or from load factor and unknowns ``start``, until its load factor is ``end``.

    The first step changes the load factor by 1 / increments of the way; later ones follow
    the ease of the path. Every accepted state is in the result. The load factor may go down
    and up again; ``end`` is where it is first reached. branch as in ``spline_model.path.follow``.
    Source: Riks, J Appl Mech 39 (1972) 1060, with Newton on planes normal to the tangent.
    """
    require_choice("branch", branch, BRANCHES)
    follower = _ArcFollower(Workspace.of(system), start, end, increments, branch)
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
        self, work: Workspace, start: tuple[float, Array] | None, end: float, increments: int, branch: str
    ) -> None:
        self.work, self.end, self.leaves = work, end, branch == "follow"
        self.resolution = Resolution(work.system)
        begin = settle(work) if start is None else equilibrium(work, self.resolution, *start)
        load_factor = 0.0 if start is None else start[0]
        point = stand(work, begin.z, load_factor, begin.energies)
        onward = math.copysign(1.0, end - load_factor)
        self.here = directed(work.system, point, onward * point.rate / work.system.scales.unit, onward)
        self.step = self.first = min(LARGEST_STEP, abs(end - load_factor) / increments / abs(self.here.slope))
        self.at = 0.0
        self.known: deque[tuple[float, Point]] = deque([(0.0, self.here)], maxlen=KNOWN_STATES)
        self.points, self.done = [self.here], [0.0]
        self.history = [begin.norms]
        self.critical: list[CriticalPoint] = []
        self.note = ""
        self.finer: Finer | None = None

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
        work, system, here = self.work, self.work.system, self.here
        z, load_factor = self._predict()
        normal, along = self._across()
        if (self.end - here.load_factor) * (self.end - load_factor) <= 0.0:
            z, load_factor = self._predict_end(z, load_factor)
            normal, along = np.zeros_like(z), 1.0
        found = correct(work, z, load_factor, normal, along)
        reason = found.reason or refuse(system, found.z)
        reason = reason or left_the_branch(system, here.z, z, found.z) or self.resolution.refuse(found.z)
        if reason:
            return found, reason
        try:
            point = stand(work, found.z, found.load_factor, found.energies)
        except np.linalg.LinAlgError as error:
            return found, str(error)
        point = directed(system, point, *self._across())
        step = self._distance(point)
        if (self.end - here.load_factor) * (self.end - point.load_factor) < 0.0:
            return found, "the step goes beyond the end"
        if self._cosine(point) < SHARPEST_TURN:
            return found, "the path turns sharply"
        reason = jumped(here, point, step, system.scales.energy)
        return found, reason or self._accept(point, step)

    def _accept(self, point: Point, step: float) -> str:
        """Go to the next point, or from a bifurcation before it to the branch that crosses there."""
        found = between(self.work, self.here, point, step)
        if found and self.resolution.judged:
            self.finer = self.finer or Finer(self.work.system)
            if not self.finer.confirms(self.work, self.here, point, step):
                return UNCONFIRMED.format(kind=found[0].kind)
        done = done_by_load_factor(self.here, point, step)
        crossing = next((c for c in found if c.kind == BIFURCATION), None) if self.leaves else None
        if crossing is not None:
            found = found[: found.index(crossing) + 1]
            branched = leave(self.work, crossing, self.resolution)
            if branched is None:
                return f"no other branch was found at load factor {crossing.load_factor:.6g}"
            self.leaves, self.note = False, left(crossing)
            self.known.clear()
            away = (branched.z - crossing.z) / self.work.system.scales.unit
            point = directed(self.work.system, branched, away, branched.load_factor - crossing.load_factor)
            done, step = point.potential - self.here.potential, self._distance(point)
        self.critical += found
        self.at += step
        self.here = point
        self.known.append((self.at, point))
        self.points.append(point)
        self.done.append(done)
        return ""

    def _across(self) -> tuple[Array, float]:
        """The tangent here, in dimensionless coordinates, and its load-factor part."""
        count = self.work.system.layout.coordinate_count
        normal = self.here.rate / self.work.system.scales.unit
        normal[count:] = 0.0
        return normal, self.here.slope

    def _cosine(self, point: Point) -> float:
        """Cosine of the angle between the tangents here and at a point."""
        normal, along = self._across()
        return float(normal @ (point.rate / self.work.system.scales.unit) + along * point.slope)

    def _distance(self, point: Point) -> float:
        """Distance from here to a point, in the measure of the arc length."""
        count = self.work.system.layout.coordinate_count
        moved = ((point.z - self.here.z) / self.work.system.scales.unit)[:count]
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
        t, states, rates, slopes = (
            np.array([getattr(p, name) for p in self.points])
            for name in ("load_factor", "z", "rate", "slope")
        )
        loads, rest = self.work.system.tables.loads, self.work.system.rest
        by_loads = t * ((states[:, loads.coordinate] - rest[loads.coordinate]) @ loads.value)
        return Path(
            status=Status.NOT_CONVERGED if message else Status.CONVERGED,
            message=message or self.note or remark(self.critical),
            load_factor=t,
            states=states,
            rates=rates / slopes[:, None],
            energies=np.array([p.energies for p in self.points]),
            work=by_loads - by_loads[0] + np.cumsum(self.done),
            inertia=np.array([p.inertia for p in self.points]),
            moment_defect=np.array([self.resolution.defect(p.z) for p in self.points]),
            critical_points=tuple(self.critical),
            counters=asdict(self.work.counters),
            history=tuple(self.history),
        )
