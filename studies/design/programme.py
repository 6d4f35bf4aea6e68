"""A sizing question as a smooth programme: scaled variables, constraints below zero, exact Jacobians.

The unknowns are the N variables over their bounds, y in [0, 1]^N, and the bound t of the objective:

    min t   with   objective at every state <= t,   stiffness = wanted,   |fibre stress| <= allowable, ...

so that the largest over states and stations, which has kinks, is never differentiated. Its conditions of
Karush, Kuhn and Tucker say what holds a design back, and what each constraint costs. All rows are relative
to what they are held against: the start's objective, the wanted stiffness, the allowable stress.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from scipy.optimize import nnls

from studies.design.evaluate import CENTRE_SHIFT, STIFFNESS, STRESS, TRAVEL, Answers, Followed, PathEnds
from studies.design.question import Question
from studies.errors import BadInput
from studies.kinds import Array

#: Stands for every row of a design without an answer: far outside, so that a line search comes back.
OUTSIDE = -1e3
#: Change of the objective over that of a limit, both relative, below which it is round-off.
LEAST_PRICE = 1e-6
#: Margin below which a row is active [1].
ACTIVE = 1e-6
#: Starts of a search unless it says otherwise: the design to compare with and points spread over the bounds.
STARTS = 8
#: Part of a limit below which it is met [1].
MET = 1e-6


class _Rows(NamedTuple):
    """A constraint: margins (R,) that must not be below zero [1], and their gradients by y and t (R, N + 1).

    name: of the quantity, or of the variable at its bound. fall: of the margins, where they are zero, over a
    relative change of the limit.
    """

    name: str
    margin: Array
    by: Array
    fall: float


class Active(NamedTuple):
    """A constraint that holds an optimum back.

    price: relative change of the objective over a relative change of the limit, to first order [1].
    """

    name: str
    price: float


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
            except (PathEnds, BadInput) as error:  # the model may refuse a design that is none of the case's
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
        if name == CENTRE_SHIFT:  # squares are smooth at zero, and t is then the square too
            yield self._below(name, found.followed[name], self.scale**2, y[-1], eye[-1], signs=(1.0,))
        else:
            yield self._below(name, found.followed[name], self.scale, y[-1], eye[-1])
        stress = self._below(STRESS, found.followed[STRESS], asked.allowable_stress, 1.0, 0.0 * eye[-1])
        yield stress._replace(name="allowable stress" if name == STRESS else STRESS, fall=-1.0)
        values, span = asked.values(y), np.append(asked.span, 0.0)
        for ratio in asked.ratios:
            side, limit = ratio.side / asked.variables[0].high, ratio.limit
            margin = side * (values[ratio.top] - limit * values[ratio.bottom])
            by = side * span * (eye[ratio.top] - limit * eye[ratio.bottom])
            yield _Rows(ratio.name, np.array([margin]), by[None], side * limit * values[ratio.bottom])
        yield self._below(
            STIFFNESS, found.followed[asked.held], asked.wanted, -1.0, 0.0 * eye[-1], signs=(-1.0,)
        )

    def _below(
        self,
        name: str,
        found: Followed,
        limit: float,
        bound: float,
        by_bound: Array,
        signs: tuple[float, ...] = (1.0, -1.0),
    ) -> _Rows:
        """Return the rows of values over a limit that are to be below a bound, those of these signs."""
        value, by = found.value / limit, np.pad(found.by * self.question.span / limit, ((0, 0), (0, 1)))
        margin, jacobian = (
            [of - sign * each for sign in signs] for of, each in ((bound, value), (by_bound, by))
        )
        return _Rows(name, np.concatenate(margin), np.concatenate(jacobian), 1.0)

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

    def conditions(self, y: Array, found: Answers) -> tuple[tuple[Active, ...], float]:
        """Return the active constraints of a point y (N + 1,) [1] and the residual of the conditions [1].

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
        reached += [(held.name, sign, sign * held.by[0]) for sign in (1.0, -1.0)]
        multipliers, residual = nnls(np.column_stack([by for _, _, by in reached]), np.eye(len(y))[-1])
        prices: dict[str, float] = {}
        for (name, fall, _), multiplier in zip(reached, multipliers, strict=True):
            prices[name] = prices.get(name, 0.0) + float(fall * multiplier)
        prices.pop(self.question.objective, None)
        whole = (2.0 if self.question.objective == CENTRE_SHIFT else 1.0) * y[-1]
        told = ((name, price / whole) for name, price in prices.items())
        return tuple(Active(name, price) for name, price in told if abs(price) > LEAST_PRICE), float(residual)


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
