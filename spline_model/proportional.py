"""Any mechanism or scene under loads and drives that grow in proportion."""

from __future__ import annotations

import math

import numpy as np

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
from spline_model.scene import Scene
from spline_model.solution import MechanismSolution, Path, Status
from spline_model.static_answers import mechanism_answer

CONTROLS = ("load", "arc-length")


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
        if rotation == 0.0:
            raise InvalidParameter("rotation", rotation, "an angle other than zero [rad] to go on to")
        turn = system.layout.body(mechanism.design.body_named(body)).stop - 1
        begin = (float(start.states[-1, turn]) / rotation, start.states[-1])
        if begin[0] < 0.0 and system.tables.loads.value.any():
            raise InvalidParameter("start", "a body turned the other way", "rotation's side, under loads")
    factors = np.linspace(0.0 if begin is None else begin[0], 1.0, increments + 1)[1:]
    path = follow(system, list(factors), start=begin, branch=branch)
    laps.lap("solve")
    if path.status is not Status.CONVERGED:
        raise ConvergenceError(
            path.message,
            solution=mechanism_answer(system, path, mechanism, laps),
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
    if rotation is not None:
        require_finite("rotation", rotation, "rad")
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
    solution = mechanism_answer(system, path, mechanism, laps)
    if raise_on_failure and path.status is not Status.CONVERGED:
        raise ConvergenceError(
            path.message,
            solution=solution,
            load_factor=float(path.load_factor[-1]),
            history=path.history,
        )
    return solution
