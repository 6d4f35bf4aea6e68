"""Statics: a pivot under a driven rotation, any mechanism or scene under loads and drives (Eq 19)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from spline_model.accuracy import answered
from spline_model.compile import System, compile_scene
from spline_model.continuation.arc_length import follow_arc
from spline_model.continuation.follower import equilibrium
from spline_model.errors import (
    InvalidParameter,
    finite_numbers,
    require_choice,
    require_count,
    require_finite,
)
from spline_model.mechanism import Mechanism
from spline_model.newton import Laps
from spline_model.path import Progress, follow
from spline_model.pivot import Pivot
from spline_model.proportional import LOADS_FIRST, ORDERS, TOGETHER, Turn, has_loads
from spline_model.reduced.elements import followed
from spline_model.scene import Scene
from spline_model.solution import Path, Status
from spline_model.static_answers import StaticSolution

Array = NDArray[np.float64]

LEAST_ROTATION = 1e-12
"""Largest rotation of a path that is none [rad]: states are solved to 1e-11."""

METHODS = ("condensed", "multipliers")
CONTROLS = ("load", "arc-length")

HOME = 1e-6
"""Distance from rest at which a path has come home, in lengths of a strip and rad."""


def solve_statics(
    pivot: Pivot,
    *,
    rotation: float | Sequence[float],
    increments: int = 20,
    order: str = LOADS_FIRST,
    method: str = "condensed",
    accuracy: float | None = None,
    branch: str = "primary",
    start: StaticSolution | None = None,
    raise_on_failure: bool = True,
    progress: Progress | None = None,
) -> StaticSolution:
    """Drive the pivot's body from 0 to ``rotation`` [rad] in equal increments.

    A sequence of rotations is a path from one to the next (there and back), each leg in
    ``increments``. order: "loads first" raises loads in ``increments`` with the body held, and then they
    stay; "together", and so always with driven displacements, lets them grow with |rotation| over the
    largest one of the path, its start's included. With rotation 0 the body is held and they grow from 0
    to 1; without any all states are that at rest.
    method: "condensed" runs compiled with the clamps solved and the strips
    condensed, where the scene allows it; "multipliers" is the paper's bordered system. Both
    agree to 1e-10. accuracy: wanted error over the whole path of all that ``ErrorEstimate`` has,
    relative [1]; the control points are raised from the pivot's until the estimated one is
    below, axial modes and quadrature with them, and the solution has its ``estimate``. Default: 1e-4
    of a pivot without a number of control points, else just its number.
    branch: "primary" or "follow" at a bifurcation; start: a solution of the same
    pivot to go on from with its control points, instead of rest; without an accuracy. Raises
    ConvergenceError with the converged part of the path, or with the best one
    where the accuracy is not reached; returns it as a status with ``raise_on_failure=False``.
    """
    require_count("increments", increments, 1)
    require_choice("method", method, METHODS)
    require_choice("order", order, ORDERS)
    laps, origin = Laps(), 0.0 if start is None else float(start.rotation[-1])
    rotations = _rotations(rotation, increments, origin)
    begin = None if start is None else (origin, float(start.load_factor[-1]), start.states[-1])

    def solve(control_points: int | None, told: Progress | None, balanced: bool) -> StaticSolution:
        given = pivot.with_control_points(control_points)
        turn = Turn(
            driven=given.driven,
            rotations=rotations,
            increments=increments,
            laps=laps,
            progress=told,
            start=begin,
            branch=branch,
            method=method,
        )
        together = order == TOGETHER or not rotations.any() or not has_loads(given.scene)
        system, path = turn.together() if together else turn.loads_first()
        return StaticSolution.of(system, path, given.effects, laps, balanced=balanced)

    solution = answered(pivot.design, accuracy, solve, start, progress, len(rotations))
    return solution.checked(raise_on_failure)


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
    both meet, "loads first" as in ``solve_statics``, which then stay, or "together"; so it is
    always with control "arc-length" or another ``end``. control, branch, start and end as in
    ``solve_loads``; accuracy as in ``solve_statics``, with control "arc-length" of the state at the
    end.
    """
    if rotation is not None:
        require_finite("rotation", rotation, "rad")
    require_count("increments", increments, 1)
    require_choice("order", order, ORDERS)
    laps, first = Laps(), order == LOADS_FIRST and control == "load" and end == 1.0

    def solve(control_points: int | None, told: Progress | None, balanced: bool) -> StaticSolution:
        given = mechanism.with_control_points(control_points)
        if first and rotation and has_loads(given.scene):
            begin, origin = None, 0.0
            if start is not None:
                origin = float(start.bodies[mechanism.design.body_named(body)][-1, 2])
                begin = origin, float(start.load_factor[-1]), start.states[-1]
            turns = np.linspace(origin, rotation, increments + 1)[1:]
            drive = partial(given.driven, body=body)
            turn = Turn(driven=drive, rotations=turns, increments=increments, laps=laps, progress=told)
            system, path = replace(turn, start=begin, branch=branch).loads_first()
        else:
            scene = given.scene if rotation is None else given.driven(rotation, body)
            how: dict[str, Any] = {"end": end, "control": control, "branch": branch, "start": start}
            system, path = solve_loads(scene, increments=increments, progress=told, **how)
            laps.lap("solve")
        return StaticSolution.of(system, path, given.effects, laps, balanced=balanced)

    solution = answered(mechanism.design, accuracy, solve, start, progress, increments)
    return solution.checked(raise_on_failure)


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


def _rotations(rotation: float | Sequence[float], increments: int, origin: float) -> Array:
    """The rotations of a path from ``origin`` [rad] on, each leg in ``increments``."""
    targets = finite_numbers("rotation", rotation, "rad")
    legs = list(pairwise([origin, *targets]))
    largest = max(abs(origin), *map(abs, targets))
    if 0.0 < largest < LEAST_ROTATION or any(0.0 < abs(b - a) < LEAST_ROTATION for a, b in legs):
        raise InvalidParameter("rotation", rotation, f"0, or legs of {LEAST_ROTATION:g} [rad] or more")
    return np.array([b - (b - a) * left / increments for a, b in legs for left in range(increments)[::-1]])


def solve_from(
    pivot: Pivot, *, rotation: float, guess: Array, increments: int = 20, raise_on_failure: bool = True
) -> StaticSolution:
    """The state of the primary branch at a rotation [rad] from any guess of the unknowns (N,).

    ``message`` says whether the guess led there or the path from rest did, in ``increments``.
    A guess that leads elsewhere is never believed: see ``_recover``.
    """
    require_count("increments", increments, 1)
    if not math.isfinite(rotation):
        raise InvalidParameter("rotation", rotation, "a finite angle [rad]")
    laps = Laps()
    system = compile_scene(pivot.driven(rotation))
    laps.lap("compile")
    path = _recover(system, 1.0, np.asarray(guess, dtype=float), increments)
    laps.lap("solve")
    return StaticSolution.of(system, path, pivot.effects, laps).checked(raise_on_failure)


def _recover(system: System, load_factor: float, guess: Array, increments: int) -> Path:
    """The state of the primary branch at a load factor, one state; ``message`` says how it was found.

    What Newton finds from the guess is believed if the path from there back to load factor
    0 ends at rest; a wound-up or snapped strip has equilibria too, and passes every local
    check. Otherwise the path is followed from rest. Raises InvalidParameter for a guess that
    is no vector of unknowns.
    """
    whole = np.linspace(0.0, load_factor, increments + 1)
    try:
        found = equilibrium(work := followed(system), load_factor, guess)
    except InvalidParameter as error:
        if np.shape(guess) != (system.layout.size,):
            raise
        reason = str(error.got)
    else:
        back = follow(system, list(whole[-2::-1]), start=(load_factor, work.unknowns(found.z)))
        reason = "it lies on another branch"
        if back.status is Status.CONVERGED and _is_rest(system, back.states[-1]):
            return _only(back, 0, "found from the given state")
    path = follow(system, list(whole[1:]))
    if path.status is not Status.CONVERGED:
        return path
    return _only(path, -1, f"solved from rest, the given state led nowhere ({reason})")


def _is_rest(system: System, z: Array) -> bool:
    rest = follow(system, []).states[0]
    count = system.layout.coordinate_count
    return bool(np.abs((z - rest)[:count] / system.scales.unit[:count]).max() < HOME)


def _only(path: Path, place: int, message: str) -> Path:
    """One state of a path."""
    at = place % len(path.work)
    return replace(path, message=message, **path.rows(slice(at, at + 1)))
