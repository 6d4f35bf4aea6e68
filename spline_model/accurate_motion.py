"""A motion to a wanted accuracy: steps and control points until the estimated error is below it.

It is that of every coordinate: rotations of all bodies, and places of bodies and free ends over a strip.

Runs with other steps differ by what the steps are worth, runs with other strips by what the
control points are worth. Free motions take the leapfrog, whose steps resolve the axial waves that
a release excites. With damping, loads, drives or massless strips the energy-consistent scheme converges
with its order only where its steps are longer than these waves, and again where they resolve them; in
between the error stays where it is. The differences of runs show that, where a local error does not.

A drive that changes its speed at once sends waves through the strips that few control points do not carry:
errors fall slowly with their number, and two more often err alike. The companion has half as many more there.
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from spline_model.content import JUMP, MORE, Task
from spline_model.motion import leapfrog
from spline_model.motion.records import Trajectory
from spline_model.solution import MotionEstimate, Status

Array = NDArray[np.float64]

MOST = 14
"""Control points at which the search ends: each two more halve the explicit step and double its work."""
MOST_DRIVEN = 18
"""The same where a drive changes its speed: such motions have no explicit steps, and need more of them."""
INSTANTS = 32
"""Instants a period of the swing at rest at which runs are compared: a step of the coarsest lies between."""
FINE = 4
"""Records of the finest run between two such instants."""
SHARE = 2.0 / 3.0
"""The part of the accuracy that the steps may use; the rest is for the control points."""
LARGEST_PART, SMALLEST_PART = 0.7, 0.1
"""First and least explicit step over the critical one."""
EXPLICIT_RATIO = 4.0 / 3.0
"""Coarse explicit step over the fine one."""
ORDER = 2
"""Order of the leapfrog in the bodies' motion; it is four in the phase of the waves alone."""
DOUBT = 0.25
"""The part of the difference of explicit runs that is added, for want of a third below the critical step."""
MOST_STEPS = 500_000
"""Energy-consistent steps at which the search ends where there are no explicit ones."""


def solve_accurately(task: Task, accuracy: float, records: int | None) -> Trajectory:
    """Return the motion whose estimated errors are below ``accuracy``: of rotations [rad], of places over a
    strip.

    Control points are raised from those of the mechanism on, and the penalty stiffness with them. The
    estimate is the correction that the order of the scheme and more control points suggest, and how far
    the runs depart from that order. An accuracy that is not reached is the status NOT_CONVERGED of the best
    motion.
    """
    instants, every = _comparison(task, records)
    n = task.mechanism.design.discretisation.points
    runs = _Runs(task, instants, explicit=task.critical(n) > 0.0)
    most, part = (MOST_DRIVEN, JUMP) if task.jumps else (MOST, 1.0)
    while True:
        fineness = runs.resolve(n, accuracy)
        fine, correction, doubt = runs.solved(n, fineness)
        by_points = part * (runs.coarser(task.finer(n), fineness) - runs.coarser(n, fineness))
        estimate = MotionEstimate(
            accuracy=accuracy,
            rotation=_largest(correction + by_points) + doubt,
            time=_largest(correction) + doubt,
            space=_largest(by_points),
            control_points=n,
            runs=runs.count,
        )
        # a motion that stops may go on with more control points; one whose steps do not converge does not
        stuck = SHARE * accuracy < estimate.time < math.inf
        if estimate.rotation <= accuracy or stuck or n + MORE > most:
            return _answer(fine, estimate, every)
        n += MORE


def _comparison(task: Task, records: int | None) -> tuple[int, int]:
    """Spacings of the instants at which runs are compared, and every which fine record is kept."""
    least = max(math.ceil(INSTANTS * task.duration * task.frequency / (2 * math.pi)), INSTANTS)
    if records is not None and records < least:
        each = math.ceil(least / records)
        return each * records, each * FINE
    if records is None or records >= FINE * least:
        return least, 1
    return least, FINE if records < FINE // 2 * least else FINE // 2


def _largest(difference: Array) -> float:
    """Largest magnitude; inf where there is none because a run stopped."""
    magnitude = float(np.abs(difference).max())
    return magnitude if math.isfinite(magnitude) else math.inf


def _answer(fine: Trajectory, estimate: MotionEstimate, every: int) -> Trajectory:
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
    changes["make"] = lambda: (fine.states[::every], fine.velocities[::every])
    changes["bodies"] = {name: place[::every] for name, place in fine.bodies.items()}
    changes["settings"] = fine.settings | {"accuracy_rad": estimate.accuracy}
    return replace(fine, status=status, message=message, estimate=estimate, **changes)


class _Runs:
    """Runs of one task, each solved once; compared at ``instants`` + 1 instants.

    How fine one is, is a number: of an ``explicit`` one, its step over the critical one; else its steps
    between two instants.
    """

    def __init__(self, task: Task, instants: int, *, explicit: bool) -> None:
        self.task, self.instants, self.explicit = task, instants, explicit
        self.spacing, self.count = task.duration / instants, 0
        self.critical, self.run = cache(task.critical), cache(self._run)

    def resolve(self, n: int, accuracy: float) -> float:
        """How fine the first runs are whose error leaves enough of the accuracy, or else the best.

        The first energy-consistent steps have a small enough phase error, amplitude omega t (omega h)^2 / 12.
        The leapfrog's steps are a hundred times cheaper and resolve all from the start.
        """
        following: float | None = LARGEST_PART
        if not self.explicit:
            task, step = self.task, math.inf
            angle = abs(task.start or 0.0) * task.frequency * task.duration  # the phase error is a part of it
            if angle > 0:
                step = math.sqrt(6 * SHARE * accuracy / angle) / task.frequency
            following = FINE * max(1, math.ceil(self.spacing / (FINE * step)))
        errors: dict[float, float] = {}
        while following is not None:
            fineness = following
            _, correction, doubt = self.solved(n, fineness)
            errors[fineness] = error = _largest(correction) + doubt
            if error <= SHARE * accuracy:
                break
            following = self.finer(fineness, error / (SHARE * accuracy))
        return min(errors, key=lambda each: errors[each])

    def finer(self, fineness: float, excess: float) -> float | None:
        """What follows on runs whose error is ``excess`` times too large; None if nothing does."""
        if self.explicit:
            part = fineness * min(max(0.9 * excess ** (-1.0 / ORDER), 0.3), 0.8)
            return part if part >= SMALLEST_PART else None
        factor = min(max(1.2 * math.sqrt(min(excess, 1e6)), 2.0), 8.0)
        fine = FINE * math.ceil(fineness * factor / FINE)
        return fine if fine * self.instants <= MOST_STEPS else None

    def solved(self, n: int, fineness: float) -> tuple[Trajectory, Array, float]:
        """The fine run, and what coarser ones say that it lacks.

        That is the correction (S, K) of its coordinates by the order of the scheme, and how far the runs
        depart from that order.
        """
        steps = self.steps(n, fineness)
        fine, coarser = self.run(n, steps), self.coarser(n, fineness)
        change = self.moves(fine) - coarser
        if self.explicit:
            return fine, change / (EXPLICIT_RATIO**ORDER - 1.0), DOUBT * _largest(change)
        before = coarser - self.moves(self.run(n, steps // 4))
        return fine, change / 3.0, _largest(before - 4.0 * change) / 4.0

    def coarser(self, n: int, fineness: float) -> Array:
        """Coordinates (S, K) of the second finest run."""
        steps = self.steps(n, fineness)
        return self.moves(self.run(n, 3 * steps // 4 if self.explicit else steps // 2))

    def steps(self, n: int, fineness: float) -> int:
        """Steps of the finest run between two instants."""
        if self.explicit:
            return FINE * math.ceil(self.spacing / (FINE * fineness * self.critical(n)))
        return int(fineness)

    def moves(self, run: Trajectory) -> Array:
        """Rotations of all bodies [rad], places of bodies and free ends over a strip [1], at the instants.

        They are (S, K); nan for a run that stopped.
        """
        if run.status is not Status.CONVERGED:
            return np.array(math.nan)
        turns, places = run.moves((len(run.time) - 1) // self.instants)
        return np.hstack((turns, places.reshape(len(places), -1) / self.task.length))

    def _run(self, n: int, steps: int) -> Trajectory:
        self.count += 1
        records = self.instants * (FINE if steps % FINE == 0 else 1)
        return self.task.run(n, leapfrog.NAME if self.explicit else "energy", self.spacing / steps, records)
