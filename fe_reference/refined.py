"""Answers to a wanted accuracy: meshes of twice as many elements each, and their limit.

Every quantity errs by even powers of the element, so that two meshes give the limit f + (f - f_coarse) / 3,
and a third one takes the next power away as well. The estimate is the last of these corrections: the error of
what it was applied to, which is larger than that of the limit.
"""

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, replace
from typing import Any, Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

from .errors import ConvergenceError, positive
from .model import Model, Strip
from .solution import ErrorEstimate, StaticSolution, Status
from .structure import structure_of
from .trajectory import ENERGIES, Trajectory

Array = NDArray[np.float64]
Answer = TypeVar("Answer")
#: Quantities by name: values at the same places on every mesh, and a unit, below which all is round-off.
Quantities = Mapping[str, tuple[Array, float]]
#: Elements of a strip at which the refinement ends.
MOST = 640
#: Part of its unit below which a quantity is none but round-off.
NOTHING = 1e-9


def finer(model: Model) -> Model:
    """Return the model on twice as many elements; between nodes on an arc the new ones lie on the arc."""
    return replace(model, strips=tuple(replace(strip, nodes=_halved(strip)) for strip in model.strips))


def _halved(strip: Strip) -> Array:
    """Return the nodes (2 P - 1, 2) with middles of the elements, off the chords by tan(turn / 4) / 2."""
    chord = np.diff(strip.nodes, axis=0)
    direction = np.unwrap(np.arctan2(chord[:, 1], chord[:, 0]))
    turns = np.diff(direction)
    turn = 0.5 * (np.append(turns[:1], turns) + np.append(turns, turns[-1:])) if len(turns) else np.zeros(1)
    left = np.stack([-chord[:, 1], chord[:, 0]], axis=1)
    nodes = np.empty((2 * len(chord) + 1, 2))
    nodes[::2] = strip.nodes
    nodes[1::2] = strip.nodes[:-1] + 0.5 * chord - 0.5 * np.tan(0.25 * turn)[:, None] * left
    return nodes


@dataclass(frozen=True, kw_only=True, eq=False)
class Refined(Generic[Answer]):
    """How a refinement ended.

    Attributes:
        answer: of the finest mesh. limits: of all quantities by name. estimate: of their errors; None, and no
            limits, where a mesh had no answer. message: why the accuracy was not reached, "" if it was.
    """

    answer: Answer
    limits: dict[str, Array]
    estimate: ErrorEstimate | None
    message: str = ""


def refine(
    model: Model,
    accuracy: float,
    solve: Callable[[Model], Answer],
    quantities: Callable[[Answer], Quantities],
    judged: Collection[str] | None = None,
    relative: bool = True,
) -> Refined[Answer]:
    """Double the elements until the estimated errors are below the accuracy or fall no more.

    Args:
        model: the coarsest mesh. solve: answers a model. quantities: of an answer, none if it is not whole.
        judged: names of the quantities whose errors count, all by default. relative: whether errors are parts
            of a quantity's largest value, or count as they are.
    """
    positive("accuracy", accuracy, "1")
    known: list[list[Array]] = []
    meshes: list[int] = []
    best = Refined(answer=solve(model), limits={}, estimate=None)
    answer = best.answer
    while here := quantities(answer):
        meshes.append(len(model.strips[0].nodes) - 1)
        known.append([values for values, _ in here.values()])
        if len(known) > 1:
            limits, changes = _limit(known[-3:])
            errors = {
                name: float(np.abs(change).max(initial=0.0)) / (_size(limit, unit) if relative else 1.0)
                for (name, (_, unit)), limit, change in zip(here.items(), limits, changes, strict=True)
                if judged is None or name in judged
            }
            estimate = ErrorEstimate(accuracy=accuracy, meshes=tuple(meshes), errors=errors)
            if best.estimate is None or estimate.largest < best.estimate.largest:
                best = Refined(answer=answer, limits=dict(zip(here, limits, strict=True)), estimate=estimate)
            if estimate is not best.estimate or estimate.largest <= accuracy or 2 * meshes[-1] > MOST:
                return replace(best, message=_missed(best.estimate))
        model = finer(model)
        answer = solve(model)
    return Refined(answer=answer, limits={}, estimate=None)


def _missed(estimate: ErrorEstimate | None) -> str:
    """Return that an accuracy was not reached, or ""."""
    if estimate is None or estimate.largest <= estimate.accuracy:
        return ""
    return (
        f"accuracy {estimate.accuracy:.3g} is not reached with up to {estimate.elements} elements: the "
        f"estimated error is {estimate.largest:.2g}; ask for no less"
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


def told(message: str, remark: str) -> str:
    """Return both, or the one there is."""
    return "; ".join(each for each in (message, remark) if each)


#: What an accuracy is asked of, and what it takes to its limit along the strips.
JUDGED = ("path", "torque", "stiffness", "strain_energy", "largest_stress")
DERIVED = ("path", "strain_energy", "bodies")
ALONG = ("shape", "axial_force", "shear_force", "bending_moment")


def limit_of_paths(
    model: Model, accuracy: float, solve: Callable[[Model], StaticSolution], raise_on_failure: bool
) -> StaticSolution:
    """Return the limit of a path's meshes, or the solution of the first mesh that has none."""
    refined = refine(model, accuracy, solve, _of_paths(model), JUDGED)
    found, limits = refined.answer, refined.limits
    if refined.estimate is None:
        return found
    every = (found.shape.shape[2] - 1) // (len(model.strips[0].nodes) - 1)
    fields: dict[str, Any] = {name: values for name, values in limits.items() if name not in DERIVED}
    fields["bodies"] = dict(zip(found.bodies, np.moveaxis(limits["bodies"], 1, 0), strict=True))
    found = replace(
        found,
        status=Status.NOT_CONVERGED if refined.message else found.status,
        message=told(found.message, refined.message),
        stations=found.stations[::every],
        estimate=refined.estimate,
        **fields,
    )
    if refined.message and raise_on_failure:
        raise ConvergenceError(refined.message, solution=found, load_factor=1.0, history=found.history)
    return found


def _of_paths(model: Model) -> Callable[[StaticSolution], Quantities]:
    """Return what takes the quantities of a solution at the nodes of a model, the coarsest mesh."""
    structure = structure_of(model)
    length, force, moment = structure.length, structure.force_unit, structure.moment_unit
    section = model.strips[0].section
    units = {
        "torque": moment, "stiffness": moment, "clamp_reactions": force, "shape": length,
        "axial_force": force, "shear_force": force, "bending_moment": moment,
        "largest_stress": moment * np.sqrt(3.0 / (section.area * section.second_moment_of_area)),
        **dict.fromkeys(("bending_energy", "axial_energy", "shear_energy"), moment),
        **dict.fromkeys(("gravity_energy", "work", "strain_energy"), moment),
    }  # fmt: skip

    def quantities(solution: StaticSolution) -> Quantities:
        if solution.status is not Status.CONVERGED:
            return {}
        every = (solution.shape.shape[2] - 1) // (structure.stations - 1)
        arrays = {name: getattr(solution, name) for name in units}
        known = {name: values for name, values in arrays.items() if np.isfinite(values).all()}
        found = {
            name: (values[:, :, ::every] if name in ALONG else values, units[name])
            for name, values in known.items()
        }
        bodies = np.array(list(solution.bodies.values())).reshape(-1, len(solution.load_factor), 3)
        places = np.moveaxis(bodies, 0, 1)
        moved = (places - places[0]) / np.array([length, length, 1.0])
        return found | {"bodies": (places, length), "path": (moved, 1.0)}

    return quantities


def limit_of_motions(model: Model, accuracy: float, solve: Callable[[Model], Trajectory]) -> Trajectory:
    """Return the limit of a motion's meshes, recorded at the same instants, or the motion that has none.

    The accuracy is that of the rotations [rad] and of the nodes' places in strip lengths.
    """
    length, stations = structure_of(model).length, structure_of(model).stations

    def quantities(motion: Trajectory) -> Quantities:
        if motion.status is not Status.CONVERGED:
            return {}
        places, rates = (
            np.array(list(each.values())).reshape(-1, len(motion.time), 3)
            for each in (motion.bodies, motion.rates)
        )
        every = (motion.shape.shape[2] - 1) // (stations - 1)
        shape = motion.shape[:, :, ::every] / length
        energies = {name: getattr(motion, name) for name in ENERGIES}
        moves = {"places": places, "rates": rates, "rotation": places[..., 2], "shape": shape}
        return {name: (values, 1.0) for name, values in (moves | energies).items()}

    refined = refine(model, accuracy, solve, quantities, ("rotation", "shape"), relative=False)
    motion, limits = refined.answer, refined.limits
    if refined.estimate is None:
        return motion
    names = tuple(motion.bodies)
    energies: dict[str, Any] = {name: limits[name] for name in ENERGIES}
    return replace(
        motion,
        status=Status.NOT_CONVERGED if refined.message else motion.status,
        message=refined.message,
        bodies=dict(zip(names, limits["places"], strict=True)),
        rates=dict(zip(names, limits["rates"], strict=True)),
        shape=length * limits["shape"],
        rotation_error=refined.estimate.errors["rotation"],
        estimate=refined.estimate,
        **energies,
    )
