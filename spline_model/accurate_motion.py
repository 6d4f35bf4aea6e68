"""A motion to a wanted accuracy: steps and control points until the estimated error is below it.

Runs with other steps differ by what the steps are worth, runs with other strips by what the
control points are worth. Free motions take the leapfrog, whose steps resolve the axial waves that
a release excites. With damping, loads, drives or massless strips the energy-consistent scheme converges
with its order only where its steps are longer than these waves, and again where they resolve them; in
between the error stays where it is. The differences of runs show that, where a local error does not.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache, cached_property, partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import compile_scene
from spline_model.design import swinging_slide_stiffness
from spline_model.effects import DrivenRotation
from spline_model.errors import InvalidParameter
from spline_model.estimate import MotionEstimate
from spline_model.mechanism import Mechanism
from spline_model.modes import linear_modes, static_state
from spline_model.motion.dispatch import highest_frequency
from spline_model.motion.explicit import require_explicit, stability_limit
from spline_model.motion.start import set_in_motion
from spline_model.solution import Status

if TYPE_CHECKING:
    from spline_model.motion.trajectory import Trajectory

Array = NDArray[np.float64]

MORE = 2
"""Control points more, for the estimate and from one trial to the next."""
MOST = 14
"""Control points at which the search ends: each two more halve the explicit step and double its work."""
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
EXPLICIT = "leapfrog"
"""The scheme of the runs whose steps resolve all."""
ORDER = 2
"""Its order in the rotation; it is four in the phase of the waves alone."""
DOUBT = 0.25
"""The part of the difference of explicit runs that is added, for want of a third below the critical step."""
MOST_STEPS = 500_000
"""Energy-consistent steps at which the search ends where there are no explicit ones."""


class _Rung(NamedTuple):
    """A scheme and how fine it is: steps between two instants, or the step over the critical one."""

    integrator: str
    fine: int
    part: float


class _Resolved(NamedTuple):
    """Runs of one rung: the fine one, a coarser rotation (S,), and what the fine one still lacks.

    correction (S,): of the fine rotation by the order of the scheme [rad]; doubt: how far the
    runs depart from that order [rad].
    """

    fine: Trajectory
    coarser: Array
    correction: Array
    doubt: float

    @property
    def error(self) -> float:
        """Estimated error by the steps [rad]."""
        return _largest(self.correction) + self.doubt


@dataclass(frozen=True, kw_only=True)
class Task:
    """A motion of a mechanism from the static state at the rotation ``start`` of a body; as ``solve_motion``,
    which is ``solve``."""

    mechanism: Mechanism
    start: float | None
    body: str
    drive: DrivenRotation | None
    duration: float
    solve: Callable[..., Trajectory]

    @cached_property
    def frequency(self) -> float:
        """Slowest circular frequency at rest [rad/s], 0 for none."""
        system = compile_scene(self.mechanism.released())
        squares = linear_modes(system, system.rest, set_in_motion(system).mass)[0]
        return math.sqrt(max(float(squares[0]), 0.0))

    def run(self, chosen: Mechanism, integrator: str, step: float, records: int) -> Trajectory:
        """The motion of a mechanism by an integrator, with a step [s] and a number of records."""
        asked = {name: getattr(self, name) for name in ("start", "body", "drive", "duration")}
        return self.solve(chosen, **asked, step=step, integrator=integrator, records=records, check=False)

    def critical(self, chosen: Mechanism) -> float:
        """The longest stable explicit step with a mechanism [s], 0 where it cannot be used."""
        if self.drive is not None:
            return 0.0
        motion = set_in_motion(compile_scene(chosen.released()))
        try:
            require_explicit(motion, EXPLICIT)
        except InvalidParameter:
            return 0.0
        held = static_state(chosen.at_start(), self.start, body=self.body)[: motion.system.layout.size]
        return stability_limit(EXPLICIT, motion) / highest_frequency(motion, held)


def solve_accurately(task: Task, accuracy: float, records: int | None) -> Trajectory:
    """The motion whose estimated error of the rotation is below ``accuracy`` [rad].

    Control points are raised from those of the mechanism on, and the slide stiffness with
    them. The estimate is the correction that the order of the scheme and two control points
    more suggest, and how far the runs depart from that order. An accuracy that is not reached
    is the status NOT_CONVERGED of the best motion.
    """
    mechanism = task.mechanism
    instants, every = _comparison(task, records)
    runs = _Runs(task, instants)
    n = mechanism.design.discretisation.points
    while True:
        rung = runs.resolve(n, runs.first(n, accuracy), accuracy)
        by_steps, by_points = runs.solved(n, rung), runs.by_points(n, rung)
        estimate = MotionEstimate(
            accuracy=accuracy,
            rotation=_largest(by_steps.correction + by_points) + by_steps.doubt,
            time=by_steps.error,
            space=_largest(by_points),
            control_points=n,
            runs=runs.count,
        )
        stuck = by_steps.error > SHARE * accuracy
        if estimate.rotation <= accuracy or stuck or n + MORE > MOST:
            return _answer(by_steps.fine, estimate, _slide_stiffness(mechanism, n), every)
        n += MORE


def _comparison(task: Task, records: int | None) -> tuple[int, int]:
    """Spacings of the instants at which runs are compared, and every which fine record is kept."""
    least = max(math.ceil(INSTANTS * task.duration * task.frequency / (2 * math.pi)), INSTANTS)
    if records is None or records >= FINE * least:
        return least, 1
    if records >= least:
        return least, FINE if records < FINE // 2 * least else FINE // 2
    each = math.ceil(least / records)
    return each * records, each * FINE


def _largest(difference: Array) -> float:
    """Largest magnitude; inf where there is none because a run stopped."""
    magnitude = float(np.abs(difference).max())
    return magnitude if math.isfinite(magnitude) else math.inf


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
    changes["whole"] = fine.whole.thinned(every)
    changes["bodies"] = {name: place[::every] for name, place in fine.bodies.items()}
    changes["settings"] = fine.settings | {
        "accuracy_rad": estimate.accuracy,
        "control_points": estimate.control_points,
        "slide_stiffness": slide_stiffness,
    }
    return replace(fine, status=status, message=message, estimate=estimate, **changes)


class _Runs:
    """Runs of one mechanism, each solved once; compared at ``instants`` + 1 instants."""

    def __init__(self, task: Task, instants: int) -> None:
        self.task, self.instants = task, instants
        self.spacing = task.duration / instants
        self.count = 0
        self.with_points = cache(partial(with_points, task.mechanism))
        self.critical = cache(lambda n: task.critical(self.with_points(n)))
        self.run = cache(self._run)

    def first(self, n: int, accuracy: float) -> _Rung:
        """Energy-consistent steps whose phase error, amplitude omega t (omega h)^2 / 12, is small enough.

        The leapfrog's steps are a hundred times cheaper and resolve all from the start.
        """
        task = self.task
        if self.critical(n) > 0.0:
            return _Rung(EXPLICIT, FINE, LARGEST_PART)
        angle = abs(task.start or 0.0) * task.frequency * task.duration  # that the phase error is a part of
        step = math.inf
        if angle > 0:
            step = math.sqrt(6 * SHARE * accuracy / angle) / task.frequency
        return _Rung("energy", FINE * max(1, math.ceil(self.spacing / (FINE * step))), 0.0)

    def resolve(self, n: int, rung: _Rung, accuracy: float) -> _Rung:
        """The first rung from ``rung`` on whose error leaves enough of the accuracy, or else the best."""
        best, least = rung, math.inf
        following: _Rung | None = rung
        while following is not None:
            rung = following
            error = self.solved(n, rung).error
            if error < least:
                best, least = rung, error
            if error <= SHARE * accuracy:
                break
            following = self.finer(rung, error / (SHARE * accuracy))
        return best

    def finer(self, rung: _Rung, excess: float) -> _Rung | None:
        """The next rung after one whose error is ``excess`` times too large; None if there is none."""
        if rung.integrator != "energy":
            part = rung.part * min(max(0.9 * excess ** (-1.0 / ORDER), 0.3), 0.8)
            return _Rung(EXPLICIT, FINE, part) if part >= SMALLEST_PART else None
        factor = min(max(1.2 * math.sqrt(min(excess, 1e6)), 2.0), 8.0)
        fine = FINE * math.ceil(rung.fine * factor / FINE)
        return _Rung("energy", fine, 0.0) if fine * self.instants <= MOST_STEPS else None

    def solved(self, n: int, rung: _Rung) -> _Resolved:
        """The runs of a rung and what they say of the fine one."""
        steps = self.steps(n, rung)
        fine, coarser = self.run(n, rung.integrator, steps), self.coarser(n, rung)
        change = self.rotation(fine) - coarser
        if rung.integrator != "energy":
            doubt = DOUBT * _largest(change)
            gain = EXPLICIT_RATIO**ORDER - 1.0
            return _Resolved(fine, coarser, change / gain, doubt)
        before = coarser - self.rotation(self.run(n, rung.integrator, steps // 4))
        return _Resolved(fine, coarser, change / 3.0, _largest(before - 4.0 * change) / 4.0)

    def by_points(self, n: int, rung: _Rung) -> Array:
        """What some more control points change of the rotation (S,) [rad]."""
        return self.coarser(n + MORE, rung) - self.coarser(n, rung)

    def coarser(self, n: int, rung: _Rung) -> Array:
        """Rotation (S,) of the second finest run of a rung [rad]."""
        steps = self.steps(n, rung)
        fewer = 3 * steps // 4 if rung.integrator != "energy" else steps // 2
        return self.rotation(self.run(n, rung.integrator, fewer))

    def steps(self, n: int, rung: _Rung) -> int:
        """Steps of the finest run between two instants."""
        if rung.integrator != "energy":
            return FINE * math.ceil(self.spacing / (FINE * rung.part * self.critical(n)))
        return rung.fine

    def rotation(self, run: Trajectory) -> Array:
        """Rotation at the instants (S,) [rad]; nan for a run that stopped."""
        if run.status is not Status.CONVERGED:
            return np.full(self.instants + 1, np.nan)
        return run.rotation[:: (len(run.time) - 1) // self.instants]

    def _run(self, n: int, integrator: str, steps: int) -> Trajectory:
        self.count += 1
        records = self.instants * (FINE if steps % FINE == 0 else 1)
        return self.task.run(self.with_points(n), integrator, self.spacing / steps, records)


def with_points(mechanism: Mechanism, n: int) -> Mechanism:
    """The mechanism with n control points, and a slide stiffness in the proportion that goes with them."""
    if n == mechanism.design.discretisation.points:
        return mechanism
    return mechanism.with_discretisation(control_points=n, slide_stiffness=_slide_stiffness(mechanism, n))


def _slide_stiffness(mechanism: Mechanism, n: int) -> float:
    """That of the mechanism, in the proportion that goes with n control points [EI/L^2]."""
    grid = mechanism.design.discretisation
    return grid.slide * swinging_slide_stiffness(n) / swinging_slide_stiffness(grid.points)
