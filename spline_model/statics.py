"""Statics: a pivot under a driven rotation, a scene under growing loads (Eq 19)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from spline_model.accuracy import DOUBTFUL, settled, solve_accurately, wanted
from spline_model.compile import System, compile_scene
from spline_model.continuation.follower import equilibrium
from spline_model.errors import InvalidParameter, finite_numbers, require_choice, require_count
from spline_model.newton import Laps
from spline_model.path import Progress, follow
from spline_model.pivot import Pivot
from spline_model.proportional import (
    CONTROLS,
    LOADS_FIRST,
    ORDERS,
    TOGETHER,
    follow_loads_first,
    follow_rotations,
    has_loads,
    solve_loads,
    solve_mechanism,
)
from spline_model.reduced.elements import followed
from spline_model.sections import STATIONS
from spline_model.solution import Path, Status
from spline_model.static_answers import StaticSolution

__all__ = [
    "CONTROLS",
    "METHODS",
    "STATIONS",
    "solve_from",
    "solve_loads",
    "solve_mechanism",
    "solve_statics",
]

Array = NDArray[np.float64]

LEAST_ROTATION = 1e-12
"""Largest rotation of a path that is none [rad]: states are solved to 1e-11."""

METHODS = ("condensed", "multipliers")

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
    laps, design = Laps(), pivot.design
    origin = 0.0 if start is None else float(start.rotation[-1])
    rotations = _rotations(rotation, increments, origin)
    chosen = wanted(accuracy, design, start)

    def solve(control_points: int | None) -> StaticSolution:
        given = pivot.with_control_points(control_points)
        told = progress if chosen is None else None
        begin = None if start is None else (origin, float(start.load_factor[-1]), start.states[-1])
        how: dict[str, Any] = {"start": begin, "branch": branch, "method": method, "laps": laps}
        if order == TOGETHER or not rotations.any() or not has_loads(given.scene):
            system, path = follow_rotations(given.driven, rotations, told, **how)
        else:
            system, path = follow_loads_first(given.driven, rotations, increments, told, **how)
        return StaticSolution.of(system, path, given.effects, laps, balanced=chosen is not None)

    if chosen is None:
        solution = solve(settled(design, start))
    else:
        solution = solve_accurately(design, chosen, solve, least=DOUBTFUL if accuracy is None else None)
        if progress is not None:
            progress(len(rotations), len(rotations))
    return solution.checked(raise_on_failure)


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
