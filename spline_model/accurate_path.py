"""A pivot's path to a wanted accuracy: trial paths with more and more control points."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache

from spline_model.accuracy import Along, Errors, distances, finer, search
from spline_model.compile import System
from spline_model.continuation.point import driven_row
from spline_model.design import Discretisation
from spline_model.pivot import BODY, Pivot
from spline_model.solution import Path, StaticSolution, Status

Followed = tuple[System, Path]


def solve_accurately(
    pivot: Pivot,
    accuracy: float,
    *,
    path_of: Callable[[Pivot], Followed],
    answer: Callable[[System, Path], StaticSolution],
) -> StaticSolution:
    """The path of a pivot with as many control points as the accuracy takes.

    path_of: follows the path of a pivot; answer: what a solution tells of it. An accuracy that is not
    reached is the status NOT_CONVERGED of the best solution; without any complete path the solution
    is the incomplete one of the pivot itself.
    """
    length = pivot.mechanism.design.strips[0].length

    @cache
    def followed(control_points: int) -> Followed:
        made = pivot.mechanism.with_discretisation(control_points=control_points)
        return path_of(replace(pivot, mechanism=made))

    def attempt(grid: Discretisation) -> tuple[Errors, Followed] | None:
        coarse, fine = followed(grid.control_points), followed(finer(grid).control_points)
        if Status.NOT_CONVERGED in (coarse[1].status, fine[1].status):
            return None
        return distances(_along(*coarse), _along(*fine), length), coarse

    outcome = search(pivot.mechanism.design, accuracy, attempt)
    if outcome.found is None:
        return answer(*path_of(pivot))
    status = Status.NOT_CONVERGED if outcome.message else Status.CONVERGED
    found = answer(*outcome.found)
    return replace(found, status=status, message=outcome.message, estimate=outcome.estimate)


def _along(system: System, path: Path) -> Along:
    """What is compared of a path."""
    row = driven_row(system)
    assert row is not None, "a pivot's rotation is driven"
    centre = path.states[:, system.layout.body(BODY)][:, :2]
    return Along(centre=centre, torque=path.states[:, row], stiffness=path.stiffness)
