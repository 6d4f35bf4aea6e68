"""Dynamics: the pivot released from a static state (Eq 4 without the drive)."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from functools import partial
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from spline_model.accuracy import FIRST, MOST
from spline_model.accurate_motion import Task, solve_accurately, starts_still, unresolved, with_companion
from spline_model.compile import compile_scene
from spline_model.confirmed import MORE
from spline_model.effects import DrivenRotation
from spline_model.errors import (
    ConvergenceError,
    InvalidParameter,
    require_choice,
    require_finite,
    require_kind,
    require_positive,
)
from spline_model.mechanism import Mechanism, require_mechanism
from spline_model.motion import energy_consistent, leapfrog, massless
from spline_model.motion.moves import Moves, Steps, carry
from spline_model.motion.records import Trajectory
from spline_model.motion.start import Motion, Start, set_in_motion
from spline_model.newton import Laps
from spline_model.scene import Scene
from spline_model.solution import Later, Status
from spline_model.static_answers import StaticSolution
from spline_model.statics import settle

Array = NDArray[np.float64]

Scheme = Callable[[Start], Moves]
"""What makes of a start what advances it."""
MOST_IN_MOTION = 14
"""Control points at which a motion that stops is given up, where their number is left open."""


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
    """Compute the motion of a mechanism that is released at rest.

    The start is in static equilibrium: with the rotation ``start`` [rad] of a body driven, weight and
    pre-strain in full, every load at its value times its history at t = 0 (without a history: in full),
    and driven displacements likewise. Then the driven rotation is released, and so is a driven
    displacement without a history; one with a history goes on holding. Loads go on as value times
    history(t), constant before its first and after its last time. start None: no rotation is driven;
    under loads without a history such a mechanism stands still. Rigid motions that nothing holds are held
    until the start.

    Parameters
    ----------
    mechanism : Mechanism
    start : float, rad, default None
        Rotation of the body at the start.
    body : str, default None
        Body that `start` rotates and that the trajectory reports; None is the only one.
    drive : DrivenRotation, default None
        A rotation that is held or driven in a part of the run.
    duration : float, s
    step : float, s, default None
        Default ``spline_model.motion.moves.STEP``, or a stable one of the leapfrog. It is shortened so that a
        whole number of steps fits between the records.
    integrator : str
        "energy" (default, cannot create energy; with massless strips, only the bodies are dynamic), or
        "leapfrog", the fastest, for free scenes of which no strip is damped or massless.
    accuracy : float, rad and 1, default None
        Wanted error over the run, of rotations and of places over the longest strip, instead of a step: steps
        and control points are chosen, and the trajectory has its `estimate`.
    records : int, default None
        Largest number of records; default every step, or with an accuracy 128 per period or more.
    after : Trajectory, default None
        A motion of this mechanism to continue from its last record, instead of `start`; time, work, losses
        and the clock of loads and drives run on.
    check : bool, default True
        Compute companion motions with two control points more and with a quarter of the step. They estimate
        `rotation_error` and `displacement_error`, and set `resolution` where these are large. They cost about
        five other motions, or one by the leapfrog where it can be used. None is made with an accuracy, which
        has its own estimate, or with `after`.

    Returns
    -------
    Trajectory
        T records, the start first: time (T,), rotation (T,), centre (T, 2), energies (T,) and more.

    Raises
    ------
    InvalidParameter
        A value outside its range.
    ConvergenceError
        Statics does not reach `start`.

    Notes
    -----
    Where the control points are left open and the start is not reached or the motion stops, more are tried.

    References
    ----------
    Gonzalez, Journal of Nonlinear Science 6 (1996) 449, for the conservation of energy.

    Examples
    --------
    With ``pivot`` of the example of ``spline_model.pivot.cross_axis_pivot``:

    >>> motion = solve_motion(pivot, start=0.1, duration=1e-3, step=1e-4, records=5, check=False)
    >>> motion.time.shape, motion.centre.shape
    ((6,), (6, 2))
    """
    require_mechanism(mechanism)
    require_kind("check", check, bool, "True or False")
    if drive is not None:
        require_kind("drive", drive, DrivenRotation, "a DrivenRotation or None")
    if after is not None:
        require_kind("after", after, Trajectory, "a motion of this mechanism or None")
    require_choice("integrator", integrator, tuple(INTEGRATORS))
    require_positive("duration", duration, "s")
    if start is not None:
        require_finite("start", start, "rad")
    for name, value in (("step", step), ("accuracy", accuracy)):
        if value is not None:
            require_positive(name, value, "s" if name == "step" else "rad")
    if accuracy is not None and (step is not None or integrator != "energy" or after is not None):
        raise InvalidParameter(
            "accuracy", accuracy, "no step and no `after` beside it, and the energy integrator"
        )
    body = mechanism.design.body_named(body)
    if accuracy is not None:
        reached, _ = next(_settled(mechanism, start, body))
        task = Task(
            mechanism=reached, start=start, body=body, drive=drive, duration=duration, solve=solve_motion
        )
        return solve_accurately(task, accuracy, records)
    asked = Asked(body, drive, duration, step, records, INTEGRATORS[integrator])
    if after is not None:
        return moved(mechanism.in_motion(), None, asked, Laps(), after).counted_on(after)
    trajectory = _followed(mechanism, start, asked)
    return checked(mechanism, trajectory, start=start, body=body, drive=drive) if check else trajectory


def _energy(start: Start) -> Moves:
    """The default scheme; with massless strips only the bodies are dynamic."""
    start.motion.require_material()
    return massless.Stepper(start) if start.motion.massless else energy_consistent.Stepper(start)


INTEGRATORS: dict[str, Scheme] = {"energy": _energy, leapfrog.NAME: leapfrog.Stepper}


class Asked(NamedTuple):
    """What is asked for in addition to a mechanism and its start.

    step: None for the default of the scheme; unresolved: says what a step does not resolve.
    """

    body: str
    drive: DrivenRotation | None
    duration: float
    step: float | None
    records: int | None
    scheme: Scheme
    unresolved: Callable[[Scene, Start, float], str] = unresolved


def _followed(mechanism: Mechanism, start: float | None, asked: Asked) -> Trajectory:
    """The motion; where control points are left open and it stops, with more of them, or the longest one."""
    found: list[Trajectory] = []
    laps = Laps()
    for chosen, path in _settled(mechanism, start, asked.body):
        found.append(moved(chosen, path, asked, laps))
        if found[-1].status is Status.CONVERGED:
            return found[-1]
        if found[-1].control_points >= MOST_IN_MOTION:
            break
        laps = Laps()
    return max(found, key=lambda each: float(each.time[-1]))


def moved(
    mechanism: Mechanism,
    path: StaticSolution | None,
    asked: Asked,
    laps: Laps,
    after: Trajectory | None = None,
) -> Trajectory:
    """The motion with given control points, from the end of a path or after another motion."""
    laps.lap("start")
    scene, drive = mechanism.released(), asked.drive
    motion = set_in_motion(compile_scene(scene if drive is None else scene.with_effects(drive)))
    laps.lap("compile")
    begun = _begin(motion, path.unknowns if path else None, after)
    laps.lap("start")
    stepper = asked.scheme(begun)
    step = min(stepper.default_step(), asked.duration) if asked.step is None else asked.step
    width = motion.system.layout.size + motion.system.layout.coordinate_count + 7
    steps = Steps.of(asked.duration, step, asked.records, width)
    laps.lap("compile")
    return carry(
        stepper,
        steps,
        laps=laps,
        settings={
            "integrator": stepper.name,
            "step_s": steps.step,
            "penalty_stiffness": mechanism.design.discretisation.slide,
            **stepper.settings,
        },
        effects=mechanism.effects,
        body=asked.body,
        unresolved=partial(asked.unresolved, scene, begun, steps.step),
        way=_way_to_start(path) if path else "",
        still=partial(starts_still, begun, mechanism.design),
    )


def checked(
    mechanism: Mechanism,
    trajectory: Trajectory,
    *,
    start: float | None,
    body: str | None = None,
    drive: DrivenRotation | None = None,
) -> Trajectory:
    """Return a motion with its estimated errors [rad, 1] and its ``resolution``, from companion motions.

    start: rotation at the start [rad]. The arguments are those of the motion. A motion that stopped, or that
    has an estimate, is returned unchanged.
    """
    mechanism = mechanism.on(trajectory.segments, trajectory.control_points).in_motion()
    if trajectory.status is not Status.CONVERGED or trajectory.estimate is not None:
        return trajectory
    duration, body = float(trajectory.time[-1]), mechanism.design.body_named(body)
    task = Task(
        mechanism=mechanism, start=start, body=body, drive=drive, duration=duration, solve=solve_motion
    )
    return with_companion(task, trajectory)


def _way_to_start(path: StaticSolution) -> str:
    """A remark on the critical points that a path passes before a motion starts at its end."""
    told = []
    for point in path.critical_points:
        turn = f" ({math.degrees(point.rotation):.3g} deg)" if path.driven and point.rotation else ""
        told.append(f"{point.kind} at load factor {point.load_factor:.3g}{turn}")
    told += ["the start is unstable while it is held"] if path.inertia[-1] > 0 else []
    return f"the way to the start: {'; '.join(told)}" if told else ""


def _settled(
    mechanism: Mechanism, start: float | None, body: str
) -> Iterator[tuple[Mechanism, StaticSolution]]:
    """The mechanism as it swings, and the path of ``settle`` at whose end it starts.

    Where its control points are left open more of them follow, and segments where none of them is enough.
    ConvergenceError if statics reaches the start with none of them.
    """
    grid, failed, reached = mechanism.design.discretisation, None, False
    tried = [(grid.segments, grid.points)]
    if grid.control_points is None:
        tried += [(grid.segments, points) for points in (*range(grid.points + MORE, MOST, MORE), MOST)]
        tried += [(2**k * grid.segments, FIRST) for k in range(1, 5)]
    for segments, points in tried:
        if reached and segments > grid.segments:
            return
        chosen = mechanism.on(segments, points).in_motion()
        try:
            path = settle(chosen.at_start(), start, body=body, starts=True)
        except ConvergenceError as error:
            if not error.solution.settled:  # a property of the design
                raise
            failed = failed or error
            continue
        reached = True
        yield chosen, path
    if failed is not None and not reached:
        raise failed


def _begin(motion: Motion, held: Later | None, after: Trajectory | None) -> Start:
    """What a motion begins with, its clock set: the state it is held in, or the end of another one."""
    known, count = motion.system.layout.multiplier_start, motion.system.layout.coordinate_count
    if held is not None:
        return Start(motion, held, np.zeros(count))
    assert after is not None, "one of both"
    if after.velocities.shape[1] != count or after.states.shape[1] < known:
        raise InvalidParameter("after", "a motion of another mechanism", f"one of {count} coordinates")
    return Start(motion.later(float(after.time[-1])), Later(after.states.copy), after.velocities[-1].copy())
