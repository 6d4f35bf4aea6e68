"""A design's answers over its range with exact gradients, and those of the finite elements beside them."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from spline_model.confirmed import NOTHING
from spline_model.sensitivity import sensitivities
from studies.answers.answer import centre_shift
from studies.answers.models import put
from studies.answers.reference import reference
from studies.answers.settings import SplineSettings
from studies.cases.design import Design
from studies.cases.effects import MOTION_ONLY
from studies.kinds import Array

CENTRE_SHIFT, VARIATION, STRESS = "centre-shift", "stiffness-variation", "stress"
STIFFNESS, TRAVEL = "stiffness", "travel"
#: Where fibre stresses are constrained, reference arc length over L.
STATIONS = np.linspace(0.0, 1.0, 21)
#: The fewest control points of the strips: an optimum's answers nearly cancel, and 8 miss the least variation
#: by 8 %.
CONTROL_POINTS = 10
#: Effects under which both sides of a range are mirror images, as both strips are alike.
PLAIN = {"bending", "stretching", "clamped_width", "anticlastic", "root_compliance", *MOTION_ONLY}


def _sides_of(design: Design) -> list[Design]:
    """Return the designs of the rotations that a range takes: both of a pivot under loads, else one."""
    if design.crossing_point is None or set(design.effects.names) <= PLAIN:
        return [design]
    return [design, replace(design, rotation=-(design.rotation or 0.0))]


def _held_states(design: Design) -> list[int]:
    """Return the states of a range where stress is held: at the end of each side, and, but for a pivot
    without loads, before the body turns."""
    if design.crossing_point is None:
        return [0, -1]
    return [-1] if len(_sides_of(design)) == 1 else [design.increments, -1, 0]


class PathEnds(RuntimeError):
    """A design whose static path does not reach the end of the range."""


class Followed(NamedTuple):
    """Values (R,) of a quantity over states or fibres, and gradients (R, N) by the variables."""

    value: Array
    by: Array


@dataclass(frozen=True, kw_only=True)
class Answers:
    """What a design answers over its range, both sides; the first state has all loads, before it turns.

    Attributes:
        followed: by quantity: `STIFFNESS` at the first state [N m / rad], or, where the bodies follow the
            loads, `TRAVEL`, how far the body goes [m], each alone; behind the first state the squares of the
            centre shift [m^2] and the change of the stiffness over that of the first state, signed [1]; the
            signed fibre stresses at the states of `_held_states` [Pa].
        quantities: the largest of each over all states [m, 1, N m / rad, m, Pa].
        control_points: of each strip [1].
        errors: of the quantities that are told, estimated and relative [1]; NaN where nothing estimates them.
    """

    followed: Mapping[str, Followed]
    quantities: Mapping[str, float]
    control_points: int
    errors: Mapping[str, float] = field(default_factory=dict)

    def largest(self, quantity: str) -> float:
        """Return the largest size of a quantity that is followed [m, 1, N m / rad or Pa]."""
        largest = float(np.abs(self.followed[quantity].value).max())
        return math.sqrt(largest) if quantity == CENTRE_SHIFT else largest

    def apart(self, fine: "Answers", quantity: str) -> float:
        """Return the relative difference of a quantity to that of finer answers [1]."""
        mine, right = self.quantities[quantity], fine.quantities[quantity]
        scale = max(abs(right), NOTHING) if quantity == VARIATION else abs(right)
        return abs(mine - right) / scale if scale else 0.0


def _quantities(shift: Array, stiffness: Array, stress: Array) -> dict[str, float]:
    """Return the quantities of a range by its states (S,).

    shift: distance since the first state of a pivot's crossing, or of a mechanism's body [m].
    stiffness: [N m / rad]. stress: the largest of all fibres [Pa].
    """
    found = {
        CENTRE_SHIFT: shift.max(),
        VARIATION: np.abs(stiffness / stiffness[0] - 1.0).max(),
        STIFFNESS: stiffness[0],
        TRAVEL: shift[-1],
        STRESS: stress.max(),
    }
    return {name: float(value) for name, value in found.items()}


def answers(design: Design, control_points: int, parameters: Sequence[str], chain: Array) -> Answers:
    """Solve a design to the end of its range, with exact gradients.

    Args:
        control_points: of each strip [1].
        parameters: R names of the sensitivities.
        chain: derivatives (R, N) of these by the variables.

    Raises:
        PathEnds: the static path does not reach the end of the range, or buckles on its way under the loads.
        BadInput: an effect or value that the model, or its sensitivities, reject; one line.
    """
    sides = [_to_one_side(side, control_points, parameters, chain) for side in _sides_of(design)]
    stiffness, by_stiffness, shift, by_shift, stress, by_stress = map(_joined, zip(*sides, strict=True))
    shift, by_shift, held = shift - shift[0], by_shift - by_shift[0], _held_states(design)
    ratio = stiffness[1:] / stiffness[0]
    by_ratio = (by_stiffness[1:] - ratio[:, None] * by_stiffness[0]) / stiffness[0]
    by_square = 2.0 * np.einsum("si,sip->sp", shift[1:], by_shift[1:])
    followed = {
        STIFFNESS: Followed(stiffness[:1], by_stiffness[:1]),
        CENTRE_SHIFT: Followed(np.sum(shift[1:] ** 2, axis=1), by_square),
        VARIATION: Followed(ratio - 1.0, by_ratio),
        STRESS: Followed(stress[held].ravel(), by_stress[held].reshape(-1, chain.shape[1])),
    }
    if design.rotation is None:
        travel = np.linalg.norm(shift[-1:], axis=1)
        followed[TRAVEL] = Followed(travel, shift[-1:] @ by_shift[-1] / travel)
    largest = np.abs(stress).max(axis=(1, 2, 3))
    quantities = _quantities(np.hypot(*shift.T), stiffness, largest)
    return Answers(followed=followed, quantities=quantities, control_points=control_points)


def _to_one_side(design: Design, control_points: int, parameters: Sequence[str], chain: Array) -> list[Array]:
    """Return a path from the state on at which the body begins to turn, loads having come on before.

    Arguments and errors are those of `answers`. Arrays (S, ...): the stiffness [N m / rad], the shift of the
    pivot's crossing, or of the mechanism's body, from rest (2) [m], and the stress of the fibres [Pa], each
    before its derivative by the variables (S, ..., N).
    """
    asked = put(design, SplineSettings(control_points=control_points))
    with asked.refusals():
        try:
            path = asked.static_path()
        except asked.model.ConvergenceError as error:
            raise PathEnds(str(error)) from None
        if path.critical_points and _held_states(design) != [-1]:
            raise PathEnds(path.message)
        found = sensitivities(
            asked.modelled, path, parameters=parameters, stations=STATIONS, body=design.body
        )
    turned, arrays = slice(-design.increments - 1, None), []
    for quantity in (found.stiffness, found.centre_shift, found.fibre_stress):
        arrays += [quantity.value[turned], quantity.derivative[turned] @ chain]
    return arrays


def _joined(sides: Sequence[Array]) -> Array:
    """Return the values of a path to one side and, behind its first state, of that to the other."""
    return np.concatenate([sides[0], *(side[1:] for side in sides[1:])])


def by_elements(design: Design) -> dict[str, float]:
    """Return the quantities of a design by the finite elements in the limit of refinement, stress on the
    finest mesh.

    Raises:
        NoReference: they do not reach the end of the range.
    """
    turned, sides = slice(-design.increments - 1, None), []
    for limit in map(reference, _sides_of(design)):
        shift = limit.centre
        if design.crossing_point is not None:
            shift = centre_shift(design.crossing_point, limit.rotation, limit.centre)
        moved = np.hypot(*(shift[turned] - shift[turned][0]).T)
        sides.append((moved, limit.stiffness[turned], limit.finest.max_stress[turned]))
    return _quantities(*map(_joined, zip(*sides, strict=True)))
