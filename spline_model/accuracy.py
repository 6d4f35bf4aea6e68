"""Accuracy on request: as many control points as a wanted accuracy takes, with an error estimate.

A path is estimated by what changes when each strip gets a few control points more. With
Bezier strips the error falls by a factor of 3 to 50 a point, in steps that are not even, so that after
three more it is small against the one that is estimated; with cubic B-splines of twice the
spans it falls about sixteenfold.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Generic, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from spline_model.design import Design, Discretisation
from spline_model.errors import InvalidParameter, require_positive
from spline_model.solution import ErrorEstimate

Array = NDArray[np.float64]
Found = TypeVar("Found")
Errors = tuple[float, float, float]

MORE = 3
"""Control points that a Bezier strip gets more for the estimate. With two more the estimated error of
the torque was 0.3 to 3.7 times the true one on 1800 paths, with three 0.7 to 1.3 times."""
MOST = {"bezier": 20, "bspline": 67}
"""Control points at which the search ends: round-off of a Bezier strip, 64 spans of a B-spline."""
FIRST_GAIN = 6.0
"""By how much a control point is expected to lower the error before it was measured."""
NOTHING = 1e-9
"""Displacement in lengths, and torque in stiffness times 1 rad, below which there is none but round-off."""
GAINS = (2.0, 12.0)
"""Limits of what is believed of a measured gain: the error does not fall evenly."""


class Along(NamedTuple):
    """What is compared along a path: centre (S, 2) [m], torque [N m], stiffness [N m/rad] (S,)."""

    centre: Array
    torque: Array
    stiffness: Array


@dataclass(frozen=True, kw_only=True)
class Search(Generic[Found]):
    """How a search ended: the best answer and its estimate, None and None if no path was complete."""

    estimate: ErrorEstimate | None
    found: Found | None

    @property
    def message(self) -> str:
        """Why the search did not reach its accuracy; empty if it did."""
        if self.estimate is None:
            return "no number of control points follows the path to its end"
        if self.estimate.largest <= self.estimate.accuracy:
            return ""
        return (
            f"accuracy {self.estimate.accuracy:.3g} is not reached with up to {self.estimate.trials[-1]} "
            f"control points: the least estimated error is {self.estimate.largest:.2g}, with "
            f"{self.estimate.control_points}; ask for no less"
        )


def check_accuracy(accuracy: float, design: Design) -> None:
    """Refuse an accuracy that is no positive number, and what it chooses itself."""
    require_positive("accuracy", accuracy, "1")
    grid = design.discretisation
    for name in ("axial_modes", "gauss_points"):
        if getattr(grid, name) is not None:
            raise InvalidParameter(name, getattr(grid, name), "none beside accuracy, which goes with its own")


def finer(grid: Discretisation) -> Discretisation:
    """The discretisation that one is checked against: a few points more, or twice the spans."""
    n = grid.control_points
    return replace(grid, control_points=n + MORE if grid.basis == "bezier" else 2 * n - 3)


def search(
    design: Design,
    accuracy: float,
    attempt: Callable[[Discretisation], tuple[Errors, Found] | None],
) -> Search[Found]:
    """Raise the control points, from those of the design on, until the estimate is below ``accuracy``.

    attempt: solves with a discretisation and returns the estimated errors of trajectory,
    torque and stiffness and the answer, or None where the path is not complete.
    """
    grid = design.discretisation
    best: Search[Found] = Search(estimate=None, found=None)
    most = max(MOST[grid.basis], grid.control_points)
    trials: list[int] = []
    levels: list[tuple[int, float]] = []
    while True:
        trials.append(grid.control_points)
        outcome = attempt(grid)
        if outcome is not None:
            errors, found = outcome
            estimate = _estimate(accuracy, errors, trials)
            levels.append((grid.control_points, estimate.largest))
            if best.estimate is None or estimate.largest < best.estimate.largest:
                best = Search(estimate=estimate, found=found)
        reached = best.estimate is not None and best.estimate.largest <= accuracy
        if reached or grid.control_points == most:
            break
        n = finer(grid).control_points
        if grid.basis == "bezier":
            n = next_count(levels, accuracy, grid.control_points)
        grid = replace(grid, control_points=min(n, most))
    if best.estimate is not None:
        best = replace(best, estimate=replace(best.estimate, trials=tuple(trials)))
    return best


def _estimate(accuracy: float, errors: Errors, trials: list[int]) -> ErrorEstimate:
    trajectory, torque, stiffness = errors
    return ErrorEstimate(
        accuracy=accuracy,
        trajectory=trajectory,
        torque=torque,
        stiffness=stiffness,
        control_points=trials[-1],
        trials=tuple(trials),
    )


def next_count(levels: list[tuple[int, float]], accuracy: float, tried: int) -> int:
    """The count at which the accuracy is expected, from the (count, error) known so far."""
    if not levels or levels[-1][0] != tried:
        return tried + 1
    (n, error), gain = levels[-1], FIRST_GAIN
    if len(levels) > 1:
        before, larger = levels[-2]
        gain = float(np.clip((larger / error) ** (1.0 / (n - before)), *GAINS))
    return n + max(1, math.ceil(math.log(error / accuracy) / math.log(gain)))


def distances(path: Along, exact: Along, length: float) -> Errors:
    """Largest errors of trajectory, torque and stiffness of a path against a better one [1].

    The trajectory's over the largest displacement, or over ``length`` [m] for a centre that
    stays where it is; the others over their largest magnitudes, the torque's over the stiffness
    times 1 rad where there is none.
    """
    travel = float(np.linalg.norm(exact.centre - exact.centre[0], axis=1).max())
    torque, stiffness = (float(np.abs(values).max()) for values in (exact.torque, exact.stiffness))
    return (
        float(np.linalg.norm(path.centre - exact.centre, axis=1).max())
        / (travel if travel > NOTHING * length else length),
        float(np.abs(path.torque - exact.torque).max())
        / (torque if torque > NOTHING * stiffness else stiffness),
        float(np.abs(path.stiffness - exact.stiffness).max()) / stiffness,
    )
