"""Answers to a wanted accuracy: meshes of twice as many elements each, and their limit.

Every quantity errs by even powers of the element, so that two meshes give the limit f + (f - f_coarse) / 3,
and a third one takes the next power away as well. The estimate is the last of these corrections: the error of
what it was applied to, which is larger than that of the limit.

What is critical on a path, or ends it, is told as two meshes have it: otherwise it belongs to the mesh.
"""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import fields, replace
from typing import Any, TypeVar

import numpy as np

from . import read
from .arrays import Array
from .effects import WAYS
from .model import Model
from .response import CriticalPoint
from .solution import ENERGIES, ErrorEstimate, StaticSolution, Status
from .structure import structure_of

Answer = TypeVar("Answer")
#: Quantities by name: values at the same places on every mesh, and a unit, below which all is round-off.
Quantities = Mapping[str, tuple[Array, float]]
#: Elements of a strip at which the refinement ends.
MOST = 640
#: Part of its unit below which a quantity is none but round-off, and difference of parameters of the same
#: increment.
NOTHING = 1e-9
#: Estimated error of whole answers up to which a finer mesh that is not complete is stopped by round-off.
AGREED = 1e-2


def finer(model: Model) -> Model:
    """Return the model on twice as many elements."""
    return replace(model, elements=2 * model.elements)


def refine(
    model: Model,
    accuracy: float,
    solve: Callable[[Model], Answer],
    quantities: Callable[[Answer], Quantities],
    judged: Collection[str] | None = None,
) -> tuple[Answer, dict[str, Array], ErrorEstimate | None]:
    """Double the elements until the estimated errors are below the accuracy or do not decrease.

    Args:
        model: the coarsest mesh. accuracy: wanted error, in parts of a quantity's largest value [1].
        solve: answers a model. quantities: of an answer; none if the answer is not complete.
        judged: names of the quantities whose errors count, all by default.

    Returns:
        The answer of the best mesh, the limits (S, ...) of all quantities by name, and the estimate of their
        errors. If the answer of a mesh is not complete, this answer without limits and estimate; but if
        coarser ones are and agree, round-off stopped it, and the best of these is returned.
    """
    read.positive("accuracy", accuracy, "1")
    known: list[list[Array]] = []
    meshes: list[int] = []
    answer, best = solve(model), None
    while here := quantities(answer):
        meshes.append(model.elements)
        known.append([values for values, _ in here.values()])
        if len(known) > 1:
            limits, changes = _limit(known[-3:])
            errors = {
                name: float(np.abs(change).max(initial=0.0)) / _size(limit, unit)
                for (name, (_, unit)), limit, change in zip(here.items(), limits, changes, strict=True)
                if judged is None or name in judged
            }
            estimate = ErrorEstimate(accuracy=accuracy, meshes=tuple(meshes), errors=errors)
            if best is None or estimate.largest < best[2].largest:
                best = answer, dict(zip(here, limits, strict=True)), estimate
            if estimate is not best[2] or estimate.largest <= accuracy or 2 * meshes[-1] > MOST:
                return best
        model = finer(model)
        answer = solve(model)
    if best is not None and best[2].largest <= AGREED:
        return best[0], best[1], replace(best[2], stopped=model.elements)
    return answer, {}, None


def missed(estimate: ErrorEstimate) -> str:
    """Return that an accuracy was not reached, or ""."""
    if estimate.largest <= estimate.accuracy:
        return ""
    stopped = f"round-off stops {estimate.stopped} elements; " if estimate.stopped else ""
    return (
        f"accuracy {estimate.accuracy:.3g} is not reached with up to {estimate.elements} elements: the "
        f"estimated error is {estimate.largest:.2g}; {stopped}ask for no less"
    )


def _limit(levels: list[list[Array]]) -> tuple[list[Array], list[Array]]:
    """Return the limits of two or three levels and the last corrections that led to them."""
    changes = [(fine - coarse) / 3.0 for coarse, fine in zip(levels[-2], levels[-1], strict=True)]
    once = [fine + change for fine, change in zip(levels[-1], changes, strict=True)]
    if len(levels) == 2:
        return once, changes
    before, _ = _limit(levels[:2])
    changes = [(fine - coarse) / 15.0 for coarse, fine in zip(before, once, strict=True)]
    return [fine + change for fine, change in zip(once, changes, strict=True)], changes


def _size(values: Array, unit: float) -> float:
    """Return what errors are parts of: the largest value, or the unit where there is none but round-off."""
    largest = float(np.abs(values).max(initial=0.0))
    return largest if largest > NOTHING * unit else unit


#: What is given at the nodes.
ALONG = ("shape", "axial_force", "shear_force", "bending_moment")
#: What an accuracy is asked of.
JUDGED = ("path", "torque", "stiffness", "strain_energy", "largest_stress", "exerted")


def limit_of(model: Model, accuracy: float, solve: Callable[[Model], StaticSolution]) -> StaticSolution:
    """Return the limit of a path's meshes, at the nodes of the coarsest, or the first that has none.

    Args:
        model, accuracy, solve: as in `refine`.
    """
    structure, section, solved = structure_of(model), model.strips[0], list[StaticSolution]()
    length, force, moment = structure.length, structure.force_unit, structure.moment_unit
    units = dict.fromkeys((*ENERGIES, "strain_energy", "torque", "stiffness", "bending_moment"), moment)
    units |= dict.fromkeys(("clamp_reactions", "reactions", "axial_force", "shear_force"), force)
    units |= dict.fromkeys(("bodies", "tips", "shape"), length)
    units["largest_stress"] = moment * np.sqrt(3.0 / (section.area * section.second_moment_of_area))

    def kept(mesh: Model) -> StaticSolution:
        solved.append(solve(mesh))
        return solved[-1]

    def quantities(answer: StaticSolution) -> Quantities:
        if answer.status is not Status.CONVERGED:
            return {}
        every, found = (len(answer.stations) - 1) // model.elements, {}
        for name, unit in units.items():
            values = getattr(answer, name)
            if isinstance(values, Mapping):
                values = np.array([*values.values()]).reshape(-1, len(answer.shape), 3)
            if np.isfinite(values).all():
                found[name] = (values[:, :, ::every] if name in ALONG else values, unit)
        places = found["bodies"][0]
        found["path"] = ((places - places[:, :1]) / np.array([length, length, 1.0]), 1.0)
        exerted = _shares(answer, solved[0], np.array([force, moment]))
        return found | ({"exerted": (exerted, 1.0)} if exerted.size else {})

    found, refined, estimate = refine(model, accuracy, kept, quantities, JUDGED)
    if estimate is not None:
        own = {each.name for each in fields(found)}
        limits: dict[str, Any] = {name: values for name, values in refined.items() if name in own}
        for name in ("bodies", "tips"):
            limits[name] = dict(zip(getattr(found, name), limits[name], strict=True))
        told = missed(estimate)
        limits["message"] = "; ".join(each for each in (found.message, told) if each)
        limits["status"] = Status.NOT_CONVERGED if told else found.status
        limits["stations"] = found.stations[:: (len(found.stations) - 1) // model.elements]
        found = replace(found, estimate=estimate, **limits)
    return confirmed(found.model, found, solved, solve)


def _shares(answer: StaticSolution, first: StaticSolution, unit: Array) -> Array:
    """Return what is exerted on bodies (S, D), but the torque of the drive, in parts of what is largest.

    That is the largest force of a `first` answer, of moments its largest moment; the unit where none is.
    """
    own = [at for at, part in enumerate(answer.prescribed) if part != (answer.driven, WAYS[2])]
    turns = np.array([answer.prescribed[at][1] == WAYS[2] for at in own], dtype=np.int64)
    largest = np.zeros(2)
    np.maximum.at(largest, turns, np.abs(first.reactions[:, own]).max(axis=0, initial=0.0))
    shares: Array = answer.reactions[:, own] / np.where(largest > NOTHING * unit, largest, unit)[turns]
    return shares


#: Critical points of two meshes are the same within this part of load factor, preload and rotation.
SAME = 0.05
#: States of two meshes are kept while places and torque differ by no more than this part of the largest.
KEPT = 0.03
#: Rotation up to which critical points are held against it, not against their own [rad].
TURN = 1e-2
#: Critical points that a message names.
FEW = 3
#: Smallest relative difference of two meshes that is printed.
LEAST = 1e-6


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
    points, pairs = answer.critical_points, (answer, other)
    elements = [each.model.elements for each in pairs]
    apart = [_apart(*both) for both in zip(points, other.critical_points, strict=False)]
    known = int(np.argmax(np.append(np.array(apart) > SAME, True)))
    same = known == len(points) == len(other.critical_points)
    # the whole path, or up to a limit point: stability is lost beyond its last state
    ends = answer.status is Status.CONVERGED or (points and points[-1].inertia > answer.inertia[-1])
    if same and answer.status is other.status and ends:
        told = f" ({elements[1]} elements have it within {max([*apart, LEAST]):.0e})"
        return replace(answer, message=answer.message + told if answer.message else "")
    kept = _alike(answer, other)
    whole = answer.status is Status.CONVERGED and kept == len(answer.work)
    mine, its = (_told(each, known) for each in pairs)
    return replace(
        answer.until(kept),
        critical_points=points[:known],
        status=Status.CONVERGED if whole else Status.NOT_CONVERGED,
        message=f"not resolved with {elements[0]} elements: {mine}; with {elements[1]}: {its}; "
        f"take {2 * max(elements)} elements",
    )


def _apart(mine: CriticalPoint, its: CriticalPoint) -> float:
    """Return the largest relative difference of two critical points, inf if they are not of one kind."""
    if mine.kind != its.kind:
        return np.inf
    places = np.nan_to_num([[p.load_factor, p.preload, p.rotation] for p in (mine, its)])
    size = np.maximum(np.abs(places[0]), (NOTHING, NOTHING, TURN))
    return float((np.abs(places[0] - places[1]) / size).max())


def _told(answer: StaticSolution, known: int) -> str:
    """Return the first few critical points behind those that are known, and where a path ends and why."""
    points = answer.critical_points[known:]
    told = [f"{point.kind} at {point.load_factor:.6g}" for point in points[:FEW]]
    told += [f"{len(points) - FEW} more"] * (len(points) > FEW)
    if answer.status is Status.CONVERGED:
        return ", ".join((*told, "the whole path"))
    reason = answer.message.rpartition("; ")[2] if len(points) > FEW else answer.message
    return ", ".join((*told, f"stops at load factor {answer.load_factor[-1]:.6g} ({reason})"))


def _alike(answer: StaticSolution, other: StaticSolution) -> int:
    """Return how many states from the first on the two meshes have alike, at least one."""
    count = min(len(answer.work), len(other.work))
    mine, its = (_quantities(each)[:count] for each in (answer, other))
    scale = np.abs(its).max(axis=0)
    apart = (np.abs(mine - its) / np.where(scale > NOTHING, scale, np.inf)).max(axis=1)
    same = np.abs(answer.load_factor[:count] - other.load_factor[:count]) <= NOTHING
    return max(1, int(np.argmax(np.append((apart > KEPT) | ~same, True))))


def _quantities(answer: StaticSolution) -> Array:
    """Return distances, turns and torque (S, K) [m, rad, N m]."""
    moved = [np.linalg.norm(place[:, :2] - place[0, :2], axis=1) for place in answer.bodies.values()]
    turns = [place[:, 2] for place in answer.bodies.values()]
    return np.stack((*moved, *turns, np.nan_to_num(answer.torque)), axis=1)
