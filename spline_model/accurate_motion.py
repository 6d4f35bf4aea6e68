"""A motion to a wanted accuracy: steps and control points until the estimated error is below it.

Two runs with other steps differ by what the steps are worth, two runs with other strips by what
the control points are worth. The energy-consistent scheme converges with its order only
where its steps are longer than the axial waves that a release excites, and again where they
resolve them; in between the error stays where it is. The difference of two runs shows that,
where a local error does not, and the explicit scheme takes over, whose steps resolve the waves.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from spline_model.design import swinging_slide_stiffness
from spline_model.errors import InvalidParameter
from spline_model.mechanism import Mechanism
from spline_model.solution import MotionEstimate, Status

if TYPE_CHECKING:
    from spline_model.dynamics import Trajectory

MORE = 2
"""Control points more, for the estimate and from one trial to the next."""
MOST = 14
"""Control points at which the search ends: each two more halve the explicit step and double its work."""
INSTANTS = 64
"""Instants a period of the swing at rest at which runs are compared: at least one step lies between."""
SHARE = 2.0 / 3.0
"""The part of the accuracy that the steps may use; the rest is for the control points."""
NO_GAIN = 0.5
"""Energy-consistent steps of at most half the length that leave more than this of the error do not
resolve what it is made of."""
LARGEST_PART, SMALLEST_PART = 0.7, 0.1
"""First and least explicit step over the critical one."""
MOST_STEPS = 500_000
"""Energy-consistent steps at which the search ends where there are no explicit ones."""


class Rung(NamedTuple):
    """A pair of runs: steps between two instants, and for explicit ones the step over the critical one.

    The coarse run has half the steps (order two), or three quarters (explicit, order four):
    their difference is three or two times the error of the fine run.
    """

    integrator: str
    fine: int
    part: float


@dataclass(frozen=True, kw_only=True)
class Task:
    """What is asked for: a motion of ``duration`` [s] with a swing of ``amplitude`` [rad].

    frequency: slowest circular frequency at rest [rad/s], 0 for none; run: solves a mechanism
    with an integrator, a step [s] and a number of records; critical: the longest stable
    explicit step of a mechanism [s], 0 where the explicit scheme cannot be used.
    """

    duration: float
    amplitude: float
    frequency: float
    run: Callable[[Mechanism, str, float, int], Trajectory]
    critical: Callable[[Mechanism], float]


def solve_accurately(mechanism: Mechanism, accuracy: float, task: Task, records: int | None) -> Trajectory:
    """The motion whose estimated error of the rotation is below ``accuracy`` [rad].

    Control points are raised from those of the mechanism on, and the slide stiffness with
    them; runs are compared at the records, or at more instants. An accuracy that is not
    reached is the status NOT_CONVERGED of the best motion.
    """
    least = max(math.ceil(INSTANTS * task.duration * task.frequency / (2 * math.pi)), INSTANTS)
    every = 1 if records is None else math.ceil(least / records)
    runs = _Runs(mechanism, task, least if records is None else every * records)
    n = mechanism.design.discretisation.control_points
    rung = runs.first(n, accuracy)
    while True:
        rung = runs.resolve(n, rung, SHARE * accuracy)
        coarse, fine = runs.pair(n, rung)
        time = difference(coarse, fine)
        space = difference(coarse, runs.pair(n + MORE, rung, fine=False)[0])
        estimate = MotionEstimate(
            accuracy=accuracy, time=time, space=space, control_points=n, runs=runs.count
        )
        if estimate.rotation <= accuracy or time > SHARE * accuracy or n + MORE > MOST:
            return _answer(fine, estimate, runs.slide_stiffness(n), every)
        n += MORE


def difference(a: Trajectory, b: Trajectory) -> float:
    """Largest difference of the rotations of two runs with the same instants [rad]; inf if one stopped."""
    if Status.NOT_CONVERGED in (a.status, b.status):
        return math.inf
    return float(np.abs(a.rotation - b.rotation).max())


def _answer(fine: Trajectory, estimate: MotionEstimate, slide_stiffness: float, every: int) -> Trajectory:
    """The trajectory with its estimate, and every so many of its records."""
    message, status = fine.message, fine.status
    if status is Status.CONVERGED and not estimate.rotation <= estimate.accuracy:
        status = Status.NOT_CONVERGED
        message = (
            f"accuracy {estimate.accuracy:.3g} rad is not reached: the estimated error is "
            f"{estimate.time:.2g} rad by the steps and {estimate.space:.2g} rad by "
            f"{estimate.control_points} control points"
        )
    changes: dict[str, Any] = {
        name: value[::every] for name, value in vars(fine).items() if isinstance(value, np.ndarray)
    }
    changes["bodies"] = {name: place[::every] for name, place in fine.bodies.items()}
    changes["settings"] = fine.settings | {
        "accuracy_rad": estimate.accuracy,
        "control_points": estimate.control_points,
        "slide_stiffness": slide_stiffness,
    }
    return replace(fine, status=status, message=message, estimate=estimate, **changes)


class _Runs:
    """Runs of one mechanism, each solved once."""

    def __init__(self, mechanism: Mechanism, task: Task, instants: int) -> None:
        self.mechanism, self.task, self.instants = mechanism, task, instants
        self.count = 0
        self.with_points = cache(self._with_points)
        self.critical = cache(self._critical)
        self.run = cache(self._run)

    def first(self, n: int, accuracy: float) -> Rung:
        """Energy-consistent steps whose phase error, amplitude omega t (omega h)^2 / 12, is small enough."""
        task = self.task
        angle = task.amplitude * task.frequency * task.duration  # that the phase error is a part of
        step = math.inf
        if angle > 0:
            step = math.sqrt(12 * SHARE * accuracy / 3 / angle) / task.frequency
        if step < self.critical(n):
            return Rung("explicit", 4, LARGEST_PART)
        return Rung("energy", 2 * max(1, math.ceil(self._spacing / (2 * step))), 0.0)

    def resolve(self, n: int, rung: Rung, wanted: float) -> Rung:
        """The first pair from ``rung`` on whose difference is at most ``wanted`` [rad], or else the best."""
        best, least, before = rung, math.inf, math.inf
        following: Rung | None = rung
        while following is not None:
            rung = following
            time = difference(*self.pair(n, rung))
            if time < least:
                best, least = rung, time
            if time <= wanted:
                break
            following = self.finer(n, rung, time / wanted, stuck=time > NO_GAIN * before)
            before = time
        return best

    def finer(self, n: int, rung: Rung, excess: float, *, stuck: bool) -> Rung | None:
        """The next pair after one whose difference is ``excess`` times too large; None if there is none."""
        critical = self.critical(n)
        if rung.integrator == "energy":
            factor = min(max(1.2 * math.sqrt(min(excess, 1e6)), 2.0), 8.0)
            fine = 2 * math.ceil(rung.fine * factor / 2)
            if critical == 0.0:
                return Rung("energy", fine, 0.0) if fine * self.instants <= MOST_STEPS else None
            if not stuck and self._spacing / fine > critical:
                return Rung("energy", fine, 0.0)
            return Rung("explicit", 4, LARGEST_PART)
        part = rung.part * min(max(0.9 * excess**-0.25, 0.3), 0.8)
        return Rung("explicit", 4, part) if part >= SMALLEST_PART else None

    def pair(self, n: int, rung: Rung, *, fine: bool = True) -> tuple[Trajectory, Trajectory]:
        """The coarse and the fine run, or the coarse one twice."""
        steps = rung.fine
        if rung.integrator == "explicit":
            steps = 4 * math.ceil(self._spacing / (4 * rung.part * self.critical(n)))
        coarse = steps // 2 if rung.integrator == "energy" else 3 * steps // 4
        first = self.run(n, rung.integrator, coarse)
        return first, self.run(n, rung.integrator, steps) if fine else first

    @property
    def _spacing(self) -> float:
        return self.task.duration / self.instants

    def _run(self, n: int, integrator: str, steps: int) -> Trajectory:
        self.count += 1
        return self.task.run(self.with_points(n), integrator, self._spacing / steps, self.instants)

    def _critical(self, n: int) -> float:
        try:
            return self.task.critical(self.with_points(n))
        except InvalidParameter:
            return 0.0

    def _with_points(self, n: int) -> Mechanism:
        if n == self.mechanism.design.discretisation.control_points:
            return self.mechanism
        return self.mechanism.with_discretisation(control_points=n, slide_stiffness=self.slide_stiffness(n))

    def slide_stiffness(self, n: int) -> float:
        """That of the mechanism, in the proportion that goes with n control points [EI/L^2]."""
        grid = self.mechanism.design.discretisation
        own = swinging_slide_stiffness(grid.control_points)
        return grid.slide_stiffness * swinging_slide_stiffness(n) / own
