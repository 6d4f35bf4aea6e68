"""The references that paths and motions are held against: limits of refinement of the finite elements."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline

from studies.answers.adapters import answer_release, answer_static
from studies.answers.metrics import extrapolate, relative_error, swing_frequency, trajectory_error
from studies.answers.motion import Motion
from studies.answers.response import Response
from studies.answers.settings import FeSettings
from studies.cases.design import Design
from studies.cases.problem import Problem
from studies.kinds import Array

#: Meshes that the limit is taken from: four, so that its own uncertainty can be measured. On finer ones the
#: round-off of the stiffness, which grows fast with the count, exceeds what is left to extrapolate.
MESHES = (20, 40, 80, 160)

#: Meshes that the limit of a swing is taken from, a third apart: the work grows with the cube of the count,
#: so that doubling four times would take minutes. The critical step falls with the square of the element, and
#: with it the error of the step faster than that of the mesh.
SWING_MESHES = (16, 24, 36, 54)
RATIO = 1.5

#: Records of a motion [1]: some 80 a swing of Table 1, between which cubic interpolation is enough.
RECORDS = 1000


class NoReference(RuntimeError):
    """The finite elements do not reach the end of a path or motion, so that there is no reference."""


#: What a path is judged by, and the array of an answer that tells it.
ARRAYS = {"trajectory": "centre", "torque": "torque", "stiffness": "stiffness", "stress": "max_stress"}
QUANTITIES = tuple(ARRAYS)


@dataclass(frozen=True, kw_only=True)
class Reference:
    """Limit of refinement of the finite-element path and how uncertain it is.

    Attributes:
        finest: the answer on the finest mesh, for shapes and what else is not extrapolated.
        rotation: (S,) [rad]; centre: (S, 2) [m]; torque: (S,) [N m]; stiffness: (S,) [N m / rad];
            max_stress: (S,) the largest of each state [Pa]; the limits.
        uncertainty: largest over the path, relative, of each of `QUANTITIES` [1].
    """

    finest: Any
    rotation: Array
    centre: Array
    torque: Array
    stiffness: Array
    max_stress: Array
    uncertainty: Mapping[str, float]


def reference(design: Design, element: str = "corotational") -> Reference:
    """Solve `design` on the meshes of an element and return their limit.

    Raises:
        NoReference: the finite elements do not reach the end of the path.
    """
    return limit_of([answer_static(design, FeSettings(elements=n, element=element)) for n in MESHES])


def limit_of(answers: Sequence[Response]) -> Reference:
    """Return the limit of finite-element answers, each on twice as many elements as the one before.

    Raises:
        NoReference: one of them does not reach the end of the path.
    """
    for answer in answers:
        if not answer.converged:
            raise NoReference(f"reference with {answer.settings['elements']} elements: {answer.message}")
    limits = {
        name: extrapolate([getattr(answer, array) for answer in answers]) for name, array in ARRAYS.items()
    }
    values = {ARRAYS[name]: limit.value for name, limit in limits.items()}
    uncertainty = {
        name: float(_error_of(name)(limit.value + limit.uncertainty, limit.value).max())
        for name, limit in limits.items()
    }
    finest = answers[-1]
    return Reference(finest=finest, rotation=finest.rotation, uncertainty=uncertainty, **values)


def _error_of(name: str) -> Callable[[Array, Array], Array]:
    """Return the measure of a quantity's error: of a position over the travel, else relative."""
    return trajectory_error if name == "trajectory" else relative_error


def errors(answer: Any, against: Any) -> dict[str, Array]:
    """Return the errors of a path, of any model, by those of `QUANTITIES` that both give, (S,) of the states
    that it reached: of the trajectory >= 0, the others signed [1]."""
    pairs = {name: (getattr(answer, array), getattr(against, array)) for name, array in ARRAYS.items()}
    return {name: _error_of(name)(*pair) for name, pair in pairs.items() if all(v is not None for v in pair)}


def largest_errors(answer: Response, against: Reference) -> dict[str, float]:
    """Return the largest magnitude of each error over the path [1]."""
    return {name: float(np.abs(error).max()) for name, error in errors(answer, against).items()}


@dataclass(frozen=True, kw_only=True)
class Swing:
    """A motion at common instants, T of them.

    Attributes:
        time (T,) [s]; rotation (T,) [rad]; centre (T, 2) [m]; kinetic_energy, strain_energy (T,) [J].
    """

    time: Array
    rotation: Array
    centre: Array
    kinetic_energy: Array
    strain_energy: Array


#: Arrays of a swing beside its instants.
SWUNG = [each.name for each in fields(Swing) if each.name != "time"]


@dataclass(frozen=True, kw_only=True)
class SwingReference:
    """Limit of refinement of a swing and how uncertain it is.

    Attributes:
        swing: the limit at the common instants.
        frequency: of the limit [Hz].
        uncertainty: (T,) of the rotation [rad]; centre_uncertainty: (T, 2) [m].
        frequency_uncertainty: relative [1].
    """

    swing: Swing
    frequency: float
    uncertainty: Array
    centre_uncertainty: Array
    frequency_uncertainty: float


def sampled(motion: Motion, instants: Array) -> Swing:
    """Return `motion` at `instants` [s] by cubic interpolation between its records."""
    found = {name: CubicSpline(motion.time, getattr(motion, name))(instants) for name in SWUNG}
    return Swing(time=instants, **found)


def swing_reference(
    problem: Problem,
    *,
    duration: float,
    instants: Array,
    meshes: Sequence[int] = SWING_MESHES,
    element: str = "corotational",
) -> SwingReference:
    """Release `problem` from the end of its path on the meshes and return their limit at `instants` [s].

    Raises:
        NoReference: a motion stopped early.
    """
    levels = []
    for elements in meshes:
        settings = FeSettings(elements=elements, element=element)
        answer = answer_release(problem, settings, duration=duration, records=RECORDS)
        if not answer.converged:
            raise NoReference(f"reference with {elements} elements: {answer.message}")
        levels.append(answer)
    return limit_of_swings(levels, instants)


def limit_of_swings(levels: Sequence[Motion], instants: Array) -> SwingReference:
    """Return the limit of motions on meshes that are each finer by `RATIO` than the one before."""
    swings = [sampled(level, instants) for level in levels]
    limits = {name: extrapolate([getattr(swing, name) for swing in swings], ratio=RATIO) for name in SWUNG}
    rotation = limits["rotation"]
    before = extrapolate([swing.rotation for swing in swings[:-1]], ratio=RATIO).value
    frequency = swing_frequency(instants, rotation.value).value
    return SwingReference(
        swing=Swing(time=instants, **{name: limit.value for name, limit in limits.items()}),
        frequency=frequency,
        uncertainty=rotation.uncertainty,
        centre_uncertainty=limits["centre"].uncertainty,
        frequency_uncertainty=abs(swing_frequency(instants, before).value / frequency - 1.0),
    )
