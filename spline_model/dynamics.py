"""Dynamics: the pivot released from a static state (Eq 4 without the drive)."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from spline_model.accuracy import MORE, MOST
from spline_model.accurate_motion import Task, solve_accurately
from spline_model.compile import compile_scene
from spline_model.content import unresolved, with_companion
from spline_model.effects import DrivenRotation
from spline_model.errors import (
    ConvergenceError,
    InvalidParameter,
    require_choice,
    require_finite,
    require_positive,
)
from spline_model.mechanism import Mechanism
from spline_model.modes import settle
from spline_model.motion import energy_consistent, leapfrog, quasi_static
from spline_model.motion.moves import Moves, Steps, carry
from spline_model.motion.records import Trajectory
from spline_model.motion.start import Motion, Start, set_in_motion
from spline_model.newton import Laps
from spline_model.pivot import Pivot
from spline_model.scene import Scene
from spline_model.solution import Later, Status

__all__ = ["INTEGRATORS", "STEP", "Trajectory", "checked", "solve_motion", "solve_release"]

Array = NDArray[np.float64]

INTEGRATORS: dict[str, Callable[..., Moves]] = {
    "energy": energy_consistent.Stepper,
    leapfrog.NAME: leapfrog.Stepper,
}
"""What makes of a start what advances it."""
STEP = 5e-5
"""Default step of the energy integrator [s]: some 240 steps a swing of Table 1."""


def solve_release(pivot: Pivot, *, start: float | None = math.pi / 2, **options: Any) -> Trajectory:
    """Let the pivot go at rest from the static state at rotation ``start`` [rad]: see ``solve_motion``."""
    return solve_motion(pivot, start=start, **options)


def solve_motion(
    mechanism: Mechanism,
    *,
    start: float | None = None,
    body: str | None = None,
    drive: DrivenRotation | None = None,
    duration: float = 0.05,
    step: float | None = None,
    integrator: str = "energy",
    accuracy: float | None = None,
    records: int | None = None,
    after: Trajectory | None = None,
    check: bool = True,
) -> Trajectory:
    """Motion of a mechanism that is let go at rest.

    The start is in static equilibrium: with the rotation ``start`` [rad] of a body driven, weight and
    pre-strain in full, every load at its value times its history at t = 0 (without a history: in full),
    and driven displacements likewise. Then the driven rotation lets go, and so does a driven
    displacement without a history; one with a history goes on holding. Loads go on as value times
    history(t), constant before its first and after its last time. start None: no rotation is driven;
    under loads without a history such a mechanism stands still.

    Parameters
    ----------
    body : that ``start`` rotates and that the trajectory reports; default the only one.
    drive : a rotation that is held or driven in a part of the run, if any.
    duration, step : [s]; the step defaults to STEP, or to a stable one of the leapfrog; it is
        shortened so that a whole number of steps fits between the records.
    integrator : "energy" (default, cannot create energy; with massless strips, only the bodies
        are dynamic), or for free scenes of which no strip is damped or massless "leapfrog", the
        fastest.
    accuracy : wanted error of the rotation over the run [rad] instead of a step: steps and control
        points are chosen, and the trajectory has its ``estimate``.
    records : largest number of records; default every step, or with an accuracy 128 a swing or more.
    check : whether a motion with two control points more says how far the rotation is uncertain:
        ``rotation_error``, and in ``resolution`` where that is much. It costs about another motion, or
        less; none is made with an accuracy, which has its own estimate, or with ``after``.
    after : a motion of this mechanism to go on with from its last record, instead of ``start``;
        time, work, losses and the clock of loads and drives run on.

    Raises InvalidParameter, and ConvergenceError if statics does not reach ``start``.
    """
    _check(integrator, duration, start, step, accuracy)
    if accuracy is not None and after is not None:
        raise InvalidParameter("accuracy", accuracy, "a step for a motion that goes on after another")
    laps, body = Laps(), mechanism.design.body_named(body)
    mechanism, held = _settled(mechanism, start, body) if after is None else (mechanism.in_motion(), None)
    if accuracy is not None:
        task = Task(
            mechanism=mechanism, start=start, body=body, drive=drive, duration=duration, solve=solve_motion
        )
        return solve_accurately(task, accuracy, records)
    laps.lap("start")
    scene = mechanism.released()
    motion = set_in_motion(compile_scene(scene if drive is None else scene.with_effects(drive)))
    laps.lap("compile")
    begun = _begin(motion, held, after)
    laps.lap("start")
    trajectory = _run(mechanism, begun, body, scene, (duration, step, records), integrator, laps)
    if after is not None:
        return trajectory.counted_on(after)
    return checked(mechanism, trajectory, start=start, body=body, drive=drive) if check else trajectory


def _run(
    mechanism: Mechanism,
    begun: Start,
    body: str,
    scene: Scene,
    asked: tuple[float, float | None, int | None],
    integrator: str,
    laps: Laps,
) -> Trajectory:
    """The motion from its start on; scene: without drives; asked: duration, step and records."""
    (duration, step, records), layout = asked, begun.motion.system.layout
    if integrator != "leapfrog":
        begun.motion.require_material()
    if step is None:
        step = _default_step(integrator, begun, duration)
    steps = Steps.of(duration, step, records, layout.size + layout.coordinate_count + 7)
    laps.lap("compile")
    stepper, ran = INTEGRATORS[integrator], integrator
    if integrator == "energy" and begun.motion.massless:
        stepper, ran = quasi_static.stepper, quasi_static.NAME
    run = carry(stepper(begun), steps)
    laps.lap("solve")
    return Trajectory.of(
        begun.motion.system,
        run,
        effects=mechanism.effects,
        body=body,
        settings={
            "integrator": ran,
            "step_s": steps.step,
            "slide_stiffness": mechanism.design.discretisation.slide,
        },
        unresolved=partial(unresolved, scene, begun, steps.step),
        laps=laps,
    )


def _default_step(integrator: str, start: Start, duration: float) -> float:
    """STEP, or a stable one of the leapfrog where it is shorter; at most the duration [s]."""
    step = min(STEP, duration)
    if integrator == leapfrog.NAME:
        step = min(step, leapfrog.PART * leapfrog.critical_step(start.motion, start.z))
    return step


def checked(
    mechanism: Mechanism,
    trajectory: Trajectory,
    *,
    start: float | None,
    body: str | None = None,
    drive: DrivenRotation | None = None,
) -> Trajectory:
    """A motion with what two control points more make of it: ``rotation_error`` and ``resolution``.

    Arguments as of the motion. A motion that stopped or has an estimate is returned as it is.
    """
    mechanism = mechanism.with_control_points(trajectory.control_points).in_motion()
    if trajectory.status is not Status.CONVERGED or trajectory.estimate is not None:
        return trajectory
    task = Task(
        mechanism=mechanism,
        start=start,
        body=mechanism.design.body_named(body),
        drive=drive,
        duration=float(trajectory.time[-1]),
        solve=solve_motion,
    )
    return with_companion(task, trajectory)


def _settled(mechanism: Mechanism, start: float | None, body: str) -> tuple[Mechanism, Later]:
    """The mechanism as it swings, and the states of ``settle`` at whose end it starts.

    Where its control points are left open it gets more until statics reaches the start, or ConvergenceError.
    """
    grid, chosen = mechanism.design.discretisation, mechanism.in_motion()
    points, most = grid.points, grid.points if grid.control_points is not None else MOST[grid.basis]
    while True:
        try:
            return chosen, settle(chosen.at_start(), start, body=body)
        except ConvergenceError:
            if points == most:
                raise
            points = min(points + MORE, most)
            chosen = mechanism.with_control_points(points).in_motion()


def _begin(motion: Motion, held: Later | None, after: Trajectory | None) -> Start:
    """What a motion begins with, its clock set: the state it is held in, or the end of another one."""
    known, count = motion.system.layout.multiplier_start, motion.system.layout.coordinate_count
    if held is not None:
        return Start(motion, held, np.zeros(count))
    assert after is not None, "one of both"
    if after.velocities.shape[1] != count or after.states.shape[1] < known:
        raise InvalidParameter("after", "a motion of another mechanism", f"one of {count} coordinates")
    return Start(motion.later(float(after.time[-1])), Later(after.states.copy), after.velocities[-1].copy())


def _check(
    integrator: str, duration: float, start: float | None, step: float | None, accuracy: float | None
) -> None:
    require_choice("integrator", integrator, tuple(INTEGRATORS))
    require_positive("duration", duration, "s")
    if start is not None:
        require_finite("start", start, "rad")
    for name, value in (("step", step), ("accuracy", accuracy)):
        if value is not None:
            require_positive(name, value, "s" if name == "step" else "rad")
    if accuracy is not None and (step is not None or integrator != "energy"):
        raise InvalidParameter("accuracy", accuracy, "no step beside it, and the energy integrator")
