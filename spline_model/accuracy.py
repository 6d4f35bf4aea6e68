"""Accuracy: as many control points as a wanted accuracy takes, with an error estimate.

An answer is estimated by what changes when each strip gets a few control points more. With
Bezier strips the error falls by a factor of 3 to 50 a point, in steps that are not even, so that after
three more it is small against the one that is estimated; with cubic B-splines of twice the
spans it falls about sixteenfold. Trial paths are compared by state.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache
from typing import Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

from spline_model.design import Design, Discretisation, StripDesign
from spline_model.errors import InvalidParameter, require_positive
from spline_model.path import Progress
from spline_model.solution import ErrorEstimate, Status
from spline_model.static_answers import StaticSolution

Array = NDArray[np.float64]
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

NOTHING = 1e-9
"""Displacement in lengths, turn [rad], torque in stiffness times 1 rad, and force in moment over length,
below which there is none but round-off."""
SAME_STATE = 1e-9
"""The same of states before the end: those of increments are the same, of arcs they are not."""
SAME_END = 1e-3
"""Difference of load factors, and of rotations [rad], at which paths stop that stop at the same thing."""


@dataclass(frozen=True, kw_only=True)
class _Search(Generic[Found]):
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


def wanted(accuracy: float | None, design: Design) -> float | None:
    """The accuracy that control points are raised for: as asked, or DEFAULT where a design leaves them open.

    None: it has those of the design. Refused are one that is no positive number, and what it chooses itself.
    """
    grid = design.discretisation
    if accuracy is None:
        return DEFAULT if grid.control_points is None else None
    require_positive("accuracy", accuracy, "1")
    for name in ("axial_modes", "gauss_points"):
        if getattr(grid, name) is not None:
            raise InvalidParameter(name, getattr(grid, name), "none beside accuracy, which goes with its own")
    return accuracy


def _finer(grid: Discretisation) -> int:
    """The control points that a discretisation is checked against: a few more, or twice the spans."""
    return grid.points + MORE if grid.basis == "bezier" else 2 * grid.points - 3


def search(
    design: Design,
    accuracy: float,
    attempt: Callable[[int, int], tuple[float, Found] | None],
) -> _Search[Found]:
    """Raise the control points, from those of the design on, until the estimate is below ``accuracy``.

    attempt: solves with two numbers of control points and returns the estimated error of the first, and its
    answer, or None where they do not have one.
    """
    grid = design.discretisation
    if grid.control_points is None:
        grid = replace(grid, control_points=FIRST)
    most = max(MOST[grid.basis], grid.points)
    best: _Search[Found] = _Search(
        accuracy=accuracy, error=math.inf, control_points=grid.points, trials=(), found=None
    )
    levels: list[tuple[int, float]] = []
    while True:
        n, outcome = grid.points, attempt(grid.points, _finer(grid))
        best = replace(best, trials=(*best.trials, n))
        if outcome is not None:
            levels.append((n, outcome[0]))
            if outcome[0] < best.error:
                best = replace(best, error=outcome[0], control_points=n, found=outcome[1])
        if best.error <= accuracy or n == most:
            return best
        following = _finer(grid) if grid.basis == "bspline" else _next_count(levels, accuracy, n)
        grid = replace(grid, control_points=min(following, most))


def _next_count(levels: list[tuple[int, float]], accuracy: float, tried: int) -> int:
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


def answered(
    design: Design,
    accuracy: float | None,
    solve: Callable[[int | None, Progress | None, bool], StaticSolution],
    progress: Progress | None,
    increments: int,
) -> StaticSolution:
    """A path with the control points that an accuracy takes, or else the design's.

    solve: the answer with a number of control points, what is told of its increments, and whether sections
    are by balance, as they are where paths with several numbers are compared.
    """
    chosen = wanted(accuracy, design)
    if chosen is None:
        return solve(design.discretisation.control_points, progress, False)
    least = DOUBTFUL if accuracy is None else None
    solution = _solve_accurately(design, chosen, lambda points: solve(points, None, True), least)
    if progress is not None:
        progress(increments, increments)
    return solution


def _solve_accurately(
    design: Design, accuracy: float, solve: Callable[[int], StaticSolution], least: float | None
) -> StaticSolution:
    """The path with as many control points as the accuracy takes.

    solve: the answer with a number of control points. An accuracy that is not reached is the status
    NOT_CONVERGED of the best answer, or only where its error is not below ``least``: the answer's resolution
    tells it else. A path that stops at the same thing with any number is compared up to
    there and returned with its reason; where none is followed to the same end, it is that of the most points.
    """
    solved = cache(solve)

    def attempt(fewer: int, more: int) -> tuple[float, tuple[StaticSolution, dict[str, float]]] | None:
        coarse, fine = solved(fewer), solved(more)
        if not _end_alike(coarse, fine):
            return None
        errors = distances(design, coarse, fine)
        return max(errors.values()), (coarse, errors)

    outcome = search(design, accuracy, attempt)
    if outcome.found is None:
        return solved(outcome.trials[-1])
    answer, errors = outcome.found
    estimate = ErrorEstimate(
        accuracy=accuracy,
        **errors,
        control_points=outcome.control_points,
        trials=outcome.trials,
    )
    failed = outcome.error > max(accuracy, least or 0.0)
    if failed and answer.status is Status.CONVERGED:
        answer = replace(answer, status=Status.NOT_CONVERGED, message=outcome.message)
    return replace(answer, estimate=estimate)


def _end_alike(one: StaticSolution, other: StaticSolution) -> bool:
    """Whether two paths have the same status, and where they stop early about the same end."""
    return one.status is other.status and (one.status is Status.CONVERGED or _in_step(one, other))


def distances(design: Design, answer: StaticSolution, better: StaticSolution) -> dict[str, float]:
    """Errors of an answer against a better one by the names of ``ErrorEstimate``, each over the largest
    magnitude on its path.

    Places over the largest displacement, turns over the largest turn, section forces over the largest force
    and the largest moment. What is none but round-off is held against its unit: strip length, rad, EI/L.
    Paths by arc length have no states in common but their ends, which are compared then.
    """
    length = max(strip.length for strip in design.strips)
    moment = max(strip.flexural_rigidity / strip.length for strip in design.strips)
    stress = max(strip.flexural_rigidity / strip.length / _modulus(strip) for strip in design.strips)
    rows = slice(None) if _in_step(answer, better) else slice(-1, None)

    def error(of: Callable[[StaticSolution], Array], unit: float) -> float:
        mine, right = of(answer)[rows], of(better)[rows]
        return _relative(mine - right, right, unit)

    forces = error(lambda path: np.stack((path.axial_force, path.shear_force), axis=1), moment / length)
    return {
        "trajectory": max(error(_moved, length), error(_turned, 1.0)),
        "torque": error(lambda path: path.torque, moment),
        "stiffness": error(lambda path: path.stiffness, moment),
        "section_forces": max(error(lambda path: path.bending_moment, moment), forces),
        "stress": error(lambda path: _stress(design, path), stress),
    }


def _in_step(one: StaticSolution, other: StaticSolution) -> bool:
    """Whether two paths have the states of the same load factors and rotations, about so where they end."""
    mine, others = (
        np.stack((p.load_factor, p.rotation if p.driven else p.load_factor)) for p in (one, other)
    )
    if mine.shape != others.shape:
        return False
    apart = np.abs(mine - others)
    return bool(apart[:, :-1].max(initial=0.0) <= SAME_STATE and apart[:, -1].max() <= SAME_END)


def _relative(apart: Array, right: Array, unit: float) -> float:
    """Largest of the differences over the largest that is right, or over the unit; 0 of nothing."""
    if right.size == 0 or np.isnan(right).all():
        return 0.0
    scale = float(np.abs(right).max())
    return float(np.abs(apart).max()) / (scale if scale > NOTHING * unit else unit)


def _moved(path: StaticSolution) -> Array:
    """Displacements x + iy of the bodies, or of the strips' ends where there are none (S, B) [m]."""
    places = np.stack(list(path.bodies.values()), axis=1) if path.bodies else path.shape[:, :, -1]
    moved = places - places[0]
    return np.asarray(moved[..., 0] + 1j * moved[..., 1])


def _turned(path: StaticSolution) -> Array:
    """Rotations of the bodies that are not driven (S, B) [rad]."""
    if not set(path.bodies) - {path.driven}:
        return np.zeros((len(path.load_factor), 0))
    return np.stack([at[:, 2] for name, at in path.bodies.items() if name != path.driven], axis=1)


def _modulus(strip: StripDesign) -> float:
    """Section modulus of the rectangle that A and I imply [m^3]."""
    return math.sqrt(strip.area * strip.second_moment_of_area / 3.0)


def _stress(design: Design, path: StaticSolution) -> Array:
    """Largest stress of each strip, |N|/A + |M|/W (S, G) [Pa]."""
    area = np.array([[strip.area] for strip in design.strips])
    modulus = np.array([[_modulus(strip)] for strip in design.strips])
    return np.asarray((np.abs(path.axial_force) / area + np.abs(path.bending_moment) / modulus).max(axis=2))
