"""How far a motion is resolved, and a motion to a wanted accuracy: by natural modes and by companion motions.

Of the modes that carry energy at the start each wants steps enough. A companion has two control points more:
where the scene is undamped and free and the steps are not much longer than explicit ones it is the leapfrog,
whose steps resolve all, so that the difference is the error of time steps and control points together. Else
it has the motion's own integrator and step, and shows the error of the control points; a second one of a
quarter of the step shows the error of the steps, and the estimate is the sum.

A motion to an accuracy tries steps and control points until the estimated error of every coordinate is below
it: of rotations of all bodies, and of places of bodies and free ends over a strip. Runs with other steps
differ by what the steps are worth, runs with other strips by what the control points are worth. Free motions
take the leapfrog, whose steps resolve the axial waves that a release excites. With damping, loads, drives or
massless strips the energy-consistent scheme converges with its order only where its steps are longer than
these waves, and again where they resolve them; in between the error stays where it is. The differences of
runs show that, where a local error does not.

A drive that changes its speed at once sends waves through the strips that few control points do not carry:
errors fall slowly with their number, and two more often err alike. The companion has half as many more there.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cache, cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import compile_scene
from spline_model.design import Design
from spline_model.discretisation import motion_penalty_stiffness
from spline_model.effects import DrivenRotation
from spline_model.effects.boundary import Driven
from spline_model.errors import ConvergenceError, InvalidParameter
from spline_model.mechanism import Mechanism
from spline_model.modes import SLIDE_SHARE, linear_modes, stretching_share
from spline_model.motion import leapfrog
from spline_model.motion.records import Trajectory
from spline_model.motion.start import Start, set_in_motion
from spline_model.newton import Laps
from spline_model.scene import Scene
from spline_model.solution import MotionEstimate, Status
from spline_model.statics import static_state

Array = NDArray[np.float64]

STEPS_PER_PERIOD = 20
"""Fewer steps than this in a period do not resolve a mode (phase error above 1 %)."""
CARRIED = 1e-3
"""Least share of the energy that counts: a mode with less moves the bodies by some per cent at most."""

STILL_FORCE, ROUND_OFF = 1e-9, 16.0
"""Forces over EI/L^2 that are none, as statics leaves them; units in the last place of those that cancel."""
UNRESOLVED, STILL = 0.05, 1e-6
"""Largest difference to the companion that is not remarked on: over the swing, and [rad] of a motion that
hardly is one, as its start differs by that alone."""
MOST_SHORTER = 20.0
"""So many of the companion's explicit steps cost about as much as a default step."""
FINER, ORDER = 4, 2
"""Steps of a companion in one of the motion, and the order of both schemes in the motion of the bodies."""
SHARED = 1.5
"""What errors are more than such companions tell, which do not resolve the fastest waves either: on 30 random
releases their sum was 0.37 to 3.2 times the error."""
MORE, HIGHEST = 2, 24
"""Control points more of a companion, and the most where a drive changes its speed: round-off stops motions
from 27 on."""
JUMP = 2.0
"""What half as many control points more count there: 3 for errors that fall with their number, 1 for those
that fall fast."""
COMPARED = 1000
"""Instants at which the two are compared, about: at least so many where the motion has as many records."""
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
COARSEST, FINEST = 1.0 / 0.7, 10.0
"""Explicit steps of first and of most fineness, critical ones over them."""
EXPLICIT_RATIO, RATIO = 4.0 / 3.0, 2.0
"""Coarse step over the fine one, of explicit runs and of others."""
SHORTER, MOST_AT_ONCE = 1.2, 8.0
"""Fineness that follows, over what the order of the scheme asks for, and over the one before at most."""
DOUBT = 0.25
"""The part of the difference of explicit runs that is added, for want of a third below the critical step."""
MOST_STEPS = 500_000
"""Energy-consistent steps at which the search ends where there are no explicit ones."""


def unresolved(scene: Scene, start: Start, step: float) -> str:
    """Return a message on the modes that carry the energy of a start and that a step [s] does not resolve.

    The scene is the scene in motion, without the drives that only hold the start (which may have
    multipliers). About the state a mode of unit modal mass moves as y'' + w^2 y = c with c = phi^T M a and
    y' = phi^T M v: its energy is c^2 / (2 w^2) + y'^2 / 2. Exact for the motion linearised about the state;
    later coupling into other modes is neglected. The lowest mode, the swing, counts in any case, at rest too,
    which a release tends to.
    """
    if start.motion.system.scene is not scene:
        start = Start(set_in_motion(compile_scene(scene)), start.known, start.v)
    system, mass = start.motion.system, start.motion.system.mass
    lowest = linear_modes(system, system.rest)[0][0]
    squares, shapes, slide = linear_modes(system, start.z)
    push, speed = shapes.T @ mass @ start.acceleration, shapes.T @ mass @ start.v
    stored = np.divide(push**2, np.abs(squares), out=np.zeros_like(push), where=squares != 0.0)
    energy = stored + speed**2
    share = energy / (energy.sum() or 1.0)
    squares = np.append(max(squares[0], lowest), squares[1:])
    frequency = np.sqrt(np.maximum(squares, 0.0)) / (2 * math.pi)
    missed = np.flatnonzero((frequency * step * STEPS_PER_PERIOD > 1.0) & (share >= CARRIED))
    missed = np.union1d(missed, np.flatnonzero(frequency[:1] * step * STEPS_PER_PERIOD > 1.0))
    if not missed.size:
        return ""
    swings, highest = 0 in missed, int(missed[np.argmax(frequency[missed])])
    name, also = "the swing", ""
    if highest > 0:
        stretches = stretching_share(system, start.z, shapes[:, highest], squares[highest]) > 0.5
        kind = "sliding" if slide[highest] > SLIDE_SHARE else "stretching" if stretches else "bending"
        name = f"mode {highest + 1} ({kind}, {frequency[highest]:.3g} Hz, {share[highest]:.1g} of the energy)"
    if swings and len(missed) > 1:
        also = f" and {frequency[0] * step:.2g} of the swing's"
    return (
        f"the step of {step:g} s is {frequency[highest] * step:.3g} of the period of {name}{also}: energy is "
        f"right, {'phase and amplitude are not' if swings else 'the phase of that mode is not'}; take "
        f"{1.0 / frequency[highest] / STEPS_PER_PERIOD:.2g} s or less"
    )


def starts_still(start: Start, design: Design) -> bool:
    """Whether a start at rest is in equilibrium: its forces are none but round-off.

    That is of the largest that cancel, of stretching by displacements of a strip's length.
    """
    motion, scales = start.motion, start.motion.system.scales
    force = (motion.system.mass @ start.acceleration) * scales.unit[: len(start.v)] / scales.energy
    stiffest = max(strip.axial_rigidity for strip in design.strips) * scales.length / scales.energy
    least = max(STILL_FORCE, ROUND_OFF * np.finfo(float).eps * stiffest)
    return not start.v.any() and float(np.abs(force).max(initial=0.0)) <= least


@dataclass(frozen=True, kw_only=True)
class Task:
    """A motion of a mechanism from the static state at the rotation ``start`` [rad] of a body.

    The attributes are the arguments of ``spline_model.dynamics.solve_motion``, which is ``solve``.
    """

    mechanism: Mechanism
    start: float | None
    body: str
    drive: DrivenRotation | None
    duration: float
    solve: Callable[..., Trajectory]

    @property
    def length(self) -> float:
        """Length of the longest strip [m], in which displacements count."""
        return max(strip.length for strip in self.mechanism.design.strips)

    @cached_property
    def jumps(self) -> bool:
        """Whether velocities jump in the motion, as a drive changes its speed or catches a body."""
        drives = [*self.mechanism.released().of(Driven), *([] if self.drive is None else [self.drive])]
        return any(
            each.held[0] > 0.0 or (each.moves and len({factor for _, factor in each.history or ()}) > 1)
            for each in drives
        )

    def finer(self, n: int) -> int:
        """Control points of the companion of a motion with n of them."""
        return max(n + MORE, min(math.ceil(1.5 * n), HIGHEST)) if self.jumps else n + MORE

    @cached_property
    def frequency(self) -> float:
        """Slowest circular frequency at rest [rad/s], 0 for none."""
        system = compile_scene(self.mechanism.released())
        squares = linear_modes(system, system.rest)[0]
        return math.sqrt(max(float(squares[0]), 0.0))

    def run(self, n: int, integrator: str, step: float, records: int) -> Trajectory:
        """The motion with n control points by an integrator, with a step [s] and a number of records."""
        asked = {name: getattr(self, name) for name in ("start", "body", "drive", "duration")}
        asked |= {"step": step, "integrator": integrator, "records": records}
        return self.solve(self.with_points(n), **asked, check=False)

    def critical(self, n: int) -> float:
        """The longest stable explicit step with n control points [s], 0 where it cannot be used."""
        if self.drive is not None:
            return 0.0
        chosen = self.with_points(n)
        motion = set_in_motion(compile_scene(chosen.released()))
        try:
            leapfrog.require_explicit(motion)
        except InvalidParameter:
            return 0.0
        held = static_state(chosen.at_start(), self.start, body=self.body)[: motion.system.layout.size]
        return leapfrog.critical_step(motion, held)

    @cached_property
    def with_points(self) -> Callable[[int], Mechanism]:
        """The mechanism with n control points, and a penalty stiffness in proportion; one object a number."""
        mechanism, grid = self.mechanism, self.mechanism.design.discretisation

        def made(n: int) -> Mechanism:
            if n == grid.points:
                return mechanism
            slide = grid.slide * motion_penalty_stiffness(n) / motion_penalty_stiffness(grid.points)
            return mechanism.with_discretisation(control_points=n, penalty_stiffness=slide)

        return cache(made)


def with_companion(task: Task, motion: Trajectory) -> Trajectory:
    """Return the motion with its estimated errors, and a remark in ``resolution`` if they are large.

    task: the task of the motion. If a companion motion fails, the remark states this.
    """
    laps, count, failures = Laps(), len(motion.time) - 1, []
    # the largest divisor that leaves enough instants
    every = max((each for each in range(1, count // COMPARED + 1) if count % each == 0), default=1)
    instants, moves = motion.time[::every], motion.moves(every)
    for companions in _companions(task, motion, float(instants[1])):
        turns, places = (np.zeros(each.shape[:2]) for each in moves)
        try:
            for points, integrator, step, part in companions:
                other = task.run(points, integrator, step, len(instants) - 1)
                if other.message:
                    raise InvalidParameter("step", step, f"one that reaches the end: {other.message}")
                apart = [mine - theirs for mine, theirs in zip(moves, other.moves(), strict=True)]
                turns += part * np.abs(apart[0])
                places += part * np.linalg.norm(apart[1], axis=2)
        except (ConvergenceError, InvalidParameter) as refused:
            failures.append(f"with {points} control points and the {integrator} integrator: {refused}")
            continue
        return replace(
            motion,
            rotation_error=float(turns.max(initial=0.0)),
            displacement_error=float(places.max(initial=0.0)),
            checked=_remark(moves, instants, turns, places, task.length),
            seconds=laps.lap("check") | motion.seconds,
        )
    remark = f"error not estimated: a companion {failures[-1]}"
    return replace(motion, checked=remark, seconds=laps.lap("check") | motion.seconds)


def _companions(
    task: Task, motion: Trajectory, spacing: float
) -> Iterator[list[tuple[int, str, float, float]]]:
    """Companions whose differences add up to the error, and others if one of these fails.

    Each is given by its control points, integrator, step [s] and by what the difference to it counts.
    Their steps are whole between two instants ``spacing`` [s] apart. The leapfrog shows the errors of steps
    and control points together. Where it cannot be used they are apart: a quarter of the step leaves a
    sixteenth of the error of a scheme of second order. Half of it is too near where steps do not resolve
    all that moves: then the difference was down to a quarter of the error.
    """
    own, step = str(motion.settings["integrator"]), float(motion.settings["step_s"])
    points, steps = motion.control_points, round(spacing / step)
    longest = leapfrog.PART * task.critical(points + MORE)
    if longest > 0.0 and (own == leapfrog.NAME or step <= MOST_SHORTER * longest):
        yield [(points + MORE, leapfrog.NAME, spacing / math.ceil(spacing / longest), 1.0)]
    if own != leapfrog.NAME:
        part = SHARED * FINER**ORDER / (FINER**ORDER - 1.0)
        count = JUMP if task.jumps else SHARED
        parts = ((task.finer(points), steps, count), (points, FINER * steps, part))
        yield [(n, "energy", spacing / many, part) for n, many, part in parts]


def _remark(moves: tuple[Array, Array], time: Array, turns: Array, places: Array, length: float) -> str:
    """What is to be said of estimated errors of rotations (T, B) [rad] and places (T, P) [m], or nothing.

    They are held against the swing: half the range of what moves (``moves``) most, places over a strip.
    """
    ranges = (np.ptp(moves[0], axis=0), np.ptp(moves[1], axis=0) / length)
    swing = 0.5 * max(float(each.max(initial=0.0)) for each in ranges)
    apart = np.hstack((turns, places / length)).max(axis=1, initial=0.0)
    much = np.flatnonzero(apart > max(UNRESOLVED * swing, STILL))
    if not much.size:
        return ""
    return (
        f"rotations are uncertain by up to {np.degrees(turns.max(initial=0.0)):.3g} deg and displacements by "
        f"up to {places.max(initial=0.0):.3g} m, by more than {UNRESOLVED:.0%} of the swing from "
        f"{time[much[0]]:.3g} s on: the motion is not resolved; take more control points or shorter steps, "
        "or ask for an accuracy"
    )


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
        fineness, fine, correction, doubt = runs.resolved(n, accuracy)
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
    if records is None:
        return least, 1
    if records < least:
        each = math.ceil(least / records)
        return each * records, each * FINE
    return least, next(each for each in (1, FINE // 2, FINE) if each * records >= FINE * least)


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

    How fine one is, is the number of its steps between two instants, of an ``explicit`` one over that of
    critical steps.
    """

    def __init__(self, task: Task, instants: int, *, explicit: bool) -> None:
        self.task, self.instants, self.explicit = task, instants, explicit
        self.ratio = EXPLICIT_RATIO if explicit else RATIO
        self.spacing, self.count = task.duration / instants, 0
        self.critical, self.run = cache(task.critical), cache(self._run)

    def resolved(self, n: int, accuracy: float) -> tuple[float, Trajectory, Array, float]:
        """Fineness of the first run whose error leaves enough of the accuracy, or else of the best, and what
        was ``solved`` so."""
        fineness, most = self._first(accuracy), FINEST if self.explicit else MOST_STEPS / self.instants
        best, least, excess = None, math.inf, math.inf
        while excess > 1.0 and (best is None or fineness <= most):
            solved = self.solved(n, fineness)
            excess = (_largest(solved[1]) + solved[2]) / (SHARE * accuracy)
            if best is None or excess < least:
                best, least = (fineness, *solved), excess
            fineness *= min(max(SHORTER * excess ** (1.0 / ORDER), self.ratio), MOST_AT_ONCE)
        assert best is not None, "one was solved"
        return best

    def _first(self, accuracy: float) -> float:
        """How fine the first runs are.

        Energy-consistent steps have a small enough phase error, amplitude omega t (omega h)^2 / 12. The
        leapfrog's steps are a hundred times cheaper and resolve all from the start.
        """
        if self.explicit:
            return COARSEST
        task = self.task
        angle = abs(task.start or 0.0) * task.frequency * task.duration  # the phase error is a part of it
        return max(float(FINE), self.spacing * task.frequency * math.sqrt(angle / (6 * SHARE * accuracy)))

    def solved(self, n: int, fineness: float) -> tuple[Trajectory, Array, float]:
        """The fine run, and what coarser ones say that it lacks.

        That is the correction (S, K) of its coordinates by the order of the scheme, and how far the runs
        depart from that order.
        """
        steps = self.steps(n, fineness)
        fine, coarser = self.run(n, steps), self.coarser(n, fineness)
        change = self.moves(fine) - coarser
        correction = change / (self.ratio**ORDER - 1.0)
        if self.explicit:
            return fine, correction, DOUBT * _largest(change)
        before = coarser - self.moves(self.run(n, steps // FINE))
        return fine, correction, _largest(before / self.ratio**ORDER - change)

    def coarser(self, n: int, fineness: float) -> Array:
        """Coordinates (S, K) of the second finest run."""
        return self.moves(self.run(n, round(self.steps(n, fineness) / self.ratio)))

    def steps(self, n: int, fineness: float) -> int:
        """Steps of the finest run between two instants."""
        whole = fineness * self.spacing / self.critical(n) if self.explicit else fineness
        return FINE * max(1, math.ceil(whole / FINE))

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
