"""How far a motion is resolved: by the natural modes that carry its energy, and by a companion.

Of the modes that carry energy at the start each wants steps enough. A companion has two control points more:
where the scene is undamped and free it is the leapfrog, whose steps resolve all, so that the difference
shows what the motion's own steps and its control points leave out together; else it has the motion's own
integrator and step, and shows the control points alone.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from spline_model.accurate_motion import MORE, Task
from spline_model.basis import SlideModes
from spline_model.bordered import assemble
from spline_model.compile import System, compile_scene
from spline_model.effects import MixedStretching
from spline_model.errors import ConvergenceError, InvalidParameter
from spline_model.mechanism import Mechanism
from spline_model.modes import SLIDE_SHARE, linear_modes
from spline_model.motion import leapfrog, quasi_static
from spline_model.motion.records import Trajectory
from spline_model.motion.start import Motion, Start, set_in_motion
from spline_model.newton import Laps
from spline_model.quadrature import RIGIDITY
from spline_model.scene import Scene

Array = NDArray[np.float64]

STEPS_PER_PERIOD = 20
"""Fewer steps than this in a period do not resolve a mode (phase error above 1 %)."""
CARRIED = 1e-3
"""Least share of the energy that counts: a mode with less moves the bodies by some per cent at most."""


UNRESOLVED, STILL = 0.05, 1e-6
"""Largest difference to the companion that is not remarked on: over the swing, and [rad] of a motion that
hardly is one, as its start differs by that alone."""
MOST_SHORTER = 20.0
"""So many of the companion's explicit steps cost about as much as a default step."""
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


def energy_content(motion: Motion, z: Array, v: Array, acceleration: Array) -> list[Content]:
    """Energy of every mode at the state (z, v) with its acceleration, lowest mode first.

    About the state a mode of unit modal mass moves as y'' + w^2 y = c with c = phi^T M a and
    y' = phi^T M v: its energy is c^2 / (2 w^2) + y'^2 / 2. Exact for the motion linearised
    about the state; what later couples into other modes is left out. A state at rest in
    equilibrium has no energy; there the swing counts for all of it.
    """
    system = motion.system
    squares, shapes, slide = linear_modes(system, z, motion.mass)
    push, speed = shapes.T @ motion.mass @ acceleration, shapes.T @ motion.mass @ v
    frequency = np.sqrt(np.maximum(squares, 0.0))
    energy = 0.5 * push**2 / np.maximum(np.abs(squares), np.finfo(float).tiny) + 0.5 * speed**2
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
    """What a step leaves unresolved, or an empty string.

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
    """What a step [s] leaves unresolved of the modes that carry the energy of a start.

    The scene is that in motion, without the drives that the start may have multipliers of: they let go.
    """
    if start.motion.system.scene is not scene:
        start = Start(set_in_motion(compile_scene(scene)), start.known, start.v)
    motion = start.motion
    system = motion.system
    lowest = linear_modes(system, system.rest, motion.mass)[0][0]
    swing = math.sqrt(max(lowest, 0.0)) / (2 * math.pi)
    return _resolution(energy_content(motion, start.z, start.v, start.acceleration), swing, step)


def _stretching_share(system: System, z: Array, shapes: Array, squares: Array) -> Array:
    """Share of each mode's strain energy in stretching, (F,)."""
    layout = system.layout
    count, size = layout.coordinate_count, layout.size
    gradient, hessian, free, points = np.zeros(size), np.zeros((size, size)), z.copy(), system.points
    free[count:] = 0.0  # the stiffness of stretching alone, no force's
    limp = points._replace(numbers=points.numbers.copy())
    limp.numbers[:, RIGIDITY] = 0.0
    assemble(free, limp, system.tables.clamps, gradient, hessian, np.empty((5, 4)))
    stiffness = hessian[:count, :count].copy()
    for i, effect in enumerate(system.scene.of(MixedStretching)):
        if effect.axial_compliance > 0 and not isinstance(effect.modes, SlideModes):
            at = layout.axial_modes(i)
            coupling = hessian[at, :count]
            stiffness += coupling.T @ np.linalg.solve(-hessian[at, at], coupling)
    strain = np.einsum("im,ij,jm->m", shapes, stiffness, shapes)
    return np.asarray(strain / np.maximum(np.abs(squares), np.finfo(float).tiny))


def with_companion(task: Task, motion: Trajectory) -> Trajectory:
    """The motion with its ``rotation_error``, and a remark in ``resolution`` where that is much of the swing.

    task: that of the motion. A companion that fails leaves nothing to compare, and the remark says so.
    """
    laps, count = Laps(), len(motion.time) - 1
    points = task.mechanism.design.discretisation.points + MORE
    # the largest divisor that leaves enough instants
    every = max((each for each in range(1, count // COMPARED + 1) if count % each == 0), default=1)
    instants = motion.time[::every]
    try:
        scheme = _scheme(motion, leapfrog.PART * task.critical(points), float(instants[1]))
        other = task.run(points, *scheme, len(instants) - 1)
        failed = other.message
    except (ConvergenceError, InvalidParameter) as refused:
        failed = str(refused)
    error, remark, seconds = (
        math.nan,
        f"not checked with {points} control points: {failed}",
        laps.lap("check"),
    )
    if not failed:
        apart = np.abs(other.rotation - motion.rotation[::every])
        error, remark = float(apart.max()), _remark(task.mechanism, motion, instants, apart, points)
    return replace(motion, rotation_error=error, checked=remark, seconds=seconds | motion.seconds)


def _scheme(motion: Trajectory, longest: float, spacing: float) -> tuple[str, float]:
    """Integrator and step [s] of the companion, whole steps between two instants ``spacing`` [s] apart.

    longest: step of the leapfrog [s], 0 where it cannot be used.
    """
    own, step = str(motion.settings["integrator"]), float(motion.settings["step_s"])
    if longest > 0.0 and (own == leapfrog.NAME or step <= MOST_SHORTER * longest):
        return leapfrog.NAME, spacing / math.ceil(spacing / longest)
    return ("energy" if own == quasi_static.NAME else own), spacing / round(spacing / step)


def _remark(mechanism: Mechanism, motion: Trajectory, time: Array, apart: Array, points: int) -> str:
    """What is to be said of the differences (T,) [rad], or nothing.

    They are held against the swing: half the range of the rotation, or of the centre over a strip where
    the body hardly turns.
    """
    length = max(strip.length for strip in mechanism.design.strips)
    swing = 0.5 * max(float(np.ptp(motion.rotation)), float(np.ptp(motion.centre, axis=0).max()) / length)
    much = np.flatnonzero(apart > max(UNRESOLVED * swing, STILL))
    if not much.size:
        return ""
    return (
        f"with {points} control points the rotation differs by up to {np.degrees(apart.max()):.3g} deg, by "
        f"more than {UNRESOLVED:.0%} of the swing from {time[much[0]]:.3g} s on: the motion is not resolved; "
        "take more control points or ask for an accuracy"
    )
