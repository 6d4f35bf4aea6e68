"""Accuracy: as many control points as a wanted accuracy takes, with an error estimate.

An answer is estimated by what changes when each strip, or each of its segments, gets a few control points
more. The error falls by a factor of 3 to 50 a point, in steps that are not even, so that after
three more it is small against the one that is estimated. Where more points do not help, as in boundary layers
under tension or where a strip rolls up, it is cut into twice as many segments. Trial paths are compared by
state.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cache, partial
from typing import Any, Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

from spline_model.confirmed import (
    MORE,
    Grid,
    Outcome,
    confirmed,
    distances,
    ends_alike,
    finer,
    in_step,
)
from spline_model.design import Design
from spline_model.discretisation import Discretisation
from spline_model.errors import InvalidParameter, require_positive
from spline_model.solution import ErrorEstimate, Status, largest, named
from spline_model.static_answers import StaticSolution

Array = NDArray[np.float64]
Found = TypeVar("Found")

DEFAULT = 1e-4
"""Relative error of the answer to a design that leaves its control points open."""
FIRST = 8
"""Control points of the first trial of such a design, and of each segment of one that is cut."""
DOUBTFUL = 0.03
"""Error of such an answer that is a failure; above DEFAULT its resolution tells it."""
MOST = 20
"""Control points of a segment at which the search ends, by round-off."""
MOST_CUT = 11
"""Control points from which on a strip is cut rather than raised where no trial has an answer."""
MOST_SEGMENTS = 16
"""Segments of a strip at which the search ends."""
FLOOR = 1e-8
"""Error below which a strip is not cut any more: what is left is round-off."""
OF_ROOTS = 3.0
"""Error of spread roots over what changes with twice the segments: 1.8 to 3.3 on guides led aside."""
ROOTS = "accuracy {:.3g} is not reached: roots leave an estimated error of {:.2g}; the elements have springs"
"""Message where it is the compliance of roots, spread along a segment, that misses the accuracy."""
FIRST_GAIN = 6.0
"""By how much a control point is expected to lower the error before it was measured."""
GAINS = (2.0, 12.0)
"""Limits of what is believed of a measured gain: the error does not fall evenly."""
ROUGH = 4.0
"""Growth of the error with more control points of a segment that is round-off."""
PATIENCE = 3
"""Trials in a row with a larger error than the best that end a search."""
FARTHER = 0.1
"""Part of its way by which a path has to come farther with twice the segments to be cut again, unless the
doublings that are left would reach its end at that pace: strips that roll up come twice as far with each."""


@dataclass(kw_only=True)
class Search(Generic[Found]):
    """Which discretisations a design tries, and the best of them: every answer is chosen by this.

    accuracy: wanted error [1]; grid: discretisation of the design, whose number of control points, or FIRST,
    is the first trial; most_segments: into how many a strip may be cut. at: the next trial, or the last one
    when it has ``ended``; trials: those that were made. error: the least estimated one [1], inf where no
    trial had an answer, of the one that was ``best``; found: its answer; worse: trials with a larger error
    since then. stuck: whether more segments than those of the trials will not help either, where none had an
    answer.
    """

    accuracy: float
    grid: Discretisation
    most_segments: int
    stuck: Callable[[tuple[Grid, ...]], bool] = lambda trials: False
    error: float = math.inf
    found: Found | None = None
    ended: bool = False
    trials: tuple[Grid, ...] = ()
    at: Grid = field(init=False)
    best: Grid = field(init=False)
    levels: list[tuple[int, float]] = field(init=False, default_factory=list)
    worse: int = field(init=False, default=0)

    def __post_init__(self) -> None:
        own = self.grid.control_points
        self.at = self.best = self.grid.segments, FIRST if own is None else own

    @property
    def message(self) -> str:
        """Why the search did not reach its accuracy; empty if it did."""
        if self.error <= self.accuracy:
            return ""
        return (
            f"accuracy {self.accuracy:.3g} is not reached with up to {named(*self.trials[-1])}: the "
            f"least estimated error is {self.error:.2g}, with {named(*self.best)}; ask for no less"
        )

    @property
    def tried(self) -> tuple[int, ...]:
        """Control points of a strip in each trial, those that two segments share counted once."""
        return tuple(segments * (points - 1) + 1 for segments, points in self.trials)

    def judge(self, error: float | None, found: Found | None = None) -> bool:
        """Take the estimated error of a trial and set the next trial, if there is one.

        error: estimated error [1]; None for a trial without an answer. found: answer of the trial.
        Returns whether the trial is the best so far. There is no next one if the accuracy is reached.
        """
        self.trials, better = (*self.trials, self.at), False
        if error is not None:
            self.levels.append((self.at[1], error))
            self.worse += 1
            if better := error < self.error:
                self.error, self.found, self.best, self.worse = error, found, self.at, 0
        self.ended = self.error <= self.accuracy or self.worse == PATIENCE or not self._go_on()
        return better

    def _go_on(self) -> bool:
        """Set the next trial: more control points, or twice the segments where those do not help."""
        (segments, points), most = self.at, max(MOST, self.trials[0][1])
        expected, may_cut = self._expected(), 2 * segments <= self.most_segments and self.error > FLOOR
        far = expected > most and len(self.levels) > 1 if self.levels else points >= MOST_CUT
        if len(self.levels) > 1 and self.levels[-1][1] > ROUGH * self.levels[-2][1]:
            most = points
        if points < most and not (far and may_cut):
            self.at = segments, min(expected, most)
        elif may_cut and (self.levels or not self.stuck(self.trials)):
            self.at, self.levels = (2 * segments, FIRST), []
        return self.at != self.trials[-1]

    def _expected(self) -> int:
        """The count at which the accuracy is expected, from the errors known so far.

        The one that an estimate was made with is solved already: a count a little below costs more than it.
        """
        points = self.at[1]
        if not self.levels or self.levels[-1][0] != points:
            return points + MORE
        (n, error), gain = self.levels[-1], FIRST_GAIN
        if len(self.levels) > 1:
            before, larger = self.levels[-2]
            gain = float(np.clip((larger / error) ** (1.0 / (n - before)), *GAINS))
        return n + max(MORE, math.ceil(math.log(error / self.accuracy) / math.log(gain)))


def wanted(accuracy: float | None, design: Design) -> float | None:
    """Return the accuracy [1] that control points are raised for; None: the number of the design is kept.

    A design without a number has the accuracy DEFAULT.

    Raises
    ------
    InvalidParameter
        An accuracy that is not a positive number, or settings that the accuracy chooses itself.
    """
    grid = design.discretisation
    if accuracy is None:
        return DEFAULT if grid.control_points is None else None
    require_positive("accuracy", accuracy, "1")
    for name in ("axial_modes", "gauss_points"):
        if getattr(grid, name) is not None:
            raise InvalidParameter(name, getattr(grid, name), "none beside accuracy, which goes with its own")
    return accuracy


def search(
    grid: Discretisation,
    accuracy: float,
    attempt: Callable[[Grid, Grid], tuple[float, Found] | None],
    **more: Any,
) -> Search[Found]:
    """Raise the control points, from those of ``grid`` on, until the estimate is below ``accuracy`` [1].

    attempt: solves with two discretisations and returns the estimated error [1] of the first, and its answer,
    or None if one of them has no answer; more: of a ``Search``. Returns the finished search, whose ``found``
    is the answer with the least estimated error.
    """
    outcome: Search[Found] = Search(accuracy=accuracy, grid=grid, most_segments=MOST_SEGMENTS, **more)
    while not outcome.ended:
        tried = attempt(outcome.at, finer(*outcome.at))
        outcome.judge(*((None,) if tried is None else tried))
    return outcome


def answered(
    design: Design,
    accuracy: float | None,
    solve: Callable[[Grid, bool], StaticSolution],
    way: float,
    check: bool = True,
) -> StaticSolution:
    """Return the path with the control points that an accuracy [1] needs; without one, those of the design.

    solve: returns the answer of a discretisation, given whether section forces are by balance (as if paths
    with several numbers are compared). way: length of the path that is
    asked for, as of ``_reach``. check: whether critical points and
    early ends of the design's own control points are compared with those of more.
    """
    chosen, grid = wanted(accuracy, design), design.discretisation
    own = grid.segments, grid.points
    if chosen is None and not check:
        return solve(own, False)
    outcome = cache(lambda trial: solve(trial, chosen is not None))
    if chosen is None:
        return confirmed(outcome, own)
    return _solve_accurately(design, chosen, outcome, way, DOUBTFUL if accuracy is None else None)


def _solve_accurately(
    design: Design, accuracy: float, solved: Outcome, way: float, least: float | None
) -> StaticSolution:
    """The path with as many control points as the accuracy takes.

    An accuracy that is not reached is the status
    NOT_CONVERGED of the best answer, or only where its error is not below ``least``: the answer's resolution
    tells it else. A path that stops at the same thing with any number is compared up to there and returned
    with its reason. Where no two numbers lead to the same end, it is not resolved.
    """
    attempt, stuck = partial(_attempt, design, solved), partial(_stuck, solved, way)
    outcome = search(design.discretisation, accuracy, attempt, stuck=stuck)
    if outcome.found is None:
        return confirmed(solved, outcome.trials[-1], searched=True)
    answer, of_refinement = outcome.found
    if not answer.settled:
        return answer
    segments, points = outcome.best
    message, errors = outcome.message, of_refinement
    if design.root_length:
        halves = solved((2 * segments, max(FIRST, points // 2 + 2)))
        if ends_alike(answer, halves):  # segments of half the length take the part 1 / OF_ROOTS of the error
            apart = distances(design, answer, halves)
            errors = {name: float(np.fmax(error, OF_ROOTS * apart[name])) for name, error in errors.items()}
        message = message or ROOTS.format(accuracy, largest(errors.values()))
    estimate = ErrorEstimate(
        accuracy=accuracy, errors=errors, segments=segments, control_points=points, trials=outcome.tried
    )
    judged = errors
    if least is not None:
        # no failures that were not asked about: the stiffness of a body may pass through zero, and roots are
        # springs or spread by choice of the model
        judged = {name: error for name, error in of_refinement.items() if name != "body_stiffness"}
    failed = largest(judged.values()) > max(accuracy, least or 0.0)
    if failed and answer.status is Status.CONVERGED:
        answer = replace(answer, status=Status.NOT_CONVERGED, message=message)
    return replace(answer, estimate=estimate)


def _stuck(solved: Outcome, way: float, trials: tuple[Grid, ...]) -> bool:
    """Whether the last doubling of the segments brought no path much farther, and those that are left would
    not bring one to its end at that pace."""
    segments = trials[-1][0]
    solved_ones = [(grid, _reach(solved(grid))) for trial in trials for grid in (trial, finer(*trial))]
    earlier, last = ([far for grid, far in solved_ones if grid[0] == k] for k in (segments // 2, segments))
    if not earlier:
        return False
    before, here = max(earlier), max(last)
    doublings = math.log2(MOST_SEGMENTS / segments)
    return here - before < min(FARTHER * before, (way - here) / doublings)


def _reach(path: StaticSolution) -> float:
    """How far a path came: the share of its weight that acts, then changes of its load factor [1] and of a
    driven rotation [rad]."""
    rotation = path.rotation if path.driven else np.zeros(1)
    return path.grown + float(np.abs(np.diff(path.load_factor)).sum() + np.abs(np.diff(rotation)).sum())


def _attempt(
    design: Design, solved: Outcome, fewer: Grid, more: Grid
) -> tuple[float, tuple[StaticSolution, dict[str, float]]] | None:
    """The largest error of an answer, itself with all errors; None where a finer one does not end alike."""
    coarse, fine = solved(fewer), solved(more)
    if not ends_alike(coarse, fine):
        return None
    if not coarse.settled:
        return 0.0, (coarse, {})
    if coarse.status is not Status.CONVERGED and not in_step(coarse, fine):
        return None
    errors = distances(design, coarse, fine)
    return largest(errors.values()), (coarse, errors)
