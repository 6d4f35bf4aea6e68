"""Any mechanism or scene under loads and drives that grow in proportion, or under loads and then a rotation.

Loads come on first, from rest to all of them with the body held, and stay as it turns; or together with the
rotation, in proportion to its size, whatever its sign.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from spline_model.accuracy import DOUBTFUL, settled, solve_accurately, wanted
from spline_model.compile import System, compile_scene
from spline_model.continuation.arc_length import follow_arc
from spline_model.effects import DrivenDisplacement
from spline_model.effects.base import Load
from spline_model.effects.boundary import Sized
from spline_model.errors import InvalidParameter, require_choice, require_count, require_finite
from spline_model.mechanism import Mechanism
from spline_model.newton import Laps
from spline_model.path import Progress, follow
from spline_model.scene import Scene
from spline_model.solution import BY_STATE, Later, Path, Status, joined
from spline_model.static_answers import StaticSolution

Array = NDArray[np.float64]

CONTROLS = ("load", "arc-length")
LOADS_FIRST, TOGETHER = ORDERS = ("loads first", "together")


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
            system, path = follow_loads_first(drive, turns, increments, told, **how)
        else:
            scene = given.scene if rotation is None else given.driven(rotation, body)
            how = {"end": end, "control": control, "branch": branch, "start": start, "progress": told}
            system, path = solve_loads(scene, increments=increments, **how)
            laps.lap("solve")
        return StaticSolution.of(system, path, given.effects, laps, balanced=chosen is not None)

    if chosen is None:
        solution = solve(settled(design, start))
    else:
        solution = solve_accurately(design, chosen, solve, least=DOUBTFUL if accuracy is None else None)
        if progress is not None:
            progress(increments, increments)
    return solution.checked(raise_on_failure)


def has_loads(scene: Scene) -> bool:
    """Whether loads act that may come on first: beside a driven displacement all grow together."""
    led = any(isinstance(effect, DrivenDisplacement) for effect in scene.effects)
    return not led and any(isinstance(effect, Load) for effect in scene.effects)


def follow_loads_first(
    driven: Callable[[float], Scene],
    rotations: Array,
    increments: int,
    progress: Progress | None = None,
    *,
    start: tuple[float, float, Array] | None = None,
    branch: str = "primary",
    method: str = "condensed",
    laps: Laps,
) -> tuple[System, Path]:
    """The scene and its path: loads in ``increments``, then the rotations [rad].

    driven: the scene that is driven to a rotation; start: rotation, load factor and unknowns (N,). The
    path's load factors are those of the loads, in critical points too.
    """
    largest, total = _largest_of(rotations, 0.0 if start is None else start[0]), increments + len(rotations)
    whole = compile_scene(driven(0.0))
    turned = compile_scene(_steady(driven(largest)))
    laps.lap("compile")
    before = None
    if start is None or (start[0] == 0.0 and start[1] < 1.0):
        begin = None if start is None else start[1:]
        factors = np.linspace(0.0 if begin is None else begin[0], 1.0, increments + 1)[1:]
        told = None if progress is None else _later(progress, 0, total)
        before = follow(whole, list(factors), told, start=begin, branch=branch, method=method)
        branch = "primary" if before.critical_points else branch
        if before.status is not Status.CONVERGED:
            laps.lap("solve")
            return whole, before
        start = 0.0, 1.0, before.states[-1]
    told = None if progress is None else _later(progress, increments if before else 0, total)
    at = start[0] / largest, start[2]
    after = follow(turned, list(rotations / largest), told, start=at, branch=branch, method=method)
    laps.lap("solve")
    loads = whole.loads
    moved = (after.states - after.states[0])[:, loads.coordinate] @ loads.value
    after = replace(
        after,
        load_factor=np.ones(len(after.work)),
        work=after.work + moved,
        critical_points=tuple(replace(point, load_factor=1.0) for point in after.critical_points),
    )
    return whole, after if before is None else _joined(before, after, back=False)


def _steady(scene: Scene) -> Scene:
    """The scene with loads and driven displacements in full at any load factor."""
    timed = Sized | DrivenDisplacement
    effects = (replace(e, steady=True) if isinstance(e, timed) else e for e in scene.effects)
    return replace(scene, effects=tuple(effects))


def _largest_of(rotations: Array, origin: float) -> float:
    """The rotation of largest size [rad], with its sign: there the loads act in full."""
    return float(max(*rotations.tolist(), origin, key=abs))


def follow_rotations(
    driven: Callable[[float], Scene],
    rotations: Array,
    progress: Progress | None = None,
    *,
    start: tuple[float, float, Array] | None = None,
    branch: str = "primary",
    method: str = "condensed",
    laps: Laps,
) -> tuple[System, Path]:
    """The scene driven to the largest of the rotations [rad], and its path through them, loads together.

    driven: the scene that is driven to a rotation. Where the body turns the other way the load factor is
    below zero and the loads still grow with its size: under loads that part is the path of the
    scene driven the other way, which begins where the other one has come back to rest. All rotations zero:
    loads grow from 0 to 1. start: rotation, load factor and unknowns (N,). laps: told when the scene is
    compiled and when the path is solved. The path's load factors are signed, critical points' are not.
    """
    largest, begun = _largest_of(rotations, 0.0 if start is None else start[0]), None
    factors = rotations / largest if largest else np.linspace(0.0, 1.0, len(rotations) + 1)[1:]
    if start is not None:
        begun = start[0] / largest if largest else start[1], start[2]
    path, done, back = None, 0, False
    whole = compile_scene(driven(largest))
    laps.lap("compile")
    for sign, part_factors, returns in _sides(whole, factors, 0.0 if begun is None else begun[0]):
        system = whole if sign > 0.0 else compile_scene(driven(-largest))
        begun = begun if path is None else (0.0, path.states[-1])
        aims = [sign * factor for factor in part_factors] + [0.0] * returns
        begin = None if begun is None else (sign * begun[0], begun[1])
        told = None if progress is None else _later(progress, done, len(factors))
        part = follow(system, aims, told, start=begin, branch=branch, method=method)
        if part.critical_points:
            branch = "primary"  # the branch was left, or there was none to follow
        if sign < 0.0:
            part = replace(part, load_factor=-part.load_factor)
        path = part if path is None else _joined(path, part, back)
        if path.status is not Status.CONVERGED:
            break
        done, back = done + len(part_factors), returns
    laps.lap("solve")
    assert path is not None, "a path has at least one rotation"
    points = tuple(replace(point, load_factor=abs(point.load_factor)) for point in path.critical_points)
    return whole, replace(path, critical_points=points) if points else path


def _sides(system: System, factors: Array, begin: float) -> list[tuple[float, list[float], bool]]:
    """Sign of a side of rest, factors there, and whether they come back to rest; all at once without loads.

    Zero is on the side of the start.
    """
    if not system.loads.value.any() and np.count_nonzero(system.drives.target) < 2:
        return [(1.0, factors.tolist(), False)]
    signs = np.sign(np.append(begin, factors))
    for i in range(1, len(signs)):
        signs[i] = signs[i] or signs[i - 1]
    first = signs[signs != 0.0][:1]
    signs[signs == 0.0] = first[0] if first.size else 1.0
    cuts = np.flatnonzero(np.diff(signs[1:])) + 1
    parts = np.split(factors, cuts)
    sides = [
        (float(signs[1 + at]), part.tolist(), bool(i < len(cuts) and part[-1] != 0.0))
        for i, (at, part) in enumerate(zip(np.append(0, cuts), parts, strict=True))
    ]
    if signs[0] != signs[1]:  # begun on the other side
        sides.insert(0, (float(signs[0]), [], True))
    return sides


def _later(progress: Progress, done: int, total: int) -> Progress:
    """The progress of a part, counted with what was done before it."""
    return lambda increments, _: progress(min(done + increments, total), total)


def _joined(before: Path, after: Path, back: bool) -> Path:
    """Two parts of a path, the second begun where the first ends; back: at a rest that nobody asked for."""
    kept = len(before.work) - back
    both = before.rows(slice(kept)), after.rows(slice(1, None))
    parts: dict[str, Any] = {name: np.concatenate([rows[name] for rows in both]) for name in BY_STATE}
    parts["work"][kept:] += before.work[-1]
    parts["unknowns"] = Later(partial(joined, tuple(rows["unknowns"] for rows in both)))
    return replace(
        after,
        message="; ".join(dict.fromkeys(m for m in (before.message, after.message) if m)),
        critical_points=before.critical_points + after.critical_points,
        counters={name: count + after.counters[name] for name, count in before.counters.items()},
        history=before.history + after.history,
        **parts,
    )
