"""Dynamics: the pivot released from a static state (Eq 4 without the drive)."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from spline_model.accurate_motion import Task, solve_accurately
from spline_model.compile import System, compile_scene
from spline_model.content import energy_content, resolution
from spline_model.effects import DrivenRotation
from spline_model.errors import InvalidParameter, require_choice, require_positive
from spline_model.fast.release import is_swing
from spline_model.integrators import (
    energy_consistent,
    explicit,
    generalised_alpha,
    leapfrog,
    quasi_static,
)
from spline_model.integrators.motion import Records, initial_acceleration, set_in_motion
from spline_model.kernels.motion import Motion
from spline_model.kernels.record import DISSIPATED, KINETIC, POSITION, STRAIN, VELOCITY, WEIGHT, WORK
from spline_model.laps import Laps
from spline_model.mechanism import Mechanism
from spline_model.modes import linear_modes, static_state
from spline_model.pivot import Pivot
from spline_model.restart import counted_on, last_state, later
from spline_model.scene import Scene
from spline_model.solution import MotionEstimate, Status

Array = NDArray[np.float64]

INTEGRATORS: dict[str, Callable[..., Records]] = {
    "energy": energy_consistent.integrate,
    "generalised-alpha": generalised_alpha.integrate,
    "explicit": explicit.integrate,
    "leapfrog": leapfrog.integrate,
}
EXPLICIT_STEPS = {
    "explicit": 0.5 * explicit.STABILITY_LIMIT,
    "leapfrog": 0.9 * leapfrog.STABILITY_LIMIT,
}
"""omega h of the default explicit step, omega being the highest frequency at start and at rest: stress
stiffens the strips on the way, and near its limit Runge-Kutta takes energy from the axial waves."""
STEP = 5e-5
"""Default step of the implicit integrators [s]: some 240 steps a swing of Table 1."""
MOST_MEMORY = 2e9
"""Bytes that the records of one run may take."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Trajectory:
    """A motion; T records, the start first.

    time (T,) [s]; bodies: x, y, theta (T, 3) by name [m, m, rad]; body: the one that rotation
    (T,) and centre (T, 2) are of; kinetic_energy, strain_energy (T,) [J]; gravity_energy
    against rest, work of loads and drives so far, dissipated so far (T,) [J];
    constraint_residual (T,) [m]; velocity_residual (T,) its rate [m/s]; states (T, N) and
    velocities (T, Q) of the system in motion; resolution: empty, or how far the step
    under-resolves the swing; effects: names of the scene's effects; counters: steps,
    halved_steps, newton_iterations, ...; seconds: by part (``spline_model.laps``), "start" the
    static state that is let go; estimate: of the error, where an accuracy was asked for.
    """

    status: Status
    message: str
    time: Array
    bodies: dict[str, Array]
    body: str
    kinetic_energy: Array
    strain_energy: Array
    gravity_energy: Array
    work: Array
    dissipated: Array
    constraint_residual: Array
    velocity_residual: Array
    states: Array
    velocities: Array
    resolution: str
    effects: tuple[str, ...]
    counters: dict[str, int]
    settings: dict[str, Any]
    seconds: dict[str, float]
    estimate: MotionEstimate | None = None

    @property
    def rotation(self) -> Array:
        """Rotation of the body, (T,) [rad]."""
        return self.bodies[self.body][:, 2]

    @property
    def centre(self) -> Array:
        """Centre of the body, (T, 2) [m]."""
        return self.bodies[self.body][:, :2]


def solve_release(pivot: Pivot, *, start: float = math.pi / 2, **settings: Any) -> Trajectory:
    """Release the pivot at rest from the static state at rotation ``start`` [rad]; see ``solve_motion``."""
    return solve_motion(pivot.mechanism, start=start, **settings)


def solve_motion(
    mechanism: Mechanism,
    *,
    start: float = 0.0,
    body: str | None = None,
    drive: DrivenRotation | None = None,
    duration: float = 0.05,
    step: float | None = None,
    integrator: str = "energy",
    accuracy: float | None = None,
    records: int | None = None,
    after: Trajectory | None = None,
    **options: float,
) -> Trajectory:
    """Motion of a mechanism from the static state at the rotation ``start`` [rad] of a body, at rest.

    Parameters
    ----------
    body : that ``start`` rotates and that the trajectory reports; default the only one.
    drive : a rotation that is held or driven in a part of the run, if any.
    duration, step : [s]; the step defaults to STEP, or to that of EXPLICIT_STEPS; it is
        shortened so that a whole number of steps fits between the records.
    integrator : "energy" (default, cannot create energy; with massless strips, only the bodies
        are dynamic), "generalised-alpha" (option ``spectral_radius``), "explicit", or "leapfrog":
        the fastest, for a free body on straight mixed Bezier strips.
    accuracy : wanted error of the rotation over the run [rad] instead of a step: steps and control
        points are chosen, and the trajectory has its ``estimate``.
    records : largest number of records; default every step, or with an accuracy 128 a swing or more.
    after : a motion of this mechanism to go on with from its last record, instead of ``start``;
        time, work, losses and the clock of loads and drives run on.

    Raises InvalidParameter, and ConvergenceError if statics does not reach ``start``.
    """
    _check(integrator, duration, start, step, accuracy)
    if accuracy is not None and after is not None:
        raise InvalidParameter("accuracy", accuracy, "a step for a motion that goes on after another")
    laps, body = Laps(), mechanism.design.body_named(body)
    if accuracy is not None:
        task = _task(mechanism, start, body, drive, duration)
        return solve_accurately(mechanism, accuracy, task, records)
    scene = mechanism.released()
    system = compile_scene(scene if drive is None else mechanism.with_effects(drive))
    motion, layout = set_in_motion(system), system.layout
    laps.lap("compile")
    if after is None:
        held = static_state(mechanism, start, body=body)
        z, v = np.zeros(layout.size), np.zeros(layout.coordinate_count)
        known = min(len(held), layout.size)
        z[:known] = held[:known]
    else:
        z, v = last_state(after, system)
        motion = later(motion, float(after.time[-1]))
    acceleration, z = initial_acceleration(system, motion, z, v)
    effects = mechanism.effects
    laps.lap("start")
    if step is None:
        step = min(STEP, duration)
        if integrator in EXPLICIT_STEPS:
            step = min(step, EXPLICIT_STEPS[integrator] / highest_frequency(system, motion, z))
    steps, every = _count(duration, step, records, layout.size + layout.coordinate_count + 7)
    step = duration / steps
    laps.lap("compile")
    if integrator == "energy" and massless(system, motion):
        integrator = "quasi-static strips"
        run = quasi_static.integrate(system, motion, z, v, step=step, steps=steps, every=every)
    else:
        more = {"mechanism": mechanism} if integrator == "leapfrog" else options
        run = INTEGRATORS[integrator](
            system, motion, z, v, acceleration, step=step, steps=steps, every=every, **more
        )
    laps.lap("solve")
    settings = {"integrator": integrator, "step_s": step, **options}
    warning = _resolution(scene, z, v, step)
    trajectory = _trajectory(system, run, effects, body, settings, warning, laps)
    return trajectory if after is None else counted_on(trajectory, after)


def _task(
    mechanism: Mechanism, start: float, body: str, drive: DrivenRotation | None, duration: float
) -> Task:
    """The motion as a task of accuracy on request."""
    system = compile_scene(mechanism.released())
    squares = linear_modes(system, system.rest, set_in_motion(system).mass)[0]
    scheme = "leapfrog" if is_swing(mechanism, system) else "explicit"
    limit = {"leapfrog": leapfrog.STABILITY_LIMIT, "explicit": explicit.STABILITY_LIMIT}[scheme]

    def run(chosen: Mechanism, integrator: str, step: float, records: int) -> Trajectory:
        return solve_motion(
            chosen,
            start=start,
            body=body,
            drive=drive,
            duration=duration,
            step=step,
            integrator=integrator,
            records=records,
        )

    def critical(chosen: Mechanism) -> float:
        scene = compile_scene(chosen.released())
        motion = set_in_motion(scene)
        explicit.require_explicit(scene, motion)
        held = static_state(chosen, start, body=body)[: scene.layout.size]
        return limit / highest_frequency(scene, motion, held)

    return Task(
        duration=duration,
        amplitude=abs(start),
        frequency=math.sqrt(max(float(squares[0]), 0.0)),
        run=run,
        explicit=scheme,
        critical=critical if drive is None else lambda chosen: 0.0,
    )


def _check(
    integrator: str, duration: float, start: float, step: float | None, accuracy: float | None
) -> None:
    require_choice("integrator", integrator, tuple(INTEGRATORS))
    require_positive("duration", duration, "s")
    if not math.isfinite(start):
        raise InvalidParameter("start", start, "a finite angle [rad]")
    for name, value in (("step", step), ("accuracy", accuracy)):
        if value is not None:
            require_positive(name, value, "s" if name == "step" else "rad")
    if accuracy is not None and (step is not None or integrator != "energy"):
        raise InvalidParameter("accuracy", accuracy, "no step beside it, and the energy integrator")


def massless(system: System, motion: Motion) -> bool:
    """Whether no strip has inertia, so that only the bodies' coordinates are dynamic."""
    bodies = min(system.layout.bodies.values(), default=len(motion.mass))
    return not motion.mass[:bodies].any()


def highest_frequency(system: System, motion: Motion, z: Array) -> float:
    """Highest circular frequency at a state and at rest [rad/s]."""
    return math.sqrt(max(linear_modes(system, state, motion.mass)[0][-1] for state in (z, system.rest)))


def _count(duration: float, step: float, records: int | None, width: int) -> tuple[int, int]:
    """Number of steps, a multiple of the steps a record; refuses what does not fit into memory."""
    if step > duration:
        raise InvalidParameter("step", step, f"at most the duration, {duration:g} s")
    steps = max(1, math.ceil(duration / step * (1 - 1e-12)))  # a whole number but for round-off
    every = 1 if records is None else max(1, math.ceil(steps / records))
    memory = 8.0 * width * (steps // every + 1)
    if memory > MOST_MEMORY:
        raise InvalidParameter(
            "duration",
            duration,
            f"records within {MOST_MEMORY / 1e9:g} GB; {steps} steps of {step:g} s take {memory / 1e9:.3g}",
        )
    return math.ceil(steps / every) * every, every


def _trajectory(
    system: System,
    run: Records,
    effects: tuple[str, ...],
    body: str,
    settings: dict[str, Any],
    warning: str,
    laps: Laps,
) -> Trajectory:
    rows, layout = run.rows, system.layout
    rest = float(system.tables.weight @ system.rest[: system.tables.weight.size])
    return Trajectory(
        status=Status.NOT_CONVERGED if run.message else Status.CONVERGED,
        message=run.message,
        time=run.time,
        bodies={b.name: run.states[:, layout.body(b.name)] for b in system.scene.bodies},
        body=body,
        kinetic_energy=rows[:, KINETIC],
        strain_energy=rows[:, STRAIN],
        gravity_energy=rows[:, WEIGHT] + rest,
        work=rows[:, WORK],
        dissipated=rows[:, DISSIPATED],
        constraint_residual=rows[:, POSITION],
        velocity_residual=rows[:, VELOCITY],
        states=run.states,
        velocities=run.velocities,
        resolution=warning,
        effects=effects,
        counters=run.counters,
        settings=settings,
        seconds=laps.lap("recover"),
    )


def _resolution(scene: Scene, z: Array, v: Array, step: float) -> str:
    """What a step leaves unresolved of the modes that carry the energy of the start; drives let go."""
    free = compile_scene(scene)
    motion, size = set_in_motion(free), free.layout.size
    start = np.zeros(size)
    start[: min(size, len(z))] = z[:size]
    acceleration, start = initial_acceleration(free, motion, start, v)
    lowest = linear_modes(free, free.rest, motion.mass)[0][0]
    swing = math.sqrt(max(lowest, 0.0)) / (2 * math.pi)
    return resolution(energy_content(free, motion, start, v, acceleration), swing, step)
