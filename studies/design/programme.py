"""A sizing question as a smooth programme: scaled variables, constraints below zero, exact Jacobians.

The unknowns are the N variables over their bounds, y in [0, 1]^N, and the bound t of the objective:

    min t   with   objective at every state <= t,   stiffness = wanted,   |fibre stress| <= allowable, ...

so that the largest over states and stations, which has kinks, is never differentiated. Its conditions of
Karush, Kuhn and Tucker say what holds a design back, and what each constraint costs. All rows are relative
to what they are held against: the start's objective, the wanted stiffness, the allowable stress.
"""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from scipy.optimize import nnls

from studies.design.evaluate import CENTRE_SHIFT, STRESS, VARIATION, Answers, PathEnds
from studies.design.task import STARTS, Sizing
from studies.kinds import Array

#: Stands for every row of a design without an answer: far outside, so that a line search comes back.
OUTSIDE = -1e3


#: Margin below which a row is active [1].
ACTIVE = 1e-6


@dataclass(frozen=True, kw_only=True)
class Active:
    """A constraint that holds an optimum back.

    Args:
        name: of the quantity, or of the variable at its bound.
        price: relative change of the objective over a relative change of the limit, to first order [1].
    """

    name: str
    price: float


@dataclass(kw_only=True)
class Programme:
    """The programme of a task; `scale` holds the largest value of every objective of the design to compare
    with, or of one beside it that has an answer, and `known` where that lies (N,), scaled.

    Counts designs that were solved, and tells `progress` of them; keeps the last design's answer, and why the
    last path `ended` early.
    """

    task: Sizing
    scale: dict[str, float]
    known: Array = field(default_factory=lambda: np.zeros(0), repr=False)
    progress: Callable[[int], None] | None = field(default=None, repr=False)
    solved: int = 0
    ended: str = ""
    _last: tuple[bytes, Answers | None] = field(default=(b"", None), repr=False)

    @classmethod
    def of(cls, task: Sizing, progress: Callable[[int], None] | None = None) -> "Programme":
        """Return the programme of a task, in whose scale the task's own design is one."""
        known, given = compared(task)
        scale = {name: given.largest(name) for name in task.objectives}
        return cls(task=task, scale=scale, known=known, progress=progress)

    def answers(self, y: Array) -> Answers | None:
        """Return the design's answers; None where its path ends early."""
        key = y[: len(self.task.span)].tobytes()
        if key != self._last[0]:
            self.solved += 1
            if self.progress is not None:
                self.progress(self.solved)
            try:
                found = self.task.answers(self.task.values(y))
            except PathEnds as error:
                found, self.ended = None, str(error)
            self._last = (key, found)
        return self._last[1]

    def inequalities(self, y: Array) -> Array:
        """Return all rows that must not be below zero (R,) [1]."""
        return self._rows(y)[0]

    def inequality_jacobian(self, y: Array) -> Array:
        """Return their Jacobian (R, N + 1)."""
        return self._rows(y)[1]

    def equality(self, y: Array) -> Array:
        """Return stiffness over the wanted one less one (1,)."""
        found = self.answers(y)
        return np.array([OUTSIDE if found is None else found.stiffness / self.task.stiffness - 1.0])

    def equality_jacobian(self, y: Array) -> Array:
        """Return its gradient (1, N + 1)."""
        found = self.answers(y)
        row = np.zeros((1, len(self.task.span) + 1))
        if found is not None:
            row[0, :-1] = found.by_stiffness * self.task.span / self.task.stiffness
        return row

    def excesses(self, y: Array) -> tuple[Array, Array]:
        """Return how far each row that does not depend on t is beyond its limit (Q,) [1], below zero where it
        holds but for the last, the equality's; and their Jacobian (Q, N)."""
        whole = np.append(y[: len(self.task.span)], np.inf)
        rows = self.inequalities(whole)
        free = np.isfinite(rows)
        excess = np.append(-rows[free], self.equality(whole))
        jacobian = np.vstack((-self.inequality_jacobian(whole)[free], self.equality_jacobian(whole)))
        return excess, jacobian[:, :-1]

    def row_names(self) -> list[str]:
        """Return what each row of `inequalities` holds."""
        states, fibres = self.task.states, 2 * self.task.fibres
        counts = {CENTRE_SHIFT: states, VARIATION: 2 * states, STRESS: fibres}
        objective = self.task.objective
        rows = [objective] * counts[objective]
        shape = list(self.task.shape(self.task.low)[2])
        return [*rows, *["allowable stress" if objective == STRESS else "stress"] * fibres, *shape]

    def _rows(self, y: Array) -> tuple[Array, Array]:
        found = self.answers(y)
        if found is None:
            size = len(self.row_names())
            return np.full(size, OUTSIDE), np.zeros((size, len(self.task.span) + 1))
        span, allowed = self.task.span, self.task.allowable_stress
        stress, by_stress = found.stress / allowed, found.by_stress * span / allowed
        shape, by_shape, _ = self.task.shape(self.task.values(y))
        objective, by_objective = self._objective(found, y[-1])
        jacobians = (by_objective, _widened(-by_stress), _widened(by_stress), _widened(by_shape))
        return np.concatenate((objective, 1.0 - stress, 1.0 + stress, shape)), np.concatenate(jacobians)

    def _objective(self, found: Answers, t: float) -> tuple[Array, Array]:
        """Return the rows of the objective, below t."""
        name, span = self.task.objective, self.task.span
        scale = self.scale[name]
        if name == CENTRE_SHIFT:  # squares are smooth at zero, and t is then the square too
            value, by = found.square_shift / scale**2, found.by_square_shift * span / scale**2
            return t - value, _widened(-by, 1.0)
        value, by = (
            (found.stress, found.by_stress) if name == STRESS else (found.variation, found.by_variation)
        )
        value, by = value / scale, by * span / scale
        rows = np.concatenate((t - value, t + value))
        return rows, np.concatenate((_widened(-by, 1.0), _widened(by, 1.0)))

    def conditions(self, y: Array) -> tuple[tuple[Active, ...], float]:
        """Return the active constraints of a point y (N + 1,) and the residual of the conditions.

        The gradient of t, which is 1, as a combination of the active rows' gradients with multipliers of at
        least zero, but for the equality's: the residual is the length of what is left over.
        """
        names, jacobian = self._active(y)
        equal = self.equality_jacobian(y)[0]
        found, residual = nnls(np.column_stack([*jacobian, equal, -equal]), np.eye(len(y))[-1])
        multipliers = [*found[:-2], found[-2] - found[-1]]
        summed: dict[str, float] = {}
        for name, multiplier in zip([*names, "stiffness"], multipliers, strict=True):
            summed[name] = summed.get(name, 0.0) + float(multiplier)
        squared = 2.0 if self.task.objective == CENTRE_SHIFT else 1.0
        active = tuple(
            Active(name=name, price=m * self._per_limit(y, name) / (squared * y[-1]))
            for name, m in summed.items()
            if name != self.task.objective and m != 0.0
        )
        return active, float(residual)

    def _active(self, y: Array) -> tuple[list[str], list[Array]]:
        """Return names and gradients of the rows without margin, and of the bounds that are reached."""
        rows, jacobian = self.inequalities(y), self.inequality_jacobian(y)
        labels = self.row_names()
        reached = np.flatnonzero(rows < ACTIVE)
        names, gradients = [labels[i] for i in reached], list(jacobian[reached])
        for i, name in enumerate(self.task.variables):
            if self.task.span[i] == 0.0:
                continue
            for end, where in ((0.0, "at its least"), (1.0, "at its most")):
                if abs(y[i] - end) < ACTIVE:
                    names.append(f"{name} {where}")
                    gradients.append((1.0 - 2.0 * end) * np.eye(len(y))[i])
        return names, gradients

    def _per_limit(self, y: Array, name: str) -> float:
        """Return d(t) over a relative change of a limit by a multiplier of one: minus its row's change."""
        task = self.task
        variable, _, end = name.partition(" at its ")
        if variable in task.variables:
            low, high = task.bounds[variable]
            return float((low if end == "least" else -high) / (high - low))
        fixed = {"stiffness": 1.0, "stress": -1.0, "allowable stress": -1.0}
        return (fixed | task.shape(self.task.values(y))[2])[name]


def compared(task: Sizing) -> tuple[Array, Answers]:
    """Return where a task's own design lies (N,), scaled, and what it answers; of the first of the spread
    starts that has an answer if its own path ends early; PathEnds where none has one."""
    own, *spread = task.starts(STARTS)
    try:
        return own, task.case()
    except PathEnds as error:
        ended = str(error)
    for start in spread:
        try:
            return start, task.answers(task.values(start))
        except PathEnds as error:
            ended = str(error)
    raise PathEnds(f"neither the case nor {len(spread)} designs within the bounds have an answer: {ended}")


def _widened(rows: Array, last: float = 0.0) -> Array:
    """Return Jacobian rows (R, N) with the column of t."""
    return np.column_stack((rows, np.full(len(rows), last)))
