"""An optimum held against what does not know how it was found: differences, and the finite elements."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from studies.answers.reference import reference
from studies.answers.response import Response, centre_shift
from studies.cases.problem import Problem
from studies.design.evaluate import Answers, answers
from studies.design.task import CENTRE_SHIFT, VARIABLES, VARIATION, Task, variables_of

#: First step of the differences, of a variable's bounds, and how often it is halved.
STEP, LEVELS = 0.01, 4


@dataclass(frozen=True, kw_only=True)
class Measured:
    """What an answer of either model says of a design; each over the range, both sides.

    Attributes:
        rotation: (S,) [rad]; shift: (S,) magnitude of the centre shift [m]; stiffness: (S,) [N m / rad];
            stress: (S,) largest [Pa].
    """

    rotation: np.ndarray
    shift: np.ndarray
    stiffness: np.ndarray
    stress: np.ndarray

    def quantities(self) -> dict[str, float]:
        """Return objectives and constraints by name: [m, 1, N m / rad, Pa]."""
        return {
            CENTRE_SHIFT: float(self.shift.max()),
            VARIATION: float(np.abs(self.stiffness / self.stiffness[0] - 1.0).max()),
            "stiffness": float(self.stiffness[0]),
            "stress": float(self.stress.max()),
        }


def of_spline(found: Answers) -> Measured:
    """Return what the splines say of a design."""
    return Measured(
        rotation=found.rotation,
        shift=np.sqrt(np.concatenate(([0.0], found.square_shift))),
        stiffness=found.stiffness * np.concatenate(([1.0], 1.0 + found.variation)),
        stress=found.largest_stress,
    )


def by_elements(problem: Problem) -> tuple[Measured, Response]:
    """Return what the finite elements say of a design in the limit of refinement, stress and shape on the
    finest mesh.

    Raises:
        NoReference: they do not reach the end of the range.
    """
    limit = reference(problem)
    measured = Measured(
        rotation=limit.rotation,
        shift=np.hypot(*centre_shift(problem, limit.rotation, limit.centre).T),
        stiffness=limit.stiffness,
        stress=limit.finest.max_stress,
    )
    return measured, limit.finest


def gradient_error(task: Task, problem: Problem, levels: int = LEVELS) -> float:
    """Return the largest error of the gradients that the optimiser was given, against differences [1].

    Central differences of halved steps, extrapolated; relative to the largest
    derivative of the same rows by any variable, over the bounds.
    """
    at = variables_of(problem)
    exact = answers(problem)
    errors: list[float] = []
    for i in range(len(VARIABLES)):
        rows = []
        for level in range(levels):
            step = STEP / 2**level * task.span * (np.arange(len(at)) == i)
            up, down = (_rows(answers(task.problem(at + sign * step))) for sign in (1.0, -1.0))
            rows.append({name: (up[name] - down[name]) / (2.0 * step[i]) for name in up})
        for name, gradient in _gradients(exact).items():
            expected = _limit([row[name] for row in rows])
            largest = float((np.abs(gradient) * task.span).max())
            errors.append(task.span[i] * float(np.abs(gradient[:, i] - expected).max()) / largest)
    return max(errors)


def _rows(found: Answers) -> dict[str, Any]:
    return {
        CENTRE_SHIFT: found.square_shift,
        VARIATION: found.variation,
        "stiffness": np.array([found.stiffness]),
        "stress": found.stress,
    }


def _gradients(found: Answers) -> dict[str, Any]:
    return {
        CENTRE_SHIFT: found.by_square_shift,
        VARIATION: found.by_variation,
        "stiffness": found.by_stiffness[None, :],
        "stress": found.by_stress,
    }


def _limit(row: list[np.ndarray]) -> np.ndarray:
    """Return the limit of differences whose steps are halved, by Richardson's extrapolation."""
    for order in range(1, len(row)):
        row = [(4**order * row[i + 1] - row[i]) / (4**order - 1) for i in range(len(row) - 1)]
    return row[0]
