"""How far a motion is resolved: by the natural modes that carry its energy, and by companions.

Of the modes that carry energy at the start each wants steps enough. A companion has two control points more:
where the scene is undamped and free and the steps are not much longer than explicit ones it is the leapfrog,
whose steps resolve all, so that the difference is the error of time steps and control points together. Else
it has the motion's own integrator and step, and shows the error of the control points; a second one of a
quarter of the step shows the error of the steps, and the estimate is the sum. Where a drive changes its speed
the companion has half as many control points more.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cache, cached_property

import numpy as np
from numpy.typing import NDArray

from spline_model.basis import SlideModes
from spline_model.compile import System, compile_scene
from spline_model.design import Design
from spline_model.discretisation import motion_penalty_stiffness
from spline_model.effects import DrivenRotation, MixedStretching
from spline_model.effects.boundary import Driven
from spline_model.errors import ConvergenceError, InvalidParameter
from spline_model.mechanism import Mechanism
from spline_model.modes import SLIDE_SHARE, linear_modes
from spline_model.motion import leapfrog
from spline_model.motion.records import Trajectory
from spline_model.motion.start import Motion, Start, set_in_motion
from spline_model.newton import Laps
from spline_model.paper import RIGIDITY, assemble, clamps_of, room, strips_of
from spline_model.scene import Scene
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
"""Steps of a companion in one of the motion, and the order of the scheme."""
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


@dataclass(frozen=True, kw_only=True)
class Content:
    """A natural mode about a state and the energy it carries there.

    number from 1; kind "swing" (the lowest), "bending", "stretching" or "sliding" of the control
    points, a number of the discretisation; frequency [Hz], zero where the state is unstable;
    share of the energy of all modes [1].
    """

    number: int
    kind: str
    frequency: float
    share: float

    @property
    def name(self) -> str:
        """How the mode is called in a sentence."""
        if self.kind == "swing":
            return "the swing"
        return f"mode {self.number} ({self.kind}, {self.frequency:.3g} Hz, {self.share:.1g} of the energy)"


def _energy_content(motion: Motion, z: Array, v: Array, acceleration: Array) -> list[Content]:
    """Return the energy of every mode at the state (z, v) with its acceleration, lowest mode first.

    About the state a mode of unit modal mass moves as y'' + w^2 y = c with c = phi^T M a and y' = phi^T M v:
    its energy is c^2 / (2 w^2) + y'^2 / 2. Exact for the motion linearised about the state; later coupling
    into other modes is neglected. A state at rest in equilibrium has no energy; there the swing counts for
    all of it.
    """
    system = motion.system
    squares, shapes, slide = linear_modes(system, z)
    push, speed = shapes.T @ motion.system.mass @ acceleration, shapes.T @ motion.system.mass @ v
    frequency = np.sqrt(np.maximum(squares, 0.0))
    stored = np.divide(push**2, np.abs(squares), out=np.zeros_like(push), where=squares != 0.0)
    energy = 0.5 * stored + 0.5 * speed**2
    total = float(energy.sum())
    shares = energy / total if total > 0.0 else np.eye(1, len(energy))[0]
    stretch = _stretching_share(system, z, shapes, squares)
    kinds = np.select([slide > SLIDE_SHARE, stretch > 0.5], ["sliding", "stretching"], "bending")
    kinds[0] = "swing"
    return [
        Content(number=i + 1, kind=str(kinds[i]), frequency=frequency[i] / (2 * math.pi), share=shares[i])
        for i in range(len(energy))
    ]


def _resolution(content: list[Content], swing: float, step: float) -> str:
    """Message on the frequencies that a step does not resolve, or an empty string.

    content: of the start; swing: frequency of the lowest mode at rest [Hz], which a release
    tends to. The highest mode that carries energy and has too few steps is named.
    """
    lowest = Content(number=1, kind="swing", frequency=max(swing, content[0].frequency), share=1.0)
    carrying = [lowest, *(mode for mode in content[1:] if mode.share >= CARRIED)]
    missed = [mode for mode in carrying if mode.frequency * step * STEPS_PER_PERIOD > 1.0]
    if not missed:
        return ""
    highest = max(missed, key=lambda mode: mode.frequency)
    lost = "phase and amplitude are not" if lowest in missed else "the phase of that mode is not"
    swings = f" and {lowest.frequency * step:.2g} of the swing's" if lowest in missed[:-1] else ""
    return (
        f"the step of {step:g} s is {highest.frequency * step:.3g} of the period of {highest.name}{swings}: "
        f"energy is right, {lost}; take {1.0 / highest.frequency / STEPS_PER_PERIOD:.2g} s or less"
    )


def unresolved(scene: Scene, start: Start, step: float) -> str:
    """Return a message on the modes that carry the energy of a start and that a step [s] does not resolve.

    The scene is the scene in motion, without the drives that only hold the start (which may have
    multipliers).
    """
    if start.motion.system.scene is not scene:
        start = Start(set_in_motion(compile_scene(scene)), start.known, start.v)
    motion = start.motion
    system = motion.system
    lowest = linear_modes(system, system.rest)[0][0]
    swing = math.sqrt(max(lowest, 0.0)) / (2 * math.pi)
    return _resolution(_energy_content(motion, start.z, start.v, start.acceleration), swing, step)


def starts_still(start: Start, design: Design) -> bool:
    """Whether a start at rest is in equilibrium: its forces are none but round-off.

    That is of the largest that cancel, of stretching by displacements of a strip's length.
    """
    motion, scales = start.motion, start.motion.system.scales
    force = (motion.system.mass @ start.acceleration) * scales.unit[: len(start.v)] / scales.energy
    stiffest = max(strip.axial_rigidity for strip in design.strips) * scales.length / scales.energy
    least = max(STILL_FORCE, ROUND_OFF * np.finfo(float).eps * stiffest)
    return not start.v.any() and float(np.abs(force).max(initial=0.0)) <= least


def _stretching_share(system: System, z: Array, shapes: Array, squares: Array) -> Array:
    """Share of each mode's strain energy in stretching, (F,)."""
    layout = system.layout
    count, size = layout.coordinate_count, layout.size
    gradient, hessian, free, strips = np.zeros(size), np.zeros((size, size)), z.copy(), strips_of(system)
    free[count:] = 0.0  # the stiffness of stretching alone, no force's
    limp = strips._replace(along=strips.along.copy())
    limp.along[..., RIGIDITY] = 0.0
    assemble(free, limp, clamps_of(system), gradient, hessian, room(strips))
    stiffness = hessian[:count, :count].copy()
    for i, effect in enumerate(system.scene.of(MixedStretching)):
        if effect.axial_compliance > 0 and not isinstance(effect.modes, SlideModes):
            at = layout.axial_modes(i)
            coupling = hessian[at, :count]
            stiffness += coupling.T @ np.linalg.solve(-hessian[at, at], coupling)
    strain = np.einsum("im,ij,jm->m", shapes, stiffness, shapes)
    shares: Array = np.divide(strain, np.abs(squares), out=np.zeros_like(strain), where=squares != 0.0)
    return shares


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
        return any(_changes_speed(each) for each in drives)

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


def _changes_speed(drive: Driven) -> bool:
    """Return whether a drive moves a body by a history, which is linear between its times, or catches it."""
    factors = {factor for _, factor in drive.history or ()}
    return drive.held[0] > 0.0 or (drive.moves and len(factors) > 1)


Companion = tuple[int, str, float, float]
"""Control points, integrator and step [s] of a motion to compare with, and what the difference counts."""


def _companions(task: Task, motion: Trajectory, spacing: float) -> Iterator[list[Companion]]:
    """Companions whose differences add up to the error, and others if one of these fails.

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
