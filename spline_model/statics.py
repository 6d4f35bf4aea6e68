"""Statics: a pivot under a driven rotation, any mechanism or scene under loads and drives (Eq 19)."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from spline_model.accuracy import answered
from spline_model.confirmed import Grid
from spline_model.effects import Driven
from spline_model.effects.base import Constraint, Load
from spline_model.errors import (
    InvalidParameter,
    finite_numbers,
    require_choice,
    require_count,
    require_finite,
)
from spline_model.legs import LOADS_FIRST, ORDERS, follow_legs, growing, turning
from spline_model.mechanism import Mechanism, require_mechanism
from spline_model.newton import Laps
from spline_model.path import Progress, follow_arc
from spline_model.pivot import Pivot
from spline_model.rigid import require_unborne
from spline_model.static_answers import StaticSolution

Array = NDArray[np.float64]

LEAST_ROTATION = 1e-12
"""Largest rotation of a path that is none [rad]: states are solved to 1e-11."""

METHODS = ("condensed", "multipliers")
CONTROLS = ("load", "arc-length")


def solve_statics(
    pivot: Pivot,
    *,
    rotation: float | Sequence[float],
    increments: int = 20,
    order: str = LOADS_FIRST,
    method: str = "condensed",
    accuracy: float | None = None,
    branch: str = "primary",
    check: bool = True,
    raise_on_failure: bool = True,
    progress: Progress | None = None,
) -> StaticSolution:
    """Drive the pivot's body from 0 to ``rotation`` [rad] in equal increments.

    A sequence of rotations is a path from one to the next (there and back), each leg in
    ``increments``. order: "loads first" raises loads in ``increments`` with the body held, and then they
    stay; "together", and so always with driven displacements, lets them grow with |rotation| over the
    largest one of the path. With rotation 0 the body is held and they grow from 0
    to 1; without any all states are that at rest.
    method: "condensed" runs compiled with the clamps solved and the strips
    condensed, where the scene allows it; "multipliers" is the paper's bordered system. Both
    agree to 1e-10. accuracy: wanted error over the whole path of all that ``ErrorEstimate`` has,
    relative [1]; the control points are raised from the pivot's until the estimated one is
    below, axial modes and quadrature with them, and the solution has its ``estimate``. Default: 1e-4
    of a pivot without a number of control points, else just its number.
    branch: "primary" or "follow" at a bifurcation. check: whether critical points and an early end of a given
    number of control points are compared with those of more, and what is not confirmed is not resolved (see
    ``spline_model.confirmed``). Raises ConvergenceError with the converged part of the path, or with the
    best one where the accuracy is not reached; returns it as a status with ``raise_on_failure=False``.
    """
    finite_numbers("rotation", rotation, "rad")  # a pivot is always driven
    return solve_mechanism(
        pivot,
        rotation=rotation,
        increments=increments,
        order=order,
        method=method,
        branch=branch,
        accuracy=accuracy,
        check=check,
        raise_on_failure=raise_on_failure,
        progress=progress,
    )


def solve_mechanism(
    mechanism: Mechanism,
    *,
    body: str | None = None,
    rotation: float | Sequence[float] | None = None,
    increments: int = 20,
    order: str = LOADS_FIRST,
    method: str = "condensed",
    control: str = "load",
    branch: str = "primary",
    end: float = 1.0,
    accuracy: float | None = None,
    starts: bool = False,
    check: bool = True,
    raise_on_failure: bool = True,
    progress: Progress | None = None,
) -> StaticSolution:
    """Any mechanism from rest to load factor 1: its loads and drives grow in proportion.

    rotation [rad] drives the named body, or the only one; None leaves all bodies to the loads. rotation,
    order, method and branch as in ``solve_statics``; with control "arc-length" or another ``end``, the last
    load factor, loads and the last rotation grow together. control: "load" prescribes the load factors;
    "arc-length" follows the path through its limit points, with ``increments`` for the first step only.
    accuracy and check as in ``solve_statics``, with control "arc-length" of the state at the end. starts:
    whether a motion starts at the end, until which rigid motions that nothing holds are held, whatever that
    takes; else a load along one raises InvalidParameter.
    """
    require_mechanism(mechanism)
    require_count("increments", increments, 1)
    require_choice("method", method, METHODS)
    require_choice("order", order, ORDERS)
    require_choice("control", control, CONTROLS)
    require_finite("end", end, "load factor")
    laps, turned = Laps(), rotation is not None and control == "load" and end == 1.0
    rotations = np.zeros(0) if rotation is None else _rotations(rotation, increments)

    def solve(grid: Grid, told: Progress | None, balanced: bool) -> StaticSolution:
        given = mechanism.on(*grid).propped(rotation is not None, body)
        if turned:
            legs = turning(partial(given.driven, body=body), rotations, increments, order)
        else:
            scene = given.driven(float(rotations[-1]), body) if rotations.size else given.scene
            legs = [growing(scene, increments, end)]
        system = legs[0].system
        laps.lap("compile")
        if control == "arc-length":
            path = follow_arc(system, end, increments=increments, branch=branch, progress=told, method=method)
        else:
            path = follow_legs(legs, branch, method, told)
        laps.lap("solve")
        if not starts:
            require_unborne(system, path.reactions)
        return StaticSolution.of(system, path, given.effects, laps, balanced=balanced, asked=body)

    solution = answered(mechanism.design, accuracy, solve, progress, rotations.size or increments, check)
    return solution.checked(raise_on_failure)


def _rotations(rotation: float | Sequence[float], increments: int) -> Array:
    """The rotations [rad] of a path from 0 on, each leg in ``increments``."""
    targets = finite_numbers("rotation", rotation, "rad")
    legs = list(pairwise([0.0, *targets]))
    largest = max(map(abs, targets))
    if 0.0 < largest < LEAST_ROTATION or any(0.0 < abs(b - a) < LEAST_ROTATION for a, b in legs):
        raise InvalidParameter("rotation", rotation, f"0, or legs of {LEAST_ROTATION:g} [rad] or more")
    return np.array([b - (b - a) * left / increments for a, b in legs for left in range(increments)[::-1]])


def static_state(
    mechanism: Mechanism,
    rotation: float | None = None,
    increments: int = 20,
    body: str | None = None,
    *,
    starts: bool = False,
) -> Array:
    """The unknowns z of the released scene in equilibrium, and last the torque of a drive.

    The rotation [rad] of a body is driven; None drives none. Loads, driven displacements, weight and
    pre-strain act in full; the multipliers of displacements that let go are left out. starts: as in
    ``solve_mechanism``.
    """
    mechanism = mechanism.propped(rotation is not None, body)
    z = settle(mechanism, rotation, increments, body, starts=starts).states[-1]
    driven = mechanism.scene if rotation is None else mechanism.driven(rotation, body)
    layout = driven.layout
    constraints = enumerate(driven.of(Constraint))
    kept = [i for i, each in constraints if not (isinstance(each, Driven) and (each.prop or each.lets_go))]
    return np.concatenate((z[: layout.multiplier_start], *(z[layout.rows(i)] for i in kept)))


def settle(
    mechanism: Mechanism,
    rotation: float | None,
    increments: int = 20,
    body: str | None = None,
    *,
    starts: bool = False,
) -> StaticSolution:
    """The path to that state, with the mechanism's own control points."""
    grid = mechanism.design.discretisation
    grown = rotation is not None or bool(mechanism.scene.of(Load) or mechanism.scene.of(Driven))
    return solve_mechanism(
        mechanism.on(grid.segments, grid.points),
        rotation=rotation,
        increments=increments if grown else 1,
        body=body,
        starts=starts,
        check=grown,
    )
