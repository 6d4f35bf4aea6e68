"""Accuracy: as many control points as a wanted accuracy takes, with an error estimate.

An answer is estimated by what changes when each strip gets a few control points more. With
Bezier strips the error falls by a factor of 3 to 50 a point, in steps that are not even, so that after
three more it is small against the one that is estimated; with cubic B-splines of twice the
spans it falls about sixteenfold.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Generic, TypeVar

import numpy as np

from spline_model.design import Design, Discretisation
from spline_model.errors import InvalidParameter, require_positive
from spline_model.solution import StaticSolution

Found = TypeVar("Found")

DEFAULT = 1e-4
"""Relative error of the answer to a design that leaves its control points open."""
FIRST = 8
"""Control points of the first trial of such a design."""
DOUBTFUL = 0.03
"""Error of such an answer that is a failure; above DEFAULT its resolution tells it."""
MORE = 3
"""Control points that a Bezier strip gets more for the estimate. With two more the estimated error of
the torque was 0.3 to 3.7 times the true one on 1800 paths, with three 0.7 to 1.3 times."""
MOST = {"bezier": 20, "bspline": 67}
"""Control points at which the search ends: round-off of a Bezier strip, 64 spans of a B-spline."""
FIRST_GAIN = 6.0
"""By how much a control point is expected to lower the error before it was measured."""
GAINS = (2.0, 12.0)
"""Limits of what is believed of a measured gain: the error does not fall evenly."""


@dataclass(frozen=True, kw_only=True)
class Search(Generic[Found]):
    """How a search ended: the best answer with its estimated error [1] and control points, and all trials.

    found: None, and the error inf, if no number of control points has an answer.
    """

    accuracy: float
    error: float
    control_points: int
    trials: tuple[int, ...]
    found: Found | None

    @property
    def message(self) -> str:
        """Why the search did not reach its accuracy; empty if it did."""
        if self.error <= self.accuracy:
            return ""
        return (
            f"accuracy {self.accuracy:.3g} is not reached with up to {self.trials[-1]} control points: the "
            f"least estimated error is {self.error:.2g}, with {self.control_points}; ask for no less"
        )


def wanted(accuracy: float | None, design: Design, start: object = None) -> float | None:
    """The accuracy that control points are raised for: as asked, or DEFAULT where a design leaves them open.

    None: a path goes on from a ``start`` with its control points, or has those of the design. Refused are
    one that is no positive number, and what it chooses itself.
    """
    grid = design.discretisation
    if accuracy is None:
        return DEFAULT if grid.control_points is None and start is None else None
    require_positive("accuracy", accuracy, "1")
    if start is not None:
        raise InvalidParameter("accuracy", accuracy, "no start beside it")
    for name in ("axial_modes", "gauss_points"):
        if getattr(grid, name) is not None:
            raise InvalidParameter(name, getattr(grid, name), "none beside accuracy, which goes with its own")
    return accuracy


def settled(design: Design, start: StaticSolution | None) -> int | None:
    """The control points of a path that does not choose: the design's, or those of what it goes on from."""
    given = design.discretisation.control_points
    return start.control_points if given is None and start is not None else given


def finer(grid: Discretisation) -> int:
    """The control points that a discretisation is checked against: a few more, or twice the spans."""
    return grid.points + MORE if grid.basis == "bezier" else 2 * grid.points - 3


def search(
    design: Design,
    accuracy: float,
    attempt: Callable[[int, int], tuple[float, Found] | None],
) -> Search[Found]:
    """Raise the control points, from those of the design on, until the estimate is below ``accuracy``.

    attempt: solves with two numbers of control points and returns the estimated error of the first, and its
    answer, or None where they do not have one.
    """
    grid = design.discretisation
    if grid.control_points is None:
        grid = replace(grid, control_points=FIRST)
    most = max(MOST[grid.basis], grid.points)
    best: Search[Found] = Search(
        accuracy=accuracy, error=math.inf, control_points=grid.points, trials=(), found=None
    )
    levels: list[tuple[int, float]] = []
    while True:
        n, outcome = grid.points, attempt(grid.points, finer(grid))
        best = replace(best, trials=(*best.trials, n))
        if outcome is not None:
            levels.append((n, outcome[0]))
            if outcome[0] < best.error:
                best = replace(best, error=outcome[0], control_points=n, found=outcome[1])
        if best.error <= accuracy or n == most:
            return best
        following = finer(grid) if grid.basis == "bspline" else next_count(levels, accuracy, n)
        grid = replace(grid, control_points=min(following, most))


def next_count(levels: list[tuple[int, float]], accuracy: float, tried: int) -> int:
    """The count at which the accuracy is expected, from the (count, error) known so far.

    The one that an estimate was made with is solved already: a count a little below costs more than it.
    """
    if not levels or levels[-1][0] != tried:
        return tried + MORE
    (n, error), gain = levels[-1], FIRST_GAIN
    if len(levels) > 1:
        before, larger = levels[-2]
        gain = float(np.clip((larger / error) ** (1.0 / (n - before)), *GAINS))
    return n + max(MORE, math.ceil(math.log(error / accuracy) / math.log(gain)))
