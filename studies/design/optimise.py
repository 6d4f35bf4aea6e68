"""Sizing from several starts: first to a feasible design near by, then sequential quadratic programming.

Both with exact gradients. Far outside the constraints the minimisation goes astray: where it ended there
would hang on round-off.
"""

import math
from dataclasses import dataclass, replace
from operator import itemgetter
from typing import Any

import numpy as np
from scipy.optimize import lsq_linear, minimize

from studies.design.evaluate import Accurate, Answers
from studies.design.programme import Active, Programme, missed
from studies.design.question import Question
from studies.kinds import Array, Progress

MOST_ITERATIONS = 100
#: Designs after which a start is not continued: of all questions of the study one takes 125 at most.
MOST_PATHS = 300
#: Times that the optimiser is started again where it stopped short of an optimum.
MOST_RUNS = 4
#: Change of the objective, over the start's, below which the optimiser stops.
PRECISION = 1e-10
#: Largest violation of any row that counts as none [1].
FEASIBLE = 1e-6
#: Largest violation that is left to the minimisation [1].
NEARLY = 1e-3
#: Longest step to a feasible design, of a variable's bounds, and the shortest before it is given up.
LONGEST, SHORTEST = 0.25, 1e-6
#: Part of the foretold decrease of the violations that a step has to reach.
KEPT = 0.1
#: Stiffness over the wanted one below which no logarithm tells more.
SOFTEST = 1e-2
#: Times that a start without an answer is moved half of the way to one that has an answer.
MOST_MOVES = 4
#: Weight of a step's length beside the violations that it leaves.
LENGTH = 1e-3
#: Residual of the Karush-Kuhn-Tucker conditions below which a point is an optimum, relative to the gradient.
STATIONARY = 1e-3
#: Two optima are one if their objectives differ by less [1].
SAME = 1e-3


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """Where one start led.

    Attributes:
        at: scaled variables (N + 1,) where it ended, t last.
        converged: whether it is feasible and meets the Karush-Kuhn-Tucker conditions; message: otherwise why.
        design: the design there; answers: its own; both None where its path does not reach the end.
        objective: largest value over the range [m or 1]; violation: of the worst row [1].
        residual: of the Karush-Kuhn-Tucker conditions, relative; active: the constraints that hold.
        solved: designs that were solved.
    """

    at: Array
    converged: bool
    message: str
    design: Any
    answers: Any
    objective: float
    violation: float
    residual: float
    active: tuple[Active, ...]
    solved: int


def optimise(question: Question, start: Array) -> Outcome:
    """Return the outcome of a minimisation from a scaled start (N,) [1].

    If the start has no answer, a nearer one that has an answer is used. A feasible end that is not stationary
    is continued, with a new approximation of the curvature.
    """
    programme = Programme(question=question)
    known = question.scaled(question.own)
    moves = (known + 0.5**k * (start - known) for k in range(MOST_MOVES + 1))
    begin = next((at for at in moves if programme.answers(at) is not None), None)
    if begin is None:
        return _outcome(programme, start, None)
    outcome = _run(programme, _feasible(programme, begin))
    for _ in range(MOST_RUNS - 1):
        if outcome.converged or outcome.violation > FEASIBLE or programme.solved >= MOST_PATHS:
            break
        outcome = _run(programme, outcome.at[:-1])
    return outcome


def _feasible(programme: Programme, at: Array) -> Array:
    """Return the scaled variables (N,) of a feasible design near ``at``, or of the least violation there.

    Each step is the shortest that leaves the linearised constraints least violated, shortened where needed.
    """
    beyond, jacobian = _graded(*programme.excesses(at))
    reach = LONGEST
    for _ in range(MOST_ITERATIONS):
        left = _violated(beyond)
        if np.abs(left).max() <= NEARLY or reach < SHORTEST:
            break
        step = _towards(beyond, jacobian, np.maximum(-at, -reach), np.minimum(1.0 - at, reach))
        foretold = left @ left - np.sum(_violated(beyond + jacobian @ step) ** 2)
        if foretold <= PRECISION:
            break
        there = np.clip(at + step, 0.0, 1.0)
        new, slope = _graded(*programme.excesses(there))  # of a design without an answer: far outside
        if left @ left - np.sum(_violated(new) ** 2) >= KEPT * foretold:
            at, beyond, jacobian = there, new, slope
        else:
            reach *= 0.25
    return at


def _graded(excess: Array, jacobian: Array) -> tuple[Array, Array]:
    """Return the logarithms of stiffness and of what is beyond its limit, over wanted and limit, and other
    excesses as they are, with their Jacobian: by the logarithm sizes act nearly in proportion."""
    over = excess > 0.0
    over[-1] = True
    ratio = np.where(over, np.maximum(1.0 + excess, SOFTEST), 1.0)
    return np.where(over, np.log(ratio), excess), jacobian / ratio[:, None]


def _violated(excess: Array) -> Array:
    """Return what of the excesses is a violation: all beyond the limit, and the equality's to either side."""
    return np.append(np.maximum(excess[:-1], 0.0), excess[-1])


def _towards(excess: Array, jacobian: Array, low: Array, high: Array) -> Array:
    """Return the shortest step within bounds (N,) that leaves the linearised excesses least violated.

    Least squares of violations, each with a slack of at least zero for what its row holds by, and the step.
    """
    near = excess + np.abs(jacobian) @ np.maximum(-low, high) > 0.0  # others hold after any such step
    near[-1] = True
    excess, jacobian = excess[near], jacobian[near]
    size, slacks = len(low), len(excess) - 1
    rows = np.zeros((slacks + 1 + size, size + slacks))
    rows[: slacks + 1, :size] = jacobian
    rows[:slacks, size:] = np.eye(slacks)
    rows[slacks + 1 :, :size] = LENGTH * np.eye(size)
    bounds = (np.append(low, np.zeros(slacks)), np.append(high, np.full(slacks, np.inf)))
    wanted = np.append(-excess, np.zeros(size))
    step: Array = lsq_linear(rows, wanted, bounds, method="bvls").x[:size]  # type: ignore[operator]
    return step


def _run(programme: Programme, at: Array) -> Outcome:
    """Run the optimiser once from ``at``, which has an answer; of a run that ends outside the constraints, or
    where there is no answer, its better end."""
    begin = programme.answers(at)
    assert begin is not None, "it has an answer"
    objective = begin.largest(programme.question.objective)

    constraints = [
        {
            "type": kind,
            "fun": lambda x, at=at: at(programme.rows(x)[0]),
            "jac": lambda x, at=at: at(programme.rows(x)[1]),
        }
        for kind, at in (("ineq", itemgetter(slice(-1))), ("eq", itemgetter(slice(-1, None))))
    ]
    found = minimize(
        lambda x: (x[-1], np.eye(len(x))[-1]),
        np.append(at, programme.relative(objective)),
        jac=True,
        method="SLSQP",
        bounds=[(0.0, 1.0)] * len(at) + [(0.0, None)],
        constraints=constraints,
        options={"maxiter": MOST_ITERATIONS, "ftol": PRECISION},
    )
    end = _outcome(programme, found.x, programme.answers(found.x), str(found.message))
    if end.violation <= FEASIBLE:
        return end
    nearer = _outcome(programme, at, begin, str(found.message))
    return replace(min((nearer, end), key=lambda each: each.violation), solved=programme.solved)


def search(question: Question, begin: Array, progress: Progress) -> list[Outcome]:
    """Return the outcomes of minimisations from scaled starts (K, N) [1]; `progress` counts starts."""
    outcomes: list[Outcome] = []
    for start in begin:
        progress(len(outcomes), len(begin))
        outcomes.append(optimise(question, start))
    progress(len(begin), len(begin))
    return outcomes


def settled(question: Question, found: Outcome) -> tuple[Outcome, Accurate]:
    """Return an optimum with the control points that its own answers take, found again with them if these are
    more than it was found with, and what it answers."""
    while True:
        answers = question.accurate(question.values(found.at))
        if answers.control_points <= question.control_points:
            return found, answers
        question = replace(question, control_points=answers.control_points)
        again = optimise(question, found.at[:-1])
        if not again.converged:
            return found, answers
        found = again


def best(outcomes: list[Outcome]) -> Outcome | None:
    """Return the optimum with the least objective; None if no start has led to one.

    Of a design and its mirror image, which answer the same, the one with the smaller body.
    """
    least = [each for number, each in zip(numbered(outcomes), outcomes, strict=True) if number == 1]
    ratio = "crossing_ratio"
    return max(least, key=lambda each: getattr(each.design, ratio, -each.objective), default=None)


def numbered(outcomes: list[Outcome]) -> list[int]:
    """Return the number of every outcome's optimum, the best 1; 0 for what is none.

    Two with the same objective are one: sizes may lie on a line of equals, and a design and its mirror image,
    with ground and body exchanged (crossing ratio r and 1 - r), have the same answers.
    """
    known: list[float] = []
    numbers = [0] * len(outcomes)
    for k in sorted(
        (k for k, each in enumerate(outcomes) if each.converged), key=lambda k: outcomes[k].objective
    ):
        objective = outcomes[k].objective
        if not known or objective > known[-1] * (1.0 + SAME):
            known.append(objective)
        numbers[k] = len(known)
    return numbers


def _outcome(programme: Programme, at: Array, found: Answers | None, message: str = "") -> Outcome:
    """Return what is known of the design at scaled variables (N,), or (N + 1,), by its answers, where the
    search ended with a message; of one whose path ends early next to nothing."""
    question = programme.question
    at, values = np.append(at[: len(question.span)], math.nan), question.values(at)
    active: tuple[Active, ...] = ()
    residual, violation, objective = math.nan, math.inf, math.nan
    if found is None:
        message = f"no answer over the range: {programme.ended}"
    else:
        objective = found.largest(question.objective)
        at[-1] = programme.relative(objective)
        violation = float(np.abs(_violated(programme.excesses(at)[0])).max())
        active, residual = programme.conditions(at, found)
        if violation > FEASIBLE:
            message = f"no design here meets the constraints: {missed(question, values, found)}"
        elif residual > STATIONARY:
            message = f"not stationary (residual {residual:.1e}): {message}"
        else:
            message = ""
    return Outcome(
        at=at,
        converged=not message,
        message=message,
        design=None if found is None else question.design(values),
        answers=found,
        objective=objective,
        violation=violation,
        residual=residual,
        active=active,
        solved=programme.solved,
    )
