"""Any mechanism or scene under loads and drives that grow in proportion."""

from __future__ import annotations

import math
from functools import partial

import numpy as np
from numpy.typing import NDArray

from spline_model.accuracy import DOUBTFUL, settled, wanted
from spline_model.accurate_path import solve_accurately
from spline_model.compile import System, compile_scene
from spline_model.continuation.arc_length import follow_arc
from spline_model.continuation.start import last_state
from spline_model.errors import (
    ConvergenceError,
    InvalidParameter,
    require_choice,
    require_count,
    require_finite,
)
from spline_model.laps import Laps
from spline_model.mechanism import Mechanism
from spline_model.path import Progress, follow
from spline_model.rotations import LOADS_FIRST, ORDERS, follow_loads_first, has_loads
from spline_model.scene import Scene
from spline_model.solution import Path, StaticSolution, Status
from spline_model.static_answers import static_answer

Array = NDArray[np.float64]

CONTROLS = ("load", "arc-length")


def solve_path(
    mechanism: Mechanism,
    rotation: float,
    increments: int = 20,
    body: str | None = None,
    *,
    start: Path | StaticSolution | None = None,
    branch: str = "primary",
) -> Path:
    """The states of the path to one rotation; raises ConvergenceError if it is not reached.

    Loads come on before the rotation. start: a result with the same body driven to go on from; branch as in
    ``solve_loads``.
    """
    require_count("increments", increments, 1)
    system = compile_scene(mechanism.driven(rotation, body))
    laps, begin = Laps(), None
    if start is not None:  # its load factors are those of another rotation
        if rotation == 0.0:
            raise InvalidParameter("rotation", rotation, "an angle other than zero [rad] to go on to")
        turn = system.layout.body(mechanism.design.body_named(body)).stop - 1
        begin = (float(start.states[-1, turn]) / rotation, start.states[-1])
        if begin[0] < 0.0 and system.loads.value.any():
            raise InvalidParameter("start", "a body turned the other way", "rotation's side, under loads")
    if rotation and start is None and has_loads(system.scene):
        turns = _rotations(rotation, increments, None)
        drive = partial(mechanism.driven, body=body)
        _, path, _ = follow_loads_first(drive, turns, increments, branch=branch, laps=laps)
    else:
        factors = np.linspace(0.0 if begin is None else begin[0], 1.0, increments + 1)[1:]
        path = follow(system, list(factors), start=begin, branch=branch)
    laps.lap("solve")
    if path.status is not Status.CONVERGED:
        raise ConvergenceError(
            path.message,
            solution=static_answer(system, path, mechanism.effects, laps),
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
    start: Path | StaticSolution | None = None,
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


def _begun(start: StaticSolution, body: str) -> tuple[float, float, Array]:
    """Rotation [rad], load factor and unknowns where a result ended."""
    return float(start.bodies[body][-1, 2]), float(start.load_factor[-1]), start.states[-1]


def _rotations(rotation: float, increments: int, begin: tuple[float, float, Array] | None) -> Array:
    """The rotations of a leg [rad], in equal increments."""
    return np.linspace(0.0 if begin is None else begin[0], rotation, increments + 1)[1:]


def solve_mechanism(
    mechanism: Mechanism,
    *,
    body: str | None = None,
    rotation: float | None = None,
    increments: int = 20,
    order: str = LOADS_FIRST,
    control: str = "load",
    branch: str = "primary",
    start: StaticSolution | None = None,
    end: float = 1.0,
    accuracy: float | None = None,
    raise_on_failure: bool = True,
    progress: Progress | None = None,
) -> StaticSolution:
    """Any mechanism from rest to load factor 1: its loads and drives grow in proportion.

    rotation [rad] drives the named body, or the only one; None leaves all bodies to the loads. order: where
    both meet, "loads first" as in ``statics.solve_statics``, which then stay, or "together"; so it is
    always with control "arc-length" or another ``end``. control, branch, start and end as in
    ``solve_loads``; accuracy as in ``statics.solve_statics``, with control "arc-length" of the state at the
    end.
    """
    if rotation is not None:
        require_finite("rotation", rotation, "rad")
    laps, design = Laps(), mechanism.design
    chosen = wanted(accuracy, design, start)
    require_choice("order", order, ORDERS)
    first = order == LOADS_FIRST and control == "load" and end == 1.0

    def solve(control_points: int | None) -> StaticSolution:
        given = mechanism.with_control_points(control_points)
        told = progress if chosen is None else None
        if first and rotation and has_loads(given.scene):
            begin = None if start is None else _begun(start, body or design.body_named(body))
            system, path, _ = follow_loads_first(
                partial(given.driven, body=body),
                _rotations(rotation, increments, begin),
                increments,
                told,
                start=begin,
                branch=branch,
                laps=laps,
            )
            return static_answer(system, path, given.effects, laps, balanced=chosen is not None)
        system, path = solve_loads(
            given.scene if rotation is None else given.driven(rotation, body),
            increments=increments,
            end=end,
            control=control,
            branch=branch,
            start=start,
            progress=told,
        )
        laps.lap("solve")
        return static_answer(system, path, given.effects, laps, balanced=chosen is not None)

    if chosen is None:
        solution = solve(settled(design, start))
    else:
        solution = solve_accurately(design, chosen, solve, least=DOUBTFUL if accuracy is None else None)
        if progress is not None:
            progress(increments, increments)
    if raise_on_failure and solution.status is not Status.CONVERGED:
        raise ConvergenceError(
            solution.message,
            solution=solution,
            load_factor=float(solution.load_factor[-1]),
            history=solution.history,
        )
    return solution
