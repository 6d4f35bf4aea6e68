"""Statics: a pivot under a driven rotation, a scene under growing loads (Eq 19)."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from spline_model.accuracy import check_accuracy
from spline_model.accurate_path import solve_accurately
from spline_model.compile import System, compile_scene
from spline_model.effects import DrivenRotation
from spline_model.effects.base import Constraint
from spline_model.effects.registry import MOTION_ONLY
from spline_model.errors import ConvergenceError, InvalidParameter, require_choice, require_count
from spline_model.fast.path import Answer
from spline_model.fast.solve import follow_fast, is_fast, path_of
from spline_model.mechanism import Mechanism
from spline_model.path import follow
from spline_model.pivot import BODY, STRIPS, Pivot
from spline_model.scene import Scene
from spline_model.sections import clamp_reactions, sections
from spline_model.solution import MechanismSolution, Path, StaticSolution, Status
from spline_model.work import external_work, gravity_energy

STATIONS = np.linspace(0.0, 1.0, 61)
"""Where sections are recovered, reference arc length over L; both clamped ends are among them."""

METHODS = ("condensed", "multipliers")
Array = NDArray[np.float64]
Progress = Callable[[int, int], None]


def solve_statics(
    pivot: Pivot,
    *,
    rotation: float | Sequence[float],
    increments: int = 20,
    method: str = "condensed",
    accuracy: float | None = None,
    raise_on_failure: bool = True,
    progress: Progress | None = None,
) -> StaticSolution:
    """Drive the pivot's body from 0 to ``rotation`` [rad] in equal increments.

    A sequence of rotations is a path from one to the next (there and back), each leg in
    ``increments``. method: "condensed" runs compiled with the clamps solved and the strips
    condensed, where the scene allows it; "multipliers" is the paper's bordered system. Both
    agree to 1e-10. accuracy: wanted error of trajectory and torque over the whole path,
    relative [1]; the control points are raised from the pivot's until the estimated one is
    below, axial modes and quadrature with them, and the solution has its ``estimate``. Raises
    ConvergenceError with the converged part of the path, or with the best one where the
    accuracy is not reached; returns it as a status with ``raise_on_failure=False``.
    """
    targets = [rotation] if isinstance(rotation, int | float) else list(rotation)
    for angle in targets:
        if not math.isfinite(angle):
            raise InvalidParameter("rotation", angle, "a finite number [rad]")
    require_count("increments", increments, 1)
    require_choice("method", method, METHODS)
    largest = max((abs(angle) for angle in targets), default=0.0)
    if largest == 0.0:
        raise InvalidParameter("rotation", rotation, "an angle other than zero [rad]")
    legs = [np.linspace(a, b, increments + 1)[1:] for a, b in zip([0.0, *targets], targets, strict=False)]
    rotations = np.concatenate(legs)
    if accuracy is None:
        solution = _along(pivot, rotations, method, progress)
    else:
        check_accuracy(accuracy, pivot.mechanism.design)
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


def _along(pivot: Pivot, rotations: Array, method: str, progress: Progress | None) -> StaticSolution:
    """The solution through the rotations [rad]."""
    largest = float(np.abs(rotations).max())
    system = compile_scene(pivot.driven(largest))
    path = None
    if method == "condensed" and is_fast(pivot.mechanism):
        path = follow_fast(pivot.mechanism, system, list(rotations), progress)
    if path is None:  # also where the fast path stops: this one says why
        path = follow(system, list(rotations / largest), progress)
    return _pivot_solution(system, path)


def _accurate(pivot: Pivot, rotations: Array, method: str, accuracy: float) -> StaticSolution:
    """The solution with as many control points as the accuracy takes."""

    def recover(chosen: Pivot, answer: Answer) -> StaticSolution:
        system = compile_scene(chosen.driven(float(np.abs(rotations).max())))
        return _pivot_solution(system, path_of(chosen.mechanism.design, system, list(rotations), answer))

    return solve_accurately(
        pivot,
        rotations,
        accuracy,
        solve=lambda chosen: _along(chosen, rotations, method, None),
        recover=recover if method == "condensed" and is_fast(pivot.mechanism) else None,
    )


def solve_path(mechanism: Mechanism, rotation: float, increments: int = 20, body: str | None = None) -> Path:
    """The states of the path to one rotation; raises ConvergenceError if it is not reached."""
    require_count("increments", increments, 1)
    system = compile_scene(mechanism.driven(rotation, body))
    path = follow(system, list(np.linspace(0.0, 1.0, increments + 1)[1:]))
    if path.status is not Status.CONVERGED:
        raise ConvergenceError(
            path.message,
            solution=_mechanism_solution(system, path, mechanism),
            load_factor=float(path.load_factor[-1]),
            history=path.history,
        )
    return path


def solve_loads(
    scene: Scene, *, increments: int = 20, progress: Progress | None = None
) -> tuple[System, Path]:
    """A scene from rest to load factor 1, all its loads and drives growing in proportion."""
    require_count("increments", increments, 1)
    system = compile_scene(scene)
    return system, follow(system, list(np.linspace(0.0, 1.0, increments + 1)[1:]), progress)


def solve_mechanism(
    mechanism: Mechanism,
    *,
    body: str | None = None,
    rotation: float | None = None,
    increments: int = 20,
    raise_on_failure: bool = True,
    progress: Progress | None = None,
) -> MechanismSolution:
    """Any mechanism from rest to load factor 1: its loads and drives grow in proportion.

    rotation [rad] drives the named body, or the only one; None leaves all bodies to the loads.
    """
    scene = mechanism.scene if rotation is None else mechanism.driven(rotation, body)
    system, path = solve_loads(scene, increments=increments, progress=progress)
    solution = _mechanism_solution(system, path, mechanism)
    if raise_on_failure and path.status is not Status.CONVERGED:
        raise ConvergenceError(
            path.message,
            solution=solution,
            load_factor=float(path.load_factor[-1]),
            history=path.history,
        )
    return solution


def _mechanism_solution(system: System, path: Path, mechanism: Mechanism) -> MechanismSolution:
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
        work=external_work(system, path),
        stations=STATIONS,
        shape=np.stack([s.shape for s in along], axis=1),
        axial_force=np.stack([s.axial_force for s in along], axis=1),
        bending_moment=np.stack([s.bending_moment for s in along], axis=1),
        shear_force=np.stack([s.shear_force for s in along], axis=1),
        effects=tuple(name for name in mechanism.effects if name not in MOTION_ONLY),
        counters=path.counters,
        history=path.history,
    )


def _pivot_solution(system: System, path: Path) -> StaticSolution:
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
        work=external_work(system, path),
        clamp_reactions=np.moveaxis(np.array(reactions), 2, 0),
        stations=STATIONS,
        shape=np.stack([s.shape for s in along], axis=1),
        axial_force=np.stack([s.axial_force for s in along], axis=1),
        bending_moment=np.stack([s.bending_moment for s in along], axis=1),
        shear_force=np.stack([s.shear_force for s in along], axis=1),
        counters=path.counters,
        history=path.history,
    )
