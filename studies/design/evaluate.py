"""A design's answers and their exact gradients, as an optimiser wants them."""

from dataclasses import dataclass

import numpy as np

from spline_model.sensitivity.solve import sensitivities
from studies.answers.models import built, model_of, refusals
from studies.answers.settings import SplineSettings
from studies.cases.problem import Problem
from studies.design.task import CENTRE_SHIFT, VARIABLES
from studies.kinds import Array

#: Control points of the strips: an optimum's answers nearly cancel, and 8 miss the least variation by 8 %.
CONTROL_POINTS = 10
#: Where fibre stresses are constrained, reference arc length over L.
STATIONS = np.linspace(0.0, 1.0, 21)
#: Fibre stresses of a state: two strips, both fibres.
FIBRES = 4 * len(STATIONS)


class PathEnds(RuntimeError):
    """A design whose static path does not reach the end of the range."""


@dataclass(frozen=True, kw_only=True)
class Answers:
    """What a design answers over its range of S states behind rest, with gradients by the variables (5,).

    Attributes:
        stiffness: at rest [N m / rad]; by_stiffness (5,).
        square_shift: (S,) square of the centre shift [m^2]; by_square_shift (S, 5).
        variation: (S,) change of stiffness over that at rest, signed [1]; by_variation (S, 5).
        stress: (F,) signed fibre stresses at the end of the range [Pa]; by_stress (F, 5).
        rotation: (S + 1,) from rest [rad]; largest_stress (S + 1,) [Pa].
        evaluations: factorisations and back-substitutions of the gradients.
    """

    stiffness: float
    by_stiffness: Array
    square_shift: Array
    by_square_shift: Array
    variation: Array
    by_variation: Array
    stress: Array
    by_stress: Array
    rotation: Array
    largest_stress: Array
    counters: dict[str, int]

    def largest(self, objective: str) -> float:
        """Return the largest value of an objective over the range [m or 1]."""
        if objective == CENTRE_SHIFT:
            return float(np.sqrt(self.square_shift.max()))
        return float(np.abs(self.variation).max())


def answers(problem: Problem, control_points: int = CONTROL_POINTS) -> Answers:
    """Solve a design to the end of its range, with exact gradients.

    Raises:
        PathEnds: the static path does not reach the end of the range.
        BadInput: an effect or value that the model, or its sensitivities, refuse; one line.
    """
    settings = SplineSettings(control_points=control_points)
    model = model_of(settings)
    pivot, _ = built(model, problem, settings, moving=False)
    with refusals(model, settings):
        try:
            path = model.statics.solve_statics(
                pivot, rotation=problem.rotation, increments=problem.increments
            )
        except model.errors.ConvergenceError as error:
            raise PathEnds(str(error)) from None
        found = sensitivities(pivot, path, parameters=VARIABLES, stations=STATIONS)
    shift, stiffness, stress = found.centre_shift, found.stiffness, found.fibre_stress
    at_rest, by_rest = stiffness.value[0], stiffness.derivative[0]
    ratio = stiffness.value[1:] / at_rest
    return Answers(
        stiffness=float(at_rest),
        by_stiffness=by_rest,
        square_shift=np.sum(shift.value[1:] ** 2, axis=1),
        by_square_shift=2.0 * np.einsum("si,sip->sp", shift.value[1:], shift.derivative[1:]),
        variation=ratio - 1.0,
        by_variation=(stiffness.derivative[1:] - ratio[:, None] * by_rest) / at_rest,
        stress=stress.value[-1].ravel(),
        by_stress=stress.derivative[-1].reshape(-1, len(VARIABLES)),
        rotation=path.rotation,
        largest_stress=found.largest_stress().value,
        counters=found.counters,
    )
