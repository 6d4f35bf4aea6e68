"""A sizing question as a smooth programme, and its minimisation from several starts.

The unknowns are the N variables over their bounds, y in [0, 1]^N, and the bound t of the objective:

    min t   with   objective at every state <= t,   stiffness = wanted,   |fibre stress| <= allowable, ...

so that the largest over states and stations, which has kinks, is never differentiated. Its conditions of
Karush, Kuhn and Tucker say what holds a design back, and what each constraint costs. All rows are relative
to what they are held against: the start's objective, the wanted stiffness, the allowable stress.

Each start leads first to a feasible design near by, then sequential quadratic programming goes on, both with
exact gradients. Far outside the constraints the minimisation goes astray: where it ended there would hang on
round-off.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np
from scipy.optimize import lsq_linear, minimize, nnls

from studies.design import evaluate
from studies.design.evaluate import CENTRE_SHIFT, STIFFNESS, STRESS, TRAVEL, Answers, Followed
from studies.design.question import Question
from studies.errors import BadInput
from studies.kinds import Array, Progress
from studies.record.progress import watched

#: Stands for every row of a design without an answer: far outside, so that a line search comes back.
OUTSIDE = -1e3
#: Change of the objective over that of a limit, both relative, below which it is round-off.
LEAST_PRICE = 1e-6
#: Margin below which a row is active [1].
ACTIVE = 1e-6
#: Signs of a quantity that is held to either side.
SIDES = (1.0, -1.0)
#: Starts of a search unless it says otherwise: the design to compare with and points spread over the bounds.
STARTS = 8
#: Part of a limit below which it is met [1].
MET = 1e-6
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


class _Rows(NamedTuple):
    """A constraint: margins (R,) that must not be below zero [1], and their gradients by y and t (R, N + 1).

    name: of the quantity, or of the variable at its bound. fall: of the margins, where they are zero, over a
    relative change of the limit.
    """

    name: str
    margin: Array
    by: Array
    fall: float


@dataclass(kw_only=True)
class Programme:
    """The optimisation problem of a question, in scaled variables (N,) [1].

    `scale` is the largest objective of the design to compare with, in its unit. The object counts solved
    designs, and keeps the last answer and the reason why the last path `ended` early.

    Raises:
        PathEnds: the design to compare with has no answer.
    """

    question: Question
    scale: float = field(init=False)
    solved: int = 0
    ended: str = ""
    _last: tuple[bytes, Answers | None] = field(default=(b"", None), repr=False)

    def __post_init__(self) -> None:
        given = self.question.answers()
        self.scale = given.largest(self.question.objective)
        own = np.append(self.question.scaled(self.question.own), 1.0)
        self._count = sum(len(rows.margin) for rows in self.limits(own, given))

    def answers(self, y: Array) -> Answers | None:
        """Return the answers at relative variables y (N + 1,) [1]; None if the path ends early."""
        key = y[: len(self.question.span)].tobytes()
        if key != self._last[0]:
            self.solved += 1
            try:
                found = self.question.answers(self.question.values(y))
            except (
                evaluate.PathEnds,
                BadInput,
            ) as error:  # the model may refuse a design that is none of the case's
                found, self.ended = None, str(error)
            self._last = (key, found)
        return self._last[1]

    def relative(self, objective: float) -> float:
        """Return t [1] of an objective in SI units: over the scale, and squared for the centre shift."""
        ratio = objective / self.scale
        return ratio**2 if self.question.objective == CENTRE_SHIFT else ratio

    def limits(self, y: Array, found: Answers) -> Iterator[_Rows]:
        """Yield the constraints at a point y (N + 1,) [1] with these answers.

        They are the objective below t, the stress, the ratios, which are linear in the variables, and last
        the equality: stiffness, or travel, over the wanted one less one.
        """
        asked, name, eye = self.question, self.question.objective, np.eye(len(y))
        squared = name == CENTRE_SHIFT  # squares are smooth at zero, and t is then the square too
        scale, signs = (self.scale**2, (1.0,)) if squared else (self.scale, SIDES)
        yield _Rows(name, *self._below(found.followed[name], scale, signs, y[-1], by_t=1.0), 1.0)
        stress = self._below(found.followed[STRESS], asked.allowable_stress, SIDES, 1.0)
        yield _Rows("allowable stress" if name == STRESS else STRESS, *stress, -1.0)
        values, span = asked.values(y), np.append(asked.span, 0.0)
        for ratio in asked.ratios:
            side, limit = ratio.side / asked.variables[0].high, ratio.limit
            margin = side * (values[ratio.top] - limit * values[ratio.bottom])
            by = side * span * (eye[ratio.top] - limit * eye[ratio.bottom])
            yield _Rows(ratio.name, np.array([margin]), by[None], side * limit * values[ratio.bottom])
        yield _Rows(STIFFNESS, *self._below(found.followed[asked.held], asked.wanted, (-1.0,), -1.0), 1.0)

    def _below(
        self, found: Followed, limit: float, signs: Sequence[float], bound: float, by_t: float = 0.0
    ) -> tuple[Array, Array]:
        """Return margins and gradients of values over a limit, held below a bound to these sides."""
        value, by = found.value / limit, found.by * self.question.span / limit
        margins = [bound - sign * value for sign in signs]
        jacobian = [np.pad(-sign * by, ((0, 0), (0, 1)), constant_values=by_t) for sign in signs]
        return np.concatenate(margins), np.concatenate(jacobian)

    def _bounds(self, y: Array) -> Iterator[_Rows]:
        """Yield the bounds of the variables at a point y (N + 1,)."""
        for place, variable in enumerate(self.question.variables):
            if variable.span:
                at, one = y[place : place + 1], np.eye(len(y))[place : place + 1]
                low, high = variable.low / variable.span, variable.high / variable.span
                yield _Rows(f"{variable.name} at its least", at, one, low)
                yield _Rows(f"{variable.name} at its most", 1.0 - at, -one, -high)

    def rows(self, y: Array) -> tuple[Array, Array]:
        """Return the margins of all rows (R,) [1], the last that of the equality, and their Jacobian
        (R, N + 1)."""
        found = self.answers(y)
        if found is None:
            return np.full(self._count, OUTSIDE), np.zeros((self._count, len(y)))
        limits = list(self.limits(y, found))
        return np.concatenate([rows.margin for rows in limits]), np.concatenate([rows.by for rows in limits])

    def excesses(self, y: Array) -> tuple[Array, Array]:
        """Return how far each row that does not depend on t is beyond its limit (Q,) [1], below zero where it
        holds but for the last, the equality's; and their Jacobian (Q, N)."""
        margin, jacobian = self.rows(np.append(y[: len(self.question.span)], np.inf))
        free, signs = np.isfinite(margin), np.append(np.full(self._count - 1, -1.0), 1.0)
        return (signs * margin)[free], (signs[:, None] * jacobian)[free, :-1]

    def conditions(self, y: Array, found: Answers) -> tuple[dict[str, float], float]:
        """Return the active constraints of a point y (N + 1,) [1] with their prices, and the residual of the
        conditions [1].

        A price is the relative change of the objective over a relative change of the limit, to first order.

        The gradient of t, which is 1, as a combination of the active rows' gradients with multipliers of at
        least zero, but for the equality's: the residual is the length of what is left over.
        """
        *limits, held = self.limits(y, found)
        reached = [
            (rows.name, rows.fall, by)
            for rows in (*limits, *self._bounds(y))
            for margin, by in zip(rows.margin, rows.by, strict=True)
            if margin < ACTIVE
        ]
        reached += [(held.name, sign, sign * held.by[0]) for sign in SIDES]
        multipliers, residual = nnls(np.column_stack([by for _, _, by in reached]), np.eye(len(y))[-1])
        prices: dict[str, float] = {}
        for (name, fall, _), multiplier in zip(reached, multipliers, strict=True):
            prices[name] = prices.get(name, 0.0) + float(fall * multiplier)
        prices.pop(self.question.objective, None)
        whole = (2.0 if self.question.objective == CENTRE_SHIFT else 1.0) * y[-1]
        active = {name: price / whole for name, price in prices.items() if abs(price / whole) > LEAST_PRICE}
        return active, float(residual)


def missed(question: Question, values: Array, found: Answers) -> str:
    """Return a phrase for each constraint that a design with these variables (N,) misses."""
    unit, factor = (" mm", 1e3) if question.held == TRAVEL else (" N m/rad", 1.0)
    own, stress = float(found.followed[question.held].value[0]), found.largest(STRESS)
    # name, value and limit in the unit that is told, what the limit is, and the sides it is missed to
    held = [
        (question.held, factor * own, factor * question.wanted, unit, "the wanted", (-1, 1)),
        (STRESS, 1e-6 * stress, 1e-6 * question.allowable_stress, " MPa", "at most", (1,)),
    ]
    for ratio in question.ratios:
        what = "at least" if ratio.side > 0 else "at most"
        got = values[ratio.top] / values[ratio.bottom]
        held.append((ratio.name, got, ratio.limit, "", what, (-ratio.side,)))
    told = []
    for name, got, limit, unit, what, sides in held:
        far = got / limit - 1.0
        if abs(far) > MET and math.copysign(1, far) in sides:
            told.append(f"{name}: got {got:.4g}{unit}, expected {what} {limit:.4g}{unit}")
    return "; ".join(told)


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """Where one start led.

    Attributes:
        at: scaled variables (N + 1,) where it ended, t last.
        message: why this is no optimum, if it is infeasible or misses the Karush-Kuhn-Tucker conditions.
        solved: designs that were solved.
        design: the design there; answers: its own; both None where its path does not reach the end.
        objective: largest value over the range [m or 1]; violation: of the worst row [1].
        residual: of the Karush-Kuhn-Tucker conditions, relative; active: price of each constraint that
            holds [1].
    """

    at: Array
    message: str
    solved: int
    design: Any = None
    answers: Any = None
    objective: float = math.nan
    violation: float = math.inf
    residual: float = math.nan
    active: Mapping[str, float] = field(default_factory=dict)

    @property
    def converged(self) -> bool:
        """Whether it is an optimum."""
        return not self.message


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

    rows = programme.rows
    constraints = [
        {"type": "ineq", "fun": lambda x: rows(x)[0][:-1], "jac": lambda x: rows(x)[1][:-1]},
        {"type": "eq", "fun": lambda x: rows(x)[0][-1:], "jac": lambda x: rows(x)[1][-1:]},
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
    return [optimise(question, start) for start in watched(list(begin), progress)]


def settled(question: Question, found: Outcome) -> Outcome:
    """Return an optimum with its answers by as many control points as their accuracy takes, found again with
    them if these are more than it was found with."""
    while True:
        found = replace(found, answers=question.accurate(question.values(found.at)))
        points = found.answers.control_points
        if points <= question.control_points:
            return found
        question = replace(question, control_points=points)
        again = optimise(question, found.at[:-1])
        if not again.converged:
            return found
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
    question, solved = programme.question, programme.solved
    at, values = np.append(at[: len(question.span)], math.nan), question.values(at)
    if found is None:
        return Outcome(at=at, message=f"no answer over the range: {programme.ended}", solved=solved)
    objective = found.largest(question.objective)
    at[-1] = programme.relative(objective)
    violation = float(np.abs(_violated(programme.excesses(at)[0])).max())
    active, residual = programme.conditions(at, found)
    if violation > FEASIBLE:
        said = f"no design here meets the constraints: {missed(question, values, found)}"
    else:
        said = f"not stationary (residual {residual:.1e}): {message}" if residual > STATIONARY else ""
    return Outcome(
        at=at,
        message=said,
        solved=solved,
        design=question.design(values),
        answers=found,
        objective=objective,
        violation=violation,
        residual=residual,
        active=active,
    )
