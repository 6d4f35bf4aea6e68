"""Answers to a wanted accuracy: meshes of twice as many elements each, and their limit.

Every quantity errs by even powers of the element, so that two meshes give the limit f + (f - f_coarse) / 3,
and a third one takes the next power away as well. The estimate is the last of these corrections: the error of
what it was applied to, which is larger than that of the limit.
"""

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, fields, replace
from typing import Any, Generic, TypeVar

import numpy as np

from .arrays import Array
from .errors import positive
from .model import Model
from .solution import ErrorEstimate, StaticSolution, Status
from .trajectory import Trajectory

Answer = TypeVar("Answer")
Solved = TypeVar("Solved", StaticSolution, Trajectory)
#: Quantities by name: values at the same places on every mesh, and a unit, below which all is round-off.
Quantities = Mapping[str, tuple[Array, float]]
#: Elements of a strip at which the refinement ends.
MOST = 640
#: Part of its unit below which a quantity is none but round-off.
NOTHING = 1e-9


def finer(model: Model) -> Model:
    """Return the model on twice as many elements."""
    return replace(model, elements=2 * model.elements)


@dataclass(frozen=True, kw_only=True, eq=False)
class _Refined(Generic[Answer]):
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
) -> _Refined[Answer]:
    """Double the elements until the estimated errors are below the accuracy or fall no more.

    Args:
        model: the coarsest mesh. solve: answers a model. quantities: of an answer, none if it is not whole.
        judged: names of the quantities whose errors count, all by default. relative: whether errors are parts
            of a quantity's largest value, or of its unit.
    """
    positive("accuracy", accuracy, "1")
    known: list[list[Array]] = []
    meshes: list[int] = []
    best = _Refined(answer=solve(model), limits={}, estimate=None)
    answer = best.answer
    while here := quantities(answer):
        meshes.append(model.elements)
        known.append([values for values, _ in here.values()])
        if len(known) > 1:
            limits, changes = _limit(known[-3:])
            errors = {
                name: float(np.abs(change).max(initial=0.0)) / (_size(limit, unit) if relative else unit)
                for (name, (_, unit)), limit, change in zip(here.items(), limits, changes, strict=True)
                if judged is None or name in judged
            }
            estimate = ErrorEstimate(accuracy=accuracy, meshes=tuple(meshes), errors=errors)
            if best.estimate is None or estimate.largest < best.estimate.largest:
                best = _Refined(answer=answer, limits=dict(zip(here, limits, strict=True)), estimate=estimate)
            if estimate is not best.estimate or estimate.largest <= accuracy or 2 * meshes[-1] > MOST:
                return replace(best, message=_missed(best.estimate))
        model = finer(model)
        answer = solve(model)
    return _Refined(answer=answer, limits={}, estimate=None)


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


#: What is given at the nodes.
ALONG = ("shape", "axial_force", "shear_force", "bending_moment")


def limit_of(
    model: Model,
    accuracy: float,
    solve: Callable[[Model], Solved],
    units: Mapping[str, float],
    derived: Mapping[str, Callable[[Array], Array]],
    judged: Collection[str],
    relative: bool = True,
) -> Solved:
    """Return the limit of an answer's meshes, at the nodes of the coarsest, or the first that has none.

    Args:
        model, accuracy, solve, judged, relative: as in `refine`.
        units: of the answer's attributes that are taken to their limits. derived: quantities of one, by what
            makes them from the places of the bodies (B, S, 3).
    """

    def quantities(answer: Solved) -> Quantities:
        if answer.status is not Status.CONVERGED:
            return {}
        every, found = (answer.shape.shape[2] - 1) // model.elements, {}
        for name, unit in units.items():
            values = getattr(answer, name)
            if isinstance(values, Mapping):
                values = np.array(list(values.values())).reshape(-1, len(answer.shape), 3)
            if np.isfinite(values).all():
                found[name] = (values[:, :, ::every] if name in ALONG else values, unit)
        return found | {name: (make(found["bodies"][0]), 1.0) for name, make in derived.items()}

    refined = refine(model, accuracy, solve, quantities, judged, relative)
    found = refined.answer
    if refined.estimate is None:
        return found
    own = {each.name: getattr(found, each.name) for each in fields(found)}
    limits: dict[str, Any] = {name: limit for name, limit in refined.limits.items() if name in own}
    for name in limits:
        if isinstance(own[name], Mapping):
            limits[name] = dict(zip(own[name], limits[name], strict=True))
    status = Status.NOT_CONVERGED if refined.message else found.status
    message = "; ".join(each for each in (found.message, refined.message) if each)
    return replace(found, status=status, message=message, estimate=refined.estimate, **limits)
