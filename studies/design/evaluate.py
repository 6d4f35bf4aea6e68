"""A design's answers with exact gradients, and what checks them: differences, and the finite elements."""

from dataclasses import dataclass, replace

import numpy as np

from spline_model.sensitivity.solve import Quantity, Sensitivities, sensitivities
from studies.answers.models import put
from studies.answers.reference import reference
from studies.answers.response import Response, centre_shift
from studies.answers.settings import SplineSettings
from studies.cases.effects import MOTION_ONLY
from studies.cases.problem import Problem
from studies.kinds import Array

#: Variables of a sizing, as keywords of the sensitivities; both strips are alike.
VARIABLES = ("length", "inclination", "crossing_ratio", "thickness", "width")
CENTRE_SHIFT, VARIATION, STRESS = "centre-shift", "stiffness-variation", "stress"
#: Where fibre stresses are constrained, reference arc length over L.
STATIONS = np.linspace(0.0, 1.0, 21)
#: Control points of the strips: an optimum's answers nearly cancel, and 8 miss the least variation by 8 %.
CONTROL_POINTS = 10


#: Effects under which both sides of a range are mirror images, as both strips are alike.
PLAIN = {"bending", "stretching", "clamped_width", "anticlastic", "root_compliance", *MOTION_ONLY}


def sides_of(problem: Problem) -> tuple[float, ...]:
    """Return the signs of the rotations that a range needs solved: both under loads, one without."""
    return (1.0,) if set(problem.effects.names) <= PLAIN else (1.0, -1.0)


class PathEnds(RuntimeError):
    """A design whose static path does not reach the end of the range."""


@dataclass(frozen=True, kw_only=True)
class Answers:
    """What a design answers over S states of its range behind the first, with gradients by variables (N,).

    The first state has rotation 0, and all loads; under loads the states of the other side follow.

    Attributes:
        stiffness: at the first state [N m / rad]; by_stiffness (N,).
        square_shift: (S,) square of the centre shift since then [m^2]; by_square_shift (S, N).
        variation: (S,) change of stiffness over that of the first state, signed [1]; by_variation (S, N).
        stress: (F,) signed fibre stresses at the end of each side, of the first state too under loads [Pa];
            by_stress (F, N).
        rotation: (S + 1,) from the first state [rad]; largest_stress (S + 1,) [Pa].
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
        if objective == STRESS:
            return float(np.abs(self.stress).max())
        return float(np.abs(self.variation).max())


def answers(problem: Problem, control_points: int = CONTROL_POINTS) -> Answers:
    """Solve a design to the end of its range, with exact gradients.

    Raises:
        PathEnds: the static path does not reach the end of the range, or buckles on its way under the loads.
        BadInput: an effect or value that the model, or its sensitivities, refuse; one line.
    """
    sides = sides_of(problem)
    solved = [_to_one_side(problem, sign * problem.rotation, control_points) for sign in sides]
    found = [each for _, each in solved]
    begin = _first_state(problem, len(solved[0][0]))
    at_rest, by_rest = _at(begin, found[0].stiffness)
    shift, by_shift = _behind(begin, [each.centre_shift for each in found])
    shift_0, by_shift_0 = _at(begin, found[0].centre_shift)
    shift, by_shift = shift - shift_0, by_shift - by_shift_0
    stiffness, by_stiffness = _behind(begin, [each.stiffness for each in found])
    ratio = stiffness / at_rest
    stress = [_at(-1, each.fibre_stress) for each in found]
    stress += [_at(begin, found[0].fibre_stress)] if len(sides) > 1 else []
    return Answers(
        stiffness=float(at_rest),
        by_stiffness=by_rest,
        square_shift=np.sum(shift**2, axis=1),
        by_square_shift=2.0 * np.einsum("si,sip->sp", shift, by_shift),
        variation=ratio - 1.0,
        by_variation=(by_stiffness - ratio[:, None] * by_rest) / at_rest,
        stress=np.concatenate([value.ravel() for value, _ in stress]),
        by_stress=np.concatenate([by.reshape(-1, len(VARIABLES)) for _, by in stress]),
        rotation=_behind_first(begin, [rotation for rotation, _ in solved]),
        largest_stress=_behind_first(begin, [each.largest_stress().value for each in found]),
        counters=found[0].counters,
    )


def _at(state: int, quantity: Quantity) -> tuple[Array, Array]:
    """Return value and derivative of a quantity at one state."""
    return quantity.value[state], quantity.derivative[state]


def _behind(begin: int, sides: list[Quantity]) -> tuple[Array, Array]:
    """Return values and derivatives behind the first state, those of each side."""
    values = np.concatenate([side.value[begin + 1 :] for side in sides])
    return values, np.concatenate([side.derivative[begin + 1 :] for side in sides])


def _first_state(problem: Problem, states: int) -> int:
    """Return the state of a path at which the body begins to turn: loads have come on before."""
    return states - 1 - problem.increments


def _behind_first(begin: int, sides: list[Array]) -> Array:
    """Return the values of a path from the state at which the body begins to turn, those of each side."""
    return np.concatenate([sides[0][begin : begin + 1], *(side[begin + 1 :] for side in sides)])


def _to_one_side(problem: Problem, rotation: float, control_points: int) -> tuple[Array, Sensitivities]:
    """Return the rotations of the path to one side, and its derivatives; errors as of `answers`."""
    settings = SplineSettings(control_points=control_points)
    asked = put(problem, settings)
    with asked.refusals():
        try:
            path = asked.static_path(rotation=rotation)
        except asked.model.errors.ConvergenceError as error:
            raise PathEnds(str(error)) from None
        if path.critical_points and len(sides_of(problem)) > 1:
            raise PathEnds(path.message)
        return path.rotation, sensitivities(asked.modelled, path, parameters=VARIABLES, stations=STATIONS)


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
    limits = [reference(replace(problem, rotation=sign * problem.rotation)) for sign in sides_of(problem)]
    begin = _first_state(problem, len(limits[0].rotation))
    shifts = [centre_shift(problem.crossing_point, limit.rotation, limit.centre) for limit in limits]
    measured = Measured(
        rotation=_behind_first(begin, [limit.rotation for limit in limits]),
        shift=_behind_first(begin, [np.hypot(*(shift - shift[begin]).T) for shift in shifts]),
        stiffness=_behind_first(begin, [limit.stiffness for limit in limits]),
        stress=_behind_first(begin, [limit.finest.max_stress for limit in limits]),
    )
    return measured, limits[0].finest
