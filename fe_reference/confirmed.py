"""What is critical on a path, or ends it, as two meshes have it: otherwise it belongs to the mesh."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from .arrays import Array
from .model import Model
from .refined import finer
from .solution import ENERGIES, CriticalPoint, StaticSolution, Status

#: Critical points of two meshes are the same within this part of load factor, preload and rotation.
SAME = 0.05
#: States of two meshes are kept while places and torque differ by no more than this part of the largest.
KEPT = 0.03
#: Size below which places and torques are round-off, and difference of parameters of the same increment.
ROUND_OFF = 1e-9
#: Rotation up to which critical points are held against it, not against their own [rad].
TURN = 1e-2
#: Smallest relative difference of two meshes that is printed.
LEAST = 1e-6
#: Arrays with a row a state.
BY_STATE = (
    *("inertia", "load_factor", "torque", "stiffness", *ENERGIES, "clamp_reactions", "largest_stress"),
    *("shape", "axial_force", "shear_force", "bending_moment", "states"),
)


def confirmed(
    model: Model, answer: StaticSolution, solved: Sequence[StaticSolution], solve: Callable[[Model], Any]
) -> StaticSolution:
    """Return an answer that claims no more than another mesh bears out.

    Args:
        model: of the answer. solved: answers of meshes so far, itself among them. solve: answers a model.
    """
    if answer.load_factor[-1] == 1.0 and not answer.critical_points:
        return answer
    others = [each for each in solved if len(each.states[0]) != len(answer.states[0])]
    other = others[-1] if others else solve(finer(model))
    apart = _apart(answer.critical_points, other.critical_points)
    elements = [each.model.elements for each in (answer, other)]
    if apart <= SAME and answer.status is other.status and (_whole(answer) or _at_limit(answer)):
        told = f" ({elements[1]} elements have it within {max(apart, LEAST):.0e})"
        return replace(answer, message=answer.message + told if answer.message else "")
    return _resolved(answer, other, elements)


def _whole(answer: StaticSolution) -> bool:
    return answer.status is Status.CONVERGED


def _at_limit(answer: StaticSolution) -> bool:
    """Return whether a path ran into a limit point: stability is lost beyond its last state."""
    points = answer.critical_points
    return bool(points) and points[-1].inertia > answer.inertia[-1]


def _apart(mine: Sequence[CriticalPoint], others: Sequence[CriticalPoint]) -> float:
    """Return the largest relative difference of critical points, inf if they are not of the same kinds."""
    if [point.kind for point in mine] != [point.kind for point in others]:
        return np.inf
    places = [
        np.nan_to_num([[p.load_factor, p.preload, p.rotation] for p in points]).reshape(-1, 3)
        for points in (mine, others)
    ]
    size = np.maximum(np.abs(places).max(axis=0), (ROUND_OFF, ROUND_OFF, TURN))
    return float((np.abs(places[0] - places[1]) / size).max(initial=0.0))


def _resolved(answer: StaticSolution, other: StaticSolution, elements: Sequence[int]) -> StaticSolution:
    """Return the states that both meshes have, and say where they part."""
    kept, known = _alike(answer, other), 0
    pairs = zip(answer.critical_points, other.critical_points, strict=False)
    for mine, its in pairs:
        if _apart([mine], [its]) > SAME:
            break
        known += 1
    whole = _whole(answer) and kept == len(answer.work)
    ends = [
        ", ".join((*(f"{p.kind} at {p.load_factor:.6g}" for p in each.critical_points[known:]), _end(each)))
        for each in (answer, other)
    ]
    most = 2 * max(elements)
    message = (
        f"not resolved with {elements[0]} elements: {ends[0]}; with {elements[1]}: {ends[1]}; "
        f"take {most} elements"
    )
    rows: dict[str, Any] = {name: getattr(answer, name)[:kept] for name in BY_STATE}
    return replace(
        answer,
        **rows,
        bodies={name: place[:kept] for name, place in answer.bodies.items()},
        critical_points=answer.critical_points[:known],
        status=Status.CONVERGED if whole else Status.NOT_CONVERGED,
        message=message,
    )


def _end(answer: StaticSolution) -> str:
    if _whole(answer):
        return "the whole path"
    return f"stops at load factor {answer.load_factor[-1]:.6g} ({answer.message})"


def _alike(answer: StaticSolution, other: StaticSolution) -> int:
    """Return how many states from the first on the two meshes have alike, at least one."""
    count = min(len(answer.work), len(other.work))
    mine, its = (_quantities(each)[:count] for each in (answer, other))
    scale = np.abs(its).max(axis=0)
    apart = (np.abs(mine - its) / np.where(scale > ROUND_OFF, scale, np.inf)).max(axis=1)
    same = np.abs(answer.load_factor[:count] - other.load_factor[:count]) <= ROUND_OFF
    return max(1, int(np.argmax(np.append((apart > KEPT) | ~same, True))))


def _quantities(answer: StaticSolution) -> Array:
    """Return distances, turns and torque (S, K) [m, rad, N m]."""
    moved = [np.linalg.norm(place[:, :2] - place[0, :2], axis=1) for place in answer.bodies.values()]
    turns = [place[:, 2] for place in answer.bodies.values()]
    return np.stack((*moved, *turns, np.nan_to_num(answer.torque)), axis=1)
