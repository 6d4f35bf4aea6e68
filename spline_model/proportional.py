"""Any mechanism or scene under loads and drives that grow in proportion."""

from __future__ import annotations

import math
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from spline_model.accuracy import DOUBTFUL, settled, solve_accurately, wanted
from spline_model.compile import System, compile_scene
from spline_model.continuation.arc_length import follow_arc
from spline_model.errors import InvalidParameter, require_choice, require_count, require_finite
from spline_model.mechanism import Mechanism
from spline_model.newton import Laps
from spline_model.path import Progress, follow
from spline_model.rotations import LOADS_FIRST, ORDERS, follow_loads_first, has_loads
from spline_model.scene import Scene
from spline_model.solution import Path, StaticSolution
from spline_model.static_answers import checked, static_answer

Array = NDArray[np.float64]

CONTROLS = ("load", "arc-length")


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
    begin = None if start is None else (float(start.load_factor[-1]), start.states[-1])
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
    require_count("increments", increments, 1)
    laps, design = Laps(), mechanism.design
    chosen = wanted(accuracy, design, start)
    require_choice("order", order, ORDERS)
    first = order == LOADS_FIRST and control == "load" and end == 1.0

    def solve(control_points: int | None) -> StaticSolution:
        given = mechanism.with_control_points(control_points)
        told = progress if chosen is None else None
        if first and rotation and has_loads(given.scene):
            begin = None
            if start is not None:
                turned = float(start.bodies[body or design.body_named(body)][-1, 2])
                begin = turned, float(start.load_factor[-1]), start.states[-1]
            drive = partial(given.driven, body=body)
            turns = np.linspace(0.0 if begin is None else begin[0], rotation, increments + 1)[1:]
            how: dict[str, Any] = {"start": begin, "branch": branch, "laps": laps}
            system, path, _ = follow_loads_first(drive, turns, increments, told, **how)
        else:
            scene = given.scene if rotation is None else given.driven(rotation, body)
            how = {"end": end, "control": control, "branch": branch, "start": start, "progress": told}
            system, path = solve_loads(scene, increments=increments, **how)
            laps.lap("solve")
        return static_answer(system, path, given.effects, laps, balanced=chosen is not None)

    if chosen is None:
        solution = solve(settled(design, start))
    else:
        solution = solve_accurately(design, chosen, solve, least=DOUBTFUL if accuracy is None else None)
        if progress is not None:
            progress(increments, increments)
    return checked(solution, raise_on_failure)
