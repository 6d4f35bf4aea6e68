"""A design's answers with exact gradients, and what checks them: differences, and the finite elements."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from spline_model.accuracy import DEFAULT, search
from spline_model.confirmed import NOTHING, Grid
from spline_model.discretisation import Discretisation
from spline_model.sensitivity import sensitivities
from spline_model.solution import largest
from studies.answers.models import put
from studies.answers.reference import reference
from studies.answers.response import centre_shift
from studies.answers.settings import SplineSettings
from studies.cases.design import Design
from studies.cases.effects import MOTION_ONLY
from studies.cases.problem import Problem
from studies.kinds import Array

#: Variables of a pivot's sizing, as keywords of the sensitivities; both strips are alike.
VARIABLES = ("length", "inclination", "crossing_ratio", "thickness", "width")
CENTRE_SHIFT, VARIATION, STRESS = "centre-shift", "stiffness-variation", "stress"
#: Where fibre stresses are constrained, reference arc length over L.
STATIONS = np.linspace(0.0, 1.0, 21)
#: The fewest control points of the strips: an optimum's answers nearly cancel, and 8 miss the least variation
#: by 8 %.
CONTROL_POINTS = 10


#: Effects under which both sides of a range are mirror images, as both strips are alike.
PLAIN = {"bending", "stretching", "clamped_width", "anticlastic", "root_compliance", *MOTION_ONLY}


def sides_of(design: Design) -> tuple[float, ...]:
    """Return the signs of the rotations that a range needs solved: both of a pivot under loads, else one."""
    mirrored = not isinstance(design, Problem) or set(design.effects.names) <= PLAIN
    return (1.0,) if mirrored else (1.0, -1.0)


def held_states(design: Design) -> list[int]:
    """Return the states of a range where stress is held: at the end of each side, and, but for a pivot
    without loads, before the body turns."""
    if not isinstance(design, Problem):
        return [0, -1]
    return [-1] if len(sides_of(design)) == 1 else [design.increments, -1, 0]


class PathEnds(RuntimeError):
    """A design whose static path does not reach the end of the range."""


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


@dataclass(frozen=True, kw_only=True)
class Answers:
    """What a design answers over S states of its range behind the first, with gradients by variables (N,).

    The first state has all loads, and the body has not turned; under loads the states of the other side
    follow.

    Attributes:
        stiffness: at the first state [N m / rad], or, where the bodies follow the loads, how far the body
            goes [m]; by_stiffness (N,).
        square_shift: (S,) square of the centre shift since then [m^2]; by_square_shift (S, N).
        variation: (S,) change of stiffness over that of the first state, signed [1]; by_variation (S, N).
        stress: (F,) signed fibre stresses at the states of `held_states` [Pa]; by_stress (F, N).
        rotation: (S + 1,) from the first state [rad]; largest_stress (S + 1,) [Pa].
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

    def largest(self, objective: str) -> float:
        """Return the largest value of an objective over the range [m, 1 or Pa]."""
        if objective == CENTRE_SHIFT:
            return float(np.sqrt(self.square_shift.max()))
        return float(np.abs(self.stress if objective == STRESS else self.variation).max())

    def measured(self) -> Measured:
        """Return what they say of the design over its range."""
        return Measured(
            rotation=self.rotation,
            shift=np.sqrt(np.concatenate(([0.0], self.square_shift))),
            stiffness=self.stiffness * np.concatenate(([1.0], 1.0 + self.variation)),
            stress=self.largest_stress,
        )


def answers(
    design: Design,
    control_points: int = CONTROL_POINTS,
    *,
    parameters: Sequence[str] = VARIABLES,
    chain: Array | None = None,
) -> Answers:
    """Solve a design to the end of its range, with exact gradients.

    Args:
        parameters: R names of the sensitivities.
        chain: derivatives (R, N) of these by the variables; None where they are the variables.

    Raises:
        PathEnds: the static path does not reach the end of the range, or buckles on its way under the loads.
        BadInput: an effect or value that the model, or its sensitivities, refuse; one line.
    """
    chain = np.eye(len(parameters)) if chain is None else chain
    sides = [_to_one_side(design, side, control_points, parameters, chain) for side in sides_of(design)]
    found = _Side(*map(_joined, zip(*sides, strict=True)))
    shift, by_shift = found.shift[1:] - found.shift[0], found.by_shift[1:] - found.by_shift[0]
    at_rest, by_rest = held, by_held = found.stiffness[0], found.by_stiffness[0]
    if design.rotation is None:
        held = np.linalg.norm(found.shift[-1])
        by_held = found.shift[-1] @ found.by_shift[-1] / held
    ratio, states = found.stiffness[1:] / at_rest, held_states(design)
    return Answers(
        stiffness=float(held),
        by_stiffness=by_held,
        square_shift=np.sum(shift**2, axis=1),
        by_square_shift=2.0 * np.einsum("si,sip->sp", shift, by_shift),
        variation=ratio - 1.0,
        by_variation=(found.by_stiffness[1:] - ratio[:, None] * by_rest) / at_rest,
        stress=found.stress[states].ravel(),
        by_stress=found.by_stress[states].reshape(-1, chain.shape[1]),
        rotation=found.rotation,
        largest_stress=np.abs(found.stress).max(axis=(1, 2, 3)),
    )


@dataclass(frozen=True, kw_only=True)
class Accurate:
    """A design's answers with as many control points as the accuracy of its quantities takes.

    Attributes:
        quantities: by name; errors: of them, estimated and relative [1], NaN where nothing estimates them.
    """

    answers: Answers
    quantities: Mapping[str, float]
    errors: Mapping[str, float]
    control_points: int


def accurate(solve: Callable[[int], Answers], quantities: Callable[[Answers], dict[str, float]]) -> Accurate:
    """Return the answers of a design that `solve` gives with some control points, chosen for `DEFAULT`.

    Raises:
        PathEnds: the fewest control points do not reach the end of the range.
    """
    first = solve(CONTROL_POINTS)
    known: dict[int, Answers | PathEnds] = {CONTROL_POINTS: first}

    def solved(points: int) -> Answers | PathEnds:
        if points not in known:
            try:
                known[points] = solve(points)
            except PathEnds as error:
                known[points] = error
        return known[points]

    def attempt(fewer: Grid, more: Grid) -> tuple[float, tuple[Answers, dict[str, float]]] | None:
        coarse, fine = solved(fewer[1]), solved(more[1])
        if isinstance(coarse, PathEnds) or isinstance(fine, PathEnds):
            return None
        mine, errors = quantities(coarse), {}
        for name, right in quantities(fine).items():
            scale = max(abs(right), NOTHING) if name == VARIATION else abs(right)
            errors[name] = abs(mine[name] - right) / scale if scale else 0.0
        return largest(errors.values()), (coarse, errors)

    outcome = search(Discretisation(control_points=CONTROL_POINTS), DEFAULT, attempt, most_segments=1)
    if outcome.found is None:
        outcome.found = first, dict.fromkeys(quantities(first), math.nan)
    found, errors = outcome.found
    return Accurate(
        answers=found, quantities=quantities(found), errors=errors, control_points=outcome.best[1]
    )


class _Side(NamedTuple):
    """A path from the state on at which the body begins to turn, loads having come on before: what sizing
    asks for, (S, ...), and its derivatives by the variables (S, ..., N).

    rotation: [rad], load factor where nothing is driven; stiffness: [N m / rad]; shift: (S, 2) of the pivot's
    crossing, or of the mechanism's body, from rest [m]; stress: of fibres [Pa].
    """

    rotation: Array
    stiffness: Array
    by_stiffness: Array
    shift: Array
    by_shift: Array
    stress: Array
    by_stress: Array


def _to_one_side(
    design: Design, side: float, control_points: int, parameters: Sequence[str], chain: Array
) -> _Side:
    """Return the path to one side; arguments and errors as of `answers`."""
    asked = put(design, SplineSettings(control_points=control_points))
    end = None if design.rotation is None else side * design.rotation
    with asked.refusals():
        try:
            path = asked.static_path(rotation=end)
        except asked.model.ConvergenceError as error:
            raise PathEnds(str(error)) from None
        if path.critical_points and held_states(design) != [-1]:
            raise PathEnds(path.message)
        found = sensitivities(
            asked.modelled, path, parameters=parameters, stations=STATIONS, body=design.body
        )
    turned = slice(-design.increments - 1, None)
    arrays = [path.load_factor[turned] if end is None else path.rotation[turned]]
    for quantity in (found.stiffness, found.centre_shift, found.fibre_stress):
        arrays += [quantity.value[turned], quantity.derivative[turned] @ chain]
    return _Side(*arrays)


def _joined(sides: Sequence[Array]) -> Array:
    """Return the values of a path to one side and, behind its first state, of that to the other."""
    return np.concatenate([sides[0], *(side[1:] for side in sides[1:])])


def by_elements(problem: Problem) -> Measured:
    """Return what the finite elements say of a design in the limit of refinement, stress on the finest mesh.

    Raises:
        NoReference: they do not reach the end of the range.
    """
    limits = [reference(replace(problem, rotation=sign * problem.rotation)) for sign in sides_of(problem)]
    turned = slice(-problem.increments - 1, None)
    shifts = [centre_shift(problem.crossing_point, limit.rotation, limit.centre)[turned] for limit in limits]
    return Measured(
        rotation=_joined([limit.rotation[turned] for limit in limits]),
        shift=_joined([np.hypot(*(shift - shift[0]).T) for shift in shifts]),
        stiffness=_joined([limit.stiffness[turned] for limit in limits]),
        stress=_joined([limit.finest.max_stress[turned] for limit in limits]),
    )
