"""Statics: a pivot under a driven rotation, a scene under growing loads (Eq 19)."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from spline_model.accuracy import check_accuracy
from spline_model.accurate_path import solve_accurately
from spline_model.compile import System, compile_scene
from spline_model.continuation.arc_length import follow_arc
from spline_model.continuation.recover import recover
from spline_model.continuation.start import last_state
from spline_model.effects import DrivenRotation
from spline_model.effects.base import Constraint
from spline_model.effects.registry import MOTION_ONLY
from spline_model.errors import ConvergenceError, InvalidParameter, require_choice, require_count
from spline_model.fast.path import Answer
from spline_model.fast.solve import follow_fast, is_fast, path_of
from spline_model.laps import Laps
from spline_model.mechanism import Mechanism
from spline_model.path import follow
from spline_model.pivot import BODY, STRIPS, Pivot
from spline_model.scene import Scene
from spline_model.sections import clamp_reactions, sections
from spline_model.solution import MechanismSolution, Path, StaticSolution, Status
from spline_model.work import gravity_energy

Array = NDArray[np.float64]

STATIONS = np.linspace(0.0, 1.0, 61)
"""Where sections are recovered, reference arc length over L; both clamped ends are among them."""

LEAST_ROTATION = 1e-12
"""Largest rotation of a path that is none [rad]: states are solved to 1e-11."""

METHODS = ("condensed", "multipliers")
CONTROLS = ("load", "arc-length")
Progress = Callable[[int, int], None]


def solve_statics(
    pivot: Pivot,
    *,
    rotation: float | Sequence[float],
    increments: int = 20,
    method: str = "condensed",
    accuracy: float | None = None,
    branch: str = "primary",
    start: StaticSolution | None = None,
    raise_on_failure: bool = True,
    progress: Progress | None = None,
) -> StaticSolution:
    """Drive the pivot's body from 0 to ``rotation`` [rad] in equal increments.

    A sequence of rotations is a path from one to the next (there and back), each leg in
    ``increments``. method: "condensed" runs compiled with the clamps solved and the strips
    condensed, where the scene allows it; "multipliers" is the paper's bordered system. Both
    agree to 1e-10. accuracy: wanted error of trajectory and torque over the whole path,
    relative [1]; the control points are raised from the pivot's until the estimated one is
    below, axial modes and quadrature with them, and the solution has its ``estimate``.
    branch: "primary" or "follow" at a bifurcation; start: a solution of the same
    pivot to go on from, instead of rest; either of them takes the multiplier path and no
    accuracy. Raises ConvergenceError with the converged part of the path, or with the best one
    where the accuracy is not reached; returns it as a status with ``raise_on_failure=False``.
    """
    targets = [rotation] if isinstance(rotation, int | float) else list(rotation)
    for angle in targets:
        if not math.isfinite(angle):
            raise InvalidParameter("rotation", angle, "a finite number [rad]")
    require_count("increments", increments, 1)
    require_choice("method", method, METHODS)
    origin = 0.0 if start is None else float(start.rotation[-1])
    largest = max((abs(angle) for angle in (origin, *targets)), default=0.0)
    turns = np.abs(np.diff([origin, *targets]))
    if largest < LEAST_ROTATION or ((turns > 0.0) & (turns < LEAST_ROTATION)).any():
        raise InvalidParameter("rotation", rotation, "an angle other than zero [rad]")
    legs = [np.linspace(a, b, increments + 1)[1:] for a, b in zip([origin, *targets], targets, strict=False)]
    rotations = np.concatenate(legs)
    if accuracy is None:
        solution = _along(pivot, rotations, method, progress, start=start, branch=branch)
    else:
        check_accuracy(accuracy, pivot.mechanism.design)
        if start is not None or branch != "primary":
            raise InvalidParameter("accuracy", accuracy, "no start or branch beside it")
        solution = _accurate(pivot, rotations, method, accuracy)
        if progress is not None:
            progress(len(rotations), len(rotations))
    if raise_on_failure and solution.status is not Status.CONVERGED:
        raise ConvergenceError(
            solution.message,
            solution=solution,
            load_factor=abs(solution.rotation[-1] / targets[-1]) if targets[-1] else 0.0,
            history=solution.history,
        )
    return solution


def _along(
    pivot: Pivot,
    rotations: Array,
    method: str,
    progress: Progress | None = None,
    *,
    start: StaticSolution | None = None,
    branch: str = "primary",
) -> StaticSolution:
    """The solution through the rotations [rad]."""
    laps = Laps()
    largest = max(float(np.abs(rotations).max()), 0.0 if start is None else abs(float(start.rotation[-1])))
    system = compile_scene(pivot.driven(largest))
    path = None
    if method == "condensed" and branch == "primary" and start is None and is_fast(pivot.mechanism):
        path = follow_fast(pivot.mechanism, system, list(rotations), laps, progress)
    if path is None:  # also where the fast path stops: this one says why
        laps.lap("compile")
        begin = None if start is None else last_state(start, largest)
        path = follow(system, list(rotations / largest), progress, start=begin, branch=branch)
        laps.lap("solve")
    return _pivot_solution(system, path, laps)


def _accurate(pivot: Pivot, rotations: Array, method: str, accuracy: float) -> StaticSolution:
    """The solution with as many control points as the accuracy takes."""

    laps = Laps()

    def recovered(chosen: Pivot, answer: Answer) -> StaticSolution:
        laps.lap("solve")  # all trials
        system = compile_scene(chosen.driven(float(np.abs(rotations).max())))
        laps.lap("compile")
        path = path_of(chosen.mechanism, system, list(rotations), answer)
        return _along(chosen, rotations, method) if path is None else _pivot_solution(system, path, laps)

    return solve_accurately(
        pivot,
        rotations,
        accuracy,
        solve=lambda chosen: _along(chosen, rotations, method),
        recover=recovered if method == "condensed" and is_fast(pivot.mechanism) else None,
    )


def solve_from(
    pivot: Pivot, *, rotation: float, guess: Array, increments: int = 20, raise_on_failure: bool = True
) -> StaticSolution:
    """The state of the primary branch at a rotation [rad] from any guess of the unknowns (N,).

    ``message`` says whether the guess led there or the path from rest did, in ``increments``.
    A guess that leads elsewhere is never believed: see ``continuation.recover``.
    """
    require_count("increments", increments, 1)
    if not math.isfinite(rotation) or rotation == 0.0:
        raise InvalidParameter("rotation", rotation, "an angle other than zero [rad]")
    laps = Laps()
    system = compile_scene(pivot.driven(rotation))
    laps.lap("compile")
    path = recover(system, 1.0, np.asarray(guess, dtype=float), increments)
    laps.lap("solve")
    solution = _pivot_solution(system, path, laps)
    if raise_on_failure and path.status is not Status.CONVERGED:
        at = float(path.load_factor[-1])
        raise ConvergenceError(path.message, solution=solution, load_factor=at, history=path.history)
    return solution


def solve_path(
    mechanism: Mechanism,
    rotation: float,
    increments: int = 20,
    body: str | None = None,
    *,
    start: Path | MechanismSolution | None = None,
    branch: str = "primary",
) -> Path:
    """The states of the path to one rotation; raises ConvergenceError if it is not reached.

    start: a result with the same body driven to go on from; branch as in ``solve_loads``.
    """
    require_count("increments", increments, 1)
    system = compile_scene(mechanism.driven(rotation, body))
    laps, begin = Laps(), None
    if start is not None:  # its load factors are those of another rotation
        turn = system.layout.body(mechanism.design.body_named(body)).stop - 1
        begin = (float(start.states[-1, turn]) / rotation, start.states[-1])
    factors = np.linspace(0.0 if begin is None else begin[0], 1.0, increments + 1)[1:]
    path = follow(system, list(factors), start=begin, branch=branch)
    laps.lap("solve")
    if path.status is not Status.CONVERGED:
        raise ConvergenceError(
            path.message,
            solution=_mechanism_solution(system, path, mechanism, laps),
            load_factor=float(path.load_factor[-1]),
            history=path.history,
        )
    return path


def solve_loads(
    scene: Scene,
    *,
    increments: int = 20,
    end: float = 1.0,
    control: str = "load",
    branch: str = "primary",
    start: Path | MechanismSolution | None = None,
    progress: Progress | None = None,
) -> tuple[System, Path]:
    """A scene from rest to the load factor ``end``, all its loads and drives growing in proportion.

    control: "load" prescribes the load factors; "arc-length" follows the path through its limit
    points, with ``increments`` for the first step only. branch: "primary" or "follow" at a
    bifurcation. start: a result of the same scene to go on from, instead of rest.
    """
    require_count("increments", increments, 1)
    require_choice("control", control, CONTROLS)
    if not math.isfinite(end):
        raise InvalidParameter("end", end, "a finite load factor")
    system = compile_scene(scene)
    begin = None if start is None else last_state(start)
    if control == "arc-length":
        arc = follow_arc(system, end, increments=increments, start=begin, branch=branch, progress=progress)
        return system, arc
    factors = np.linspace(0.0 if begin is None else begin[0], end, increments + 1)[1:]
    return system, follow(system, list(factors), progress, start=begin, branch=branch)


def solve_mechanism(
    mechanism: Mechanism,
    *,
    body: str | None = None,
    rotation: float | None = None,
    increments: int = 20,
    control: str = "load",
    branch: str = "primary",
    start: MechanismSolution | None = None,
    end: float = 1.0,
    raise_on_failure: bool = True,
    progress: Progress | None = None,
) -> MechanismSolution:
    """Any mechanism from rest to load factor 1: its loads and drives grow in proportion.

    rotation [rad] drives the named body, or the only one; None leaves all bodies to the loads.
    control, branch, start and end as in ``solve_loads``.
    """
    laps = Laps()
    scene = mechanism.scene if rotation is None else mechanism.driven(rotation, body)
    system, path = solve_loads(
        scene,
        increments=increments,
        end=end,
        control=control,
        branch=branch,
        start=start,
        progress=progress,
    )
    laps.lap("solve")
    solution = _mechanism_solution(system, path, mechanism, laps)
    if raise_on_failure and path.status is not Status.CONVERGED:
        raise ConvergenceError(
            path.message,
            solution=solution,
            load_factor=float(path.load_factor[-1]),
            history=path.history,
        )
    return solution


def _mechanism_solution(system: System, path: Path, mechanism: Mechanism, laps: Laps) -> MechanismSolution:
    """The answer of a mechanism from the states of its path."""
    states, layout = path.states, system.layout
    torque = stiffness = np.full(len(states), np.nan)
    for i, drive in enumerate(system.scene.of(Constraint)):
        if isinstance(drive, DrivenRotation):
            row = layout.rows(i).start
            torque, stiffness = states[:, row], path.rates[:, row] / drive.angle
    along = [sections(system, states, strip.name, STATIONS) for strip in system.scene.strips]
    return MechanismSolution(
        status=path.status,
        message=path.message,
        load_factor=path.load_factor,
        bodies={body.name: states[:, layout.body(body.name)] for body in system.scene.bodies},
        torque=torque,
        stiffness=stiffness,
        bending_energy=path.energies[:, 0],
        axial_energy=path.energies[:, 1],
        gravity_energy=gravity_energy(system, states),
        work=path.work,
        stations=STATIONS,
        shape=np.stack([s.shape for s in along], axis=1),
        axial_force=np.stack([s.axial_force for s in along], axis=1),
        bending_moment=np.stack([s.bending_moment for s in along], axis=1),
        shear_force=np.stack([s.shear_force for s in along], axis=1),
        effects=tuple(name for name in mechanism.effects if name not in MOTION_ONLY),
        inertia=path.inertia,
        moment_defect=path.moment_defect,
        critical_points=path.critical_points,
        states=states,
        counters=path.counters,
        history=path.history,
        seconds=laps.lap("recover"),
    )


def _pivot_solution(system: System, path: Path, laps: Laps) -> StaticSolution:
    """The pivot's answer from the states of its path."""
    states, layout = path.states, system.layout
    body = states[:, layout.body(BODY)]
    constraints = system.scene.of(Constraint)
    i, drive = next((i, c) for i, c in enumerate(constraints) if isinstance(c, DrivenRotation))
    row = layout.rows(i).start
    along = [sections(system, states, name, STATIONS) for name in STRIPS]
    reactions = [[clamp_reactions(system, states, name, end) for end in ("start", "end")] for name in STRIPS]
    return StaticSolution(
        status=path.status,
        message=path.message,
        rotation=path.load_factor * drive.angle,
        centre=body[:, :2],
        torque=states[:, row],
        stiffness=path.rates[:, row] / drive.angle,
        bending_energy=path.energies[:, 0],
        axial_energy=path.energies[:, 1],
        shear_energy=np.zeros(len(states)),
        gravity_energy=gravity_energy(system, states),
        work=path.work,
        clamp_reactions=np.moveaxis(np.array(reactions), 2, 0),
        stations=STATIONS,
        shape=np.stack([s.shape for s in along], axis=1),
        axial_force=np.stack([s.axial_force for s in along], axis=1),
        bending_moment=np.stack([s.bending_moment for s in along], axis=1),
        shear_force=np.stack([s.shear_force for s in along], axis=1),
        inertia=path.inertia,
        moment_defect=path.moment_defect,
        critical_points=path.critical_points,
        states=states,
        counters=path.counters,
        history=path.history,
        seconds=laps.lap("recover"),
    )
