"""Statics: a pivot under a driven rotation, any mechanism or scene under loads and drives (Eq 19)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from spline_model.accuracy import answered
from spline_model.compile import System, compile_scene
from spline_model.confirmed import Grid
from spline_model.effects import AppliedLoad, Driven
from spline_model.effects.base import Constraint, Load
from spline_model.effects.registry import MOTION_ONLY
from spline_model.errors import (
    InvalidParameter,
    finite_numbers,
    require_choice,
    require_count,
    require_finite,
)
from spline_model.mechanism import Mechanism, require_mechanism
from spline_model.newton import Laps
from spline_model.path import follow, follow_arc
from spline_model.rigid import require_unborne
from spline_model.scene import Scene
from spline_model.solution import Status
from spline_model.static_answers import StaticSolution
from spline_model.tables import LoadTable

Array = NDArray[np.float64]

LEAST_ROTATION = 1e-12
"""Largest rotation of a path that is none [rad]: states are solved to 1e-11."""

LOADS_FIRST, TOGETHER = ORDERS = ("loads first", "together")
METHODS = ("condensed", "multipliers")
CONTROLS = ("load", "arc-length")


def solve_statics(
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
) -> StaticSolution:
    """Solve a mechanism from rest to load factor 1: its loads and drives grow in proportion.

    Parameters
    ----------
    mechanism : Mechanism
    body : str, default None
        Rotated and reported body; None is the only one.
    rotation : float or sequence of float, rad, default None
        Prescribed rotation; None leaves all bodies to the loads.
    increments : int, default 20
        Increments of each leg, or of the loads.
    order : str
        "loads first" (default) raises loads with the body held, then they are constant. "together", and
        always with driven displacements, raises them with abs(rotation) over the largest one of the path.
        With rotation 0 the body is held and the loads grow from 0 to 1.
    method : str
        "condensed" (default) is compiled; clamps are solved and strips condensed, where the scene allows it.
        "multipliers" is the bordered system of the paper. Both agree to 1e-10.
    control : str
        "load" (default) prescribes the load factors. "arc-length" follows the path through limit points;
        then `increments` is for the first step only.
    branch : str
        "primary" (default), or "follow" the other path at a bifurcation.
    end : float, 1, default 1
        Last load factor. With another one, or with "arc-length", loads and the last rotation grow together.
    accuracy : float, 1, default None
        Wanted relative error over the path of all quantities of ``spline_model.solution.ErrorEstimate``, with
        "arc-length" that of the last state. Control points, axial modes and quadrature are raised until the
        estimate is below it. Default: 1e-4 for a pivot without a number of control points, else no estimate.
    starts : bool, default False
        A motion starts at the end: rigid motions that nothing holds are held until then. Otherwise a load
        along one raises InvalidParameter.
    check : bool, default True
        Confirm critical points and an early end by more control points (``spline_model.confirmed``).
    raise_on_failure : bool, default True
        Raise an error for a path that ends early, or return it with its status.

    Returns
    -------
    StaticSolution
        S states, the unloaded state first: rotation (S,), torque (S,), stiffness (S,), centre (S, 2), ...

    Raises
    ------
    InvalidParameter
        A value outside its range, or a load along a free rigid motion.
    ConvergenceError
        The path ended early, or the accuracy was not reached; the error has the converged part.

    References
    ----------
    Valentini and Pezzuti (2013), Eq 11, for the bordered system; Riks, Journal of Applied Mechanics 39 (1972)
    1060, for the arc length.

    Examples
    --------
    With ``pivot`` of the example of ``spline_model.pivot.cross_axis_pivot``:

    >>> path = solve_statics(pivot, rotation=0.3, increments=5)
    >>> print(f"{path.torque[-1]:.4f} N m")
    0.1633 N m
    >>> solve_statics(pivot, rotation=[0.1, 0.0], increments=2).rotation.round(3).tolist()
    [0.0, 0.05, 0.1, 0.05, 0.0]
    """
    require_mechanism(mechanism)
    require_count("increments", increments, 1)
    require_choice("method", method, METHODS)
    require_choice("order", order, ORDERS)
    require_choice("control", control, CONTROLS)
    require_finite("end", end, "load factor")
    laps, turned = Laps(), rotation is not None and control == "load" and end == 1.0
    rotations = [] if rotation is None else _rotations(rotation, increments)

    def solve(grid: Grid, balanced: bool) -> StaticSolution:
        given = mechanism.on(*grid).propped(rotation is not None, body)
        if turned:
            legs = _turning(partial(given.system, body=body), rotations, increments, order)
        else:
            driven = rotations[-1] if rotations else None
            legs = [_growing(given.system(driven, body), increments, end)]
        system = legs[0].system
        laps.lap("compile")
        if control == "arc-length":
            path = follow_arc(system, end, increments=increments, branch=branch, method=method)
        else:
            path = _follow(legs, branch, method)
        laps.lap("solve")
        if not starts:
            require_unborne(system, path.reactions)
        return replace(
            path,
            reactions=path.reactions[:, system.prescribed],
            effects=tuple(name for name in given.effects if name not in MOTION_ONLY),
            balanced=balanced,
            asked=body,
            seconds=laps.lap("recover"),
        )

    way = 1.0 + abs(end) + sum(abs(b - a) for a, b in pairwise([0.0, *rotations]))
    return answered(mechanism.design, accuracy, solve, way, check).checked(raise_on_failure)


def _rotations(rotation: float | Sequence[float], increments: int) -> list[float]:
    """The rotations [rad] of a path from 0 on, each leg in ``increments``."""
    targets = finite_numbers("rotation", rotation, "rad")
    legs = list(pairwise([0.0, *targets]))
    largest = max(map(abs, targets))
    if 0.0 < largest < LEAST_ROTATION or any(0.0 < abs(b - a) < LEAST_ROTATION for a, b in legs):
        raise InvalidParameter("rotation", rotation, f"0, or legs of {LEAST_ROTATION:g} [rad] or more")
    return [b - (b - a) * left / increments for a, b in legs for left in range(increments)[::-1]]


class _Leg(NamedTuple):
    """A part of a path: a system that is followed through load factors.

    steady: loads that act in full all along it, whatever its own load factor.
    """

    system: System
    factors: list[float]
    steady: LoadTable | None = None


def has_loads(scene: Scene) -> bool:
    """Whether loads act that may come on first: beside a driven displacement all grow together."""
    return bool(scene.of(Load)) and not any(drive.moves for drive in scene.of(Driven) if drive.beside)


def steady(scene: Scene) -> Scene:
    """Return the scene with loads and driven displacements in full at any load factor."""
    effects = (
        replace(e, steady=True) if isinstance(e, AppliedLoad) or (isinstance(e, Driven) and e.beside) else e
        for e in scene.effects
    )
    return replace(scene, effects=tuple(effects))


def _growing(system: System, increments: int, end: float = 1.0) -> _Leg:
    """Return the leg on which all loads and drives of a system grow from 0 to the load factor ``end`` [1]."""
    return _Leg(system, np.linspace(0.0, end, increments + 1)[1:].tolist())


def _turning(
    driven: Callable[[float], System], rotations: Sequence[float], increments: int, order: str
) -> list[_Leg]:
    """Return the legs of a body that is turned through R rotations [rad] under the loads of its scene.

    driven: the system that is driven to a rotation; increments: those of the loads where they come on first.
    Without any rotation loads grow from 0 to 1.

    Raises
    ------
    InvalidParameter
        Rotations to both sides, while loads or displacements grow with their size.
    """
    largest = max(rotations, key=abs)
    if largest == 0.0:
        return [_growing(driven(0.0), len(rotations))]
    whole, factors = driven(largest), [rotation / largest for rotation in rotations]
    if order == LOADS_FIRST and has_loads(whole.scene):
        first = _growing(driven(0.0), increments)
        return [first, _Leg(compile_scene(steady(whole.scene)), factors, steady=first.system.loads)]
    grows = whole.acting.value.any() or np.count_nonzero(whole.drives.target) > 1
    if grows and min(factors) < 0.0:
        told = [round(end, 6) for end in (min(rotations), max(rotations))]
        expected = "turns to one side of rest [rad], with which loads and displacements grow"
        raise InvalidParameter("rotation", told, expected)
    return [_Leg(whole, factors)]


def _follow(legs: Sequence[_Leg], branch: str, method: str) -> StaticSolution:
    """Return the path through all legs, each from where the one before ends; branch and method as in
    ``follow``."""
    path = None
    for leg in legs:
        start = None if path is None else path.states[-1]
        part = follow(leg.system, leg.factors, start=start, branch=branch, method=method)
        if part.critical_points:
            branch = "primary"  # the branch was left, or there was none to follow
        if leg.steady is not None:
            part = _loaded(part, leg.steady)
        path = part if path is None else path.followed_by(part)
        if path.status is not Status.CONVERGED:
            break
    assert path is not None, "there is a leg"
    return path


def _loaded(path: StaticSolution, loads: LoadTable) -> StaticSolution:
    """A path along which loads act in full: its load factor is theirs, and their work is in its own."""
    moved = (path.states - path.states[0])[:, loads.coordinate] @ loads.value
    points = tuple(replace(point, load_factor=1.0) for point in path.critical_points)
    return replace(path, load_factor=np.ones(len(path.work)), work=path.work + moved, critical_points=points)


def static_state(
    mechanism: Mechanism,
    rotation: float | None = None,
    increments: int = 20,
    body: str | None = None,
    *,
    starts: bool = False,
) -> Array:
    """Return the unknowns z (N,) [m, rad, N] of the released scene in equilibrium, and last the drive's
    torque.

    The rotation [rad] of a body is driven; None drives none. Loads, driven displacements, weight and
    pre-strain act in full; the multipliers of released displacements are excluded. starts: as in
    ``solve_statics``.
    """
    path = settle(mechanism, rotation, increments, body, starts=starts)
    z, scene = path.states[-1], path.system.scene
    held = enumerate(scene.of(Constraint))
    kept = [i for i, each in held if not (isinstance(each, Driven) and (each.prop or each.lets_go))]
    return np.concatenate((z[: scene.layout.multiplier_start], *(z[scene.layout.rows(i)] for i in kept)))


def settle(
    mechanism: Mechanism,
    rotation: float | None,
    increments: int = 20,
    body: str | None = None,
    *,
    starts: bool = False,
) -> StaticSolution:
    """Return the path to that state at a rotation [rad], with the mechanism's own control points."""
    grid = mechanism.design.discretisation
    grown = rotation is not None or bool(mechanism.scene.of(Load) or mechanism.scene.of(Driven))
    return solve_statics(
        mechanism.on(grid.segments, grid.points),
        rotation=rotation,
        increments=increments if grown else 1,
        body=body,
        starts=starts,
        check=grown,
    )
