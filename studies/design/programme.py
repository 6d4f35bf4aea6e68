"""A sizing question as a smooth programme: scaled variables, constraints below zero, exact Jacobians.

The unknowns are the variables over their bounds, y in [0, 1]^5, and the bound t of the objective:

    min t   with   objective at every state <= t,   stiffness = wanted,   |fibre stress| <= allowable, ...

so that the largest over states and stations, which has kinks, is never differentiated. All rows are relative
to what they are held against: the start's objective, the wanted stiffness, the allowable stress.
"""

from dataclasses import dataclass, field

import numpy as np

from studies.design.evaluate import FIBRES, Answers, PathEnds, answers
from studies.design.task import CENTRE_SHIFT, OBJECTIVES, Task
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
        states = self.task.start.increments
        counts = {name: states if name == CENTRE_SHIFT else 2 * states for name in self._held()}
        rows = [name for name, count in counts.items() for _ in range(count)]
        return [*rows, *["stress"] * 2 * FIBRES, "slenderness", "aspect"]

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
