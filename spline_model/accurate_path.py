"""A pivot's path to a wanted accuracy: trial paths, compiled where there is a fast path."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
from numpy.typing import NDArray

from spline_model.accuracy import Along, Errors, Search, distances, finer, search
from spline_model.design import Discretisation
from spline_model.fast.path import Answer
from spline_model.fast.refine import refined
from spline_model.fast.solve import fast_path
from spline_model.laps import Laps
from spline_model.mechanism import Mechanism
from spline_model.pivot import Pivot
from spline_model.solution import StaticSolution, Status

Array = NDArray[np.float64]

EVERY_STATE = 10
"""Of paths with more increments than this every second state is checked, the last one included."""


def solve_accurately(
    pivot: Pivot,
    rotations: Array,
    accuracy: float,
    *,
    solve: Callable[[Pivot], StaticSolution],
    recover: Callable[[Pivot, Answer], StaticSolution] | None,
) -> StaticSolution:
    """The path through the rotations [rad] with as many control points as the accuracy takes.

    solve: the solution of a pivot; recover: the solution from a fast answer, None for a
    pivot without a fast path. An accuracy that is not reached is the status NOT_CONVERGED of
    the best solution; without any complete path it is the incomplete one of the pivot itself.
    """
    outcome: Search[StaticSolution]
    if recover is None:
        outcome = search(pivot.mechanism.design, accuracy, _attempt(pivot, solve))
    else:
        quick = search(pivot.mechanism.design, accuracy, fast_attempt(pivot.mechanism, rotations))
        outcome = Search(estimate=quick.estimate, found=None)
        if quick.estimate is not None and quick.found is not None:
            chosen = _with_points(pivot, quick.estimate.control_points)
            outcome = Search(estimate=quick.estimate, found=recover(chosen, quick.found))
    if outcome.found is None:
        return solve(pivot)
    status = Status.NOT_CONVERGED if outcome.message else Status.CONVERGED
    return replace(outcome.found, status=status, message=outcome.message, estimate=outcome.estimate)


def fast_attempt(
    mechanism: Mechanism, rotations: Array
) -> Callable[[Discretisation], tuple[Errors, Answer] | None]:
    """Attempts on the compiled condensed path through the rotations [rad]."""
    design = mechanism.design
    length = design.strips[0].length
    angles = np.concatenate(([0.0], rotations))
    checked = np.arange(len(angles) - 1, -1, -2 if len(rotations) > EVERY_STATE else -1)[::-1]

    def attempt(grid: Discretisation) -> tuple[Errors, Answer] | None:
        coarse, fine = (  # the scene stays behind: no fast path reads it
            replace(mechanism, design=replace(design, discretisation=one)) for one in (grid, finer(grid))
        )
        done, answer = fast_path(coarse, list(rotations), Laps())
        if done < len(angles):
            return None
        better = refined(coarse, angles[checked], answer.y[checked], fine)
        if better is None:
            return None
        path = Along(answer.y[checked, :2] * length, answer.torque[checked], answer.stiffness[checked])
        exact = Along(better.y[:, :2] * length, better.torque, better.stiffness)
        return distances(path, exact, length), answer

    return attempt


def _attempt(
    pivot: Pivot, solve: Callable[[Pivot], StaticSolution]
) -> Callable[[Discretisation], tuple[Errors, StaticSolution] | None]:
    """Attempts by two whole paths each; a path is solved once."""
    length = pivot.mechanism.design.strips[0].length

    @cache
    def solved(control_points: int) -> StaticSolution:
        return solve(_with_points(pivot, control_points))

    def attempt(grid: Discretisation) -> tuple[Errors, StaticSolution] | None:
        coarse, fine = solved(grid.control_points), solved(finer(grid).control_points)
        if Status.NOT_CONVERGED in (coarse.status, fine.status):
            return None
        path, exact = (Along(part.centre, part.torque, part.stiffness) for part in (coarse, fine))
        return distances(path, exact, length), coarse

    return attempt


def _with_points(pivot: Pivot, control_points: int) -> Pivot:
    """The same pivot with that many control points."""
    return replace(pivot, mechanism=pivot.mechanism.with_discretisation(control_points=control_points))
