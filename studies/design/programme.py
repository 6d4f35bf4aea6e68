"""A sizing question as a smooth programme: scaled variables, constraints below zero, exact Jacobians.

The unknowns are the variables over their bounds, y in [0, 1]^5, and the bound t of the objective:

    min t   with   objective at every state <= t,   stiffness = wanted,   |fibre stress| <= allowable, ...

so that the largest over states and stations, which has kinks, is never differentiated. Its conditions of
Karush, Kuhn and Tucker say what holds a design back, and what each constraint costs. All rows are relative
to what they are held against: the start's objective, the wanted stiffness, the allowable stress.
"""

from dataclasses import dataclass, field

import numpy as np
from scipy.optimize import nnls

from studies.design.evaluate import FIBRES, Answers, PathEnds, answers
from studies.design.task import CENTRE_SHIFT, OBJECTIVES, VARIABLES, Task
from studies.kinds import Array

#: Stands for every row of a design without an answer: far outside, so that a line search comes back.
OUTSIDE = -1e3


@dataclass(kw_only=True)
class Programme:
    """The programme of a task; `scale` holds the start's largest value of every objective.

    Counts designs that were solved and those whose path ended early; keeps the last design's answer.
    """

    task: Task
    scale: dict[str, float]
    solved: int = 0
    failed: int = 0
    _last: tuple[bytes, Answers | None] = field(default=(b"", None), repr=False)

    def variables(self, y: Array) -> Array:
        """Return the design's variables (5,) in their units."""
        return self.task.low + self.task.span * y[:5]

    def answers(self, y: Array) -> Answers | None:
        """Return the design's answers; None where its path ends early."""
        key = y[:5].tobytes()
        if key != self._last[0]:
            self.solved += 1
            try:
                found = answers(self.task.problem(self.variables(y)))
            except PathEnds:
                self.failed += 1
                found = None
            self._last = (key, found)
        return self._last[1]

    def inequalities(self, y: Array) -> Array:
        """Return all rows that must not be below zero (R,) [1]."""
        return self._rows(y)[0]

    def inequality_jacobian(self, y: Array) -> Array:
        """Return their Jacobian (R, 6)."""
        return self._rows(y)[1]

    def equality(self, y: Array) -> Array:
        """Return stiffness over the wanted one less one (1,)."""
        found = self.answers(y)
        return np.array([OUTSIDE if found is None else found.stiffness / self.task.stiffness - 1.0])

    def equality_jacobian(self, y: Array) -> Array:
        """Return its gradient (1, 6)."""
        found = self.answers(y)
        row = np.zeros((1, 6))
        if found is not None:
            row[0, :5] = found.by_stiffness * self.task.span / self.task.stiffness
        return row

    def row_names(self) -> list[str]:
        """Return what each row of `inequalities` holds."""
        sides = len(self.task.sides)
        states = self.task.start.increments * sides
        stressed = sides if sides == 1 else sides + 1
        counts = {name: states if name == CENTRE_SHIFT else 2 * states for name in self._held()}
        rows = [name for name, count in counts.items() for _ in range(count)]
        return [*rows, *["stress"] * 2 * FIBRES * stressed, "slenderness", "aspect"]

    def _held(self) -> list[str]:
        """Return the objectives with rows: the one to be least and those with a limit."""
        return [name for name in OBJECTIVES if name == self.task.objective or name in self.task.limits]

    def _rows(self, y: Array) -> tuple[Array, Array]:
        found = self.answers(y)
        if found is None:
            size = len(self.row_names())
            return np.full(size, OUTSIDE), np.zeros((size, 6))
        values, jacobians = [], []
        for name in self._held():
            value, jacobian = self._objective(name, found, y[5])
            values.append(value)
            jacobians.append(jacobian)
        span, allowed = self.task.span, self.task.allowable_stress
        stress, by_stress = found.stress / allowed, found.by_stress * span / allowed
        values += [1.0 - stress, 1.0 + stress]
        jacobians += [_widened(-by_stress), _widened(by_stress)]
        value, jacobian = self._shape(y)
        return np.concatenate([*values, value]), np.concatenate([*jacobians, jacobian])

    def _objective(self, name: str, found: Answers, t: float) -> tuple[Array, Array]:
        """Return the rows of one objective: below t, or below its limit."""
        scale, span = self.scale[name], self.task.span
        least = name == self.task.objective
        bound = t if least else self.task.limits[name] / scale
        slope = float(least)
        if name == CENTRE_SHIFT:  # squares are smooth at zero, and t is then the square too
            bound, value, by = (
                bound if least else bound**2,
                found.square_shift / scale**2,
                found.by_square_shift,
            )
            return bound - value, _widened(-by * span / scale**2, slope)
        value, by = found.variation / scale, found.by_variation * span / scale
        rows = np.concatenate((bound - value, bound + value))
        return rows, np.concatenate((_widened(-by, slope), _widened(by, slope)))

    def _shape(self, y: Array) -> tuple[Array, Array]:
        """Return the rows of slenderness, L / h, and of aspect, b / L: linear in the variables."""
        length, _, _, thickness, width = self.variables(y)
        whole = self.task.low[0] + self.task.span[0]
        rows = np.zeros((2, 6))
        rows[0, [0, 3]] = self.task.span[[0, 3]] * (1.0, -self.task.least_slenderness) / whole
        rows[1, [0, 4]] = self.task.span[[0, 4]] * (self.task.largest_aspect, -1.0) / whole
        slender = length - self.task.least_slenderness * thickness
        return np.array([slender, self.task.largest_aspect * length - width]) / whole, rows


def _widened(rows: Array, last: float = 0.0) -> Array:
    """Return Jacobian rows (R, 5) with the column of t."""
    return np.column_stack((rows, np.full(len(rows), last)))


#: Margin below which a row is active [1].
ACTIVE = 1e-6


@dataclass(frozen=True, kw_only=True)
class Active:
    """A constraint that holds an optimum back.

    Args:
        name: of the quantity, or of the variable at its bound.
        multiplier: of its row in the programme [1].
        price: relative change of the objective over a relative change of the limit, to first order [1].
    """

    name: str
    multiplier: float
    price: float


def conditions(programme: Programme, y: Array) -> tuple[tuple[Active, ...], float]:
    """Return the active constraints of a point y (6,) and the residual of the conditions.

    The gradient of t, which is 1, as a combination of the active rows' gradients with multipliers of at
    least zero, but for the equality's: the residual is the length of what is left over.
    """
    names, jacobian = _active(programme, y)
    equal = programme.equality_jacobian(y)[0]
    found, residual = nnls(np.column_stack([*jacobian, equal, -equal]), np.eye(6)[5])
    multipliers = [*found[:-2], found[-2] - found[-1]]
    summed: dict[str, float] = {}
    for name, multiplier in zip([*names, "stiffness"], multipliers, strict=True):
        summed[name] = summed.get(name, 0.0) + float(multiplier)
    squared = 2.0 if programme.task.objective == CENTRE_SHIFT else 1.0
    active = tuple(
        Active(name=name, multiplier=m, price=m * _per_limit(programme, y, name) / (squared * y[5]))
        for name, m in summed.items()
        if name != programme.task.objective and m != 0.0
    )
    return active, float(residual)


def _active(programme: Programme, y: Array) -> tuple[list[str], list[Array]]:
    """Return names and gradients of the rows without margin, and of the bounds that are reached."""
    rows, jacobian = programme.inequalities(y), programme.inequality_jacobian(y)
    labels = programme.row_names()
    reached = np.flatnonzero(rows < ACTIVE)
    names, gradients = [labels[i] for i in reached], list(jacobian[reached])
    for i, name in enumerate(VARIABLES):
        if programme.task.span[i] == 0.0:
            continue
        for end, where in ((0.0, "at its least"), (1.0, "at its most")):
            if abs(y[i] - end) < ACTIVE:
                names.append(f"{name} {where}")
                gradients.append((1.0 - 2.0 * end) * np.eye(6)[i])
    return names, gradients


def _per_limit(programme: Programme, y: Array, name: str) -> float:
    """Return d(t) over a relative change of a limit for a multiplier of one: minus the change of its row."""
    task, values = programme.task, dict(zip(VARIABLES, programme.variables(y), strict=True))
    whole = task.bounds["length"][1]
    variable, _, end = name.partition(" at its ")
    if variable in VARIABLES:
        low, high = task.bounds[variable]
        return float((low if end == "least" else -high) / (high - low))
    if name in task.limits:
        bound = task.limits[name] / programme.scale[name]
        return -2.0 * bound**2 if name == CENTRE_SHIFT else -bound
    changes: dict[str, float] = {
        "stiffness": 1.0,
        "stress": -1.0,
        "slenderness": task.least_slenderness * values["thickness"] / whole,
        "aspect": -task.largest_aspect * values["length"] / whole,
    }
    return changes[name]
