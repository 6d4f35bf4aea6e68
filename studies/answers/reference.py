"""Paths and motions that others are held against, their errors, and limits of refinement of the elements."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from studies.answers.adapters import answer_release, answer_static
from studies.answers.metrics import cubic, extrapolate, relative_error, swing_frequency, trajectory_error
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

#: Part of its duration by which a motion may fall short of an instant.
ROUND_OFF = 1e-9

#: What a path is judged by, and the array of an answer that tells it.
ARRAYS = {"trajectory": "centre", "torque": "torque", "stiffness": "stiffness", "stress": "max_stress"}
QUANTITIES = tuple(ARRAYS)
#: Arrays of a motion beside its instants.
SWUNG = ("rotation", "centre", "kinetic_energy", "strain_energy")


class NoReference(RuntimeError):
    """No reference: a model does not reach the end of a path or motion."""


@dataclass(frozen=True, kw_only=True)
class SolvedPath:
    """A static path, S states, the unloaded one first; a `Response` of the suite's own models has the same.

    Attributes:
        rotation (S,): of the body, counter-clockwise [rad]. centre (S, 2): of its mass, origin at A1 [m].
        torque (S,): that drives the body [N m]. stiffness (S,): its derivative by the rotation [N m / rad];
            max_stress (S,): at the strips' outer fibres [Pa]; None where the model does not give them.
        solve_s: time of the increments alone [s]. counters: of the solve, by kind; "unknowns" is the size of
            its system.
    """

    rotation: Array
    centre: Array
    torque: Array
    stiffness: Array | None = None
    max_stress: Array | None = None
    solve_s: float = math.nan
    counters: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True, kw_only=True)
class Reference(SolvedPath):
    """A path that other paths are compared with.

    Attributes:
        uncertainty: largest relative uncertainty over the path of each of `QUANTITIES` [1]. source: in words.
        finest: the answer on the finest mesh, for shapes and other values that are not extrapolated.
    """

    stiffness: Array
    max_stress: Array
    uncertainty: Mapping[str, float]
    source: str
    finest: Response


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
    source, finest = _extrapolated(answers), answers[-1]
    limits = {name: extrapolate([getattr(each, array) for each in answers]) for name, array in ARRAYS.items()}
    values: dict[str, Any] = {ARRAYS[name]: limit.value for name, limit in limits.items()}
    uncertainty = {
        name: float(_error(name, limit.value + limit.uncertainty, limit.value).max())
        for name, limit in limits.items()
    }
    return Reference(
        rotation=finest.rotation, **values, uncertainty=uncertainty, source=source, finest=finest
    )


def _extrapolated(answers: Sequence[Response | Motion]) -> str:
    """Return the source of the limit of finite-element answers; NoReference if one stopped early."""
    for answer in answers:
        if not answer.converged:
            raise NoReference(f"reference with {answer.settings['elements']} elements: {answer.message}")
    meshes = ", ".join(str(answer.settings["elements"]) for answer in answers)
    return f"{answers[0].settings['element']} elements, {meshes} a strip, extrapolated"


def _error(name: str, values: Array, expected: Array) -> Array:
    """Return the error of a quantity: of a position over the travel, else relative."""
    return (trajectory_error if name == "trajectory" else relative_error)(values, expected)


def errors(answer: Any, against: Any) -> dict[str, Array]:
    """Return the errors (S,) of a path, of any model, by those of `QUANTITIES` that both paths have [1].

    S are the states that the path reached. The error of the trajectory is >= 0, the others are signed.
    """
    pairs = {name: (getattr(answer, array), getattr(against, array)) for name, array in ARRAYS.items()}
    return {name: _error(name, *pair) for name, pair in pairs.items() if all(v is not None for v in pair)}


def largest_errors(answer: Any, against: Any) -> dict[str, float]:
    """Return the largest magnitude of each error over the path [1]."""
    return {name: float(np.abs(error).max()) for name, error in errors(answer, against).items()}


@dataclass(frozen=True, kw_only=True)
class SolvedMotion:
    """Motion after a release at rest, T records, the start first; a `Motion` has the same.

    Attributes:
        time (T,): [s]. rotation (T,): of the body [rad]. centre (T, 2): [m]; kinetic_energy, strain_energy
            (T,): [J]; None where the model does not give them. solve_s, counters: as of a path, of the steps.
    """

    time: Array
    rotation: Array
    centre: Any = None
    kinetic_energy: Any = None
    strain_energy: Any = None
    solve_s: float = math.nan
    counters: Mapping[str, float] = field(default_factory=dict)

    @property
    def frequency(self) -> float:
        """Frequency of the swing [Hz]."""
        return swing_frequency(self.time, self.rotation).value


@dataclass(frozen=True, kw_only=True)
class SwingReference(SolvedMotion):
    """A motion that other motions are compared with, at common instants.

    Attributes:
        uncertainty: largest one of the rotation, "rotation_rad" [rad], relative of the "frequency" [1], and
            of a limit of refinement those of the centre, "com_x_m" and "com_y_m" [m]. source: in words.
    """

    uncertainty: Mapping[str, float]
    source: str


def sampled(motion: Any, instants: Array) -> SolvedMotion:
    """Return a motion at `instants` (T,) [s] by cubic interpolation between its records.

    The last record may precede the last instant by round-off.
    """
    known = {name: array for name in SWUNG if (array := getattr(motion, name)) is not None}
    at = np.minimum(instants, motion.time[-1])
    found: dict[str, Any] = {name: cubic(motion.time, array)(at) for name, array in known.items()}
    return SolvedMotion(time=instants, **found)


def rotation_error(motion: Any, against: Any, instants: Array) -> float:
    """Return the largest difference [rad] of the rotations of two motions at those instants (T,) [s] that
    both reach; a motion that stopped at once has only its start."""
    last = min(motion.time[-1], against.time[-1])
    both = np.minimum(instants[instants <= last * (1.0 + ROUND_OFF)], last)
    one, other = (
        cubic(each.time, each.rotation)(both) if len(each.time) > 1 else each.rotation[0]
        for each in (motion, against)
    )
    return float(np.abs(one - other).max())


def swing_errors(motion: Any, against: SolvedMotion) -> dict[str, float]:
    """Return the errors of a motion at the instants of another motion: of rotation [rad] and frequency [1].

    The error of the rotation is the largest one.
    """
    frequency = sampled(motion, against.time).frequency
    rotation = rotation_error(motion, against, against.time)
    return {"rotation_rad": rotation, "frequency": abs(frequency / against.frequency - 1.0)}


def swing_reference(
    problem: Problem,
    *,
    duration: float,
    instants: Array,
    meshes: Sequence[int] = SWING_MESHES,
    element: str = "corotational",
) -> SwingReference:
    """Release `problem` from the end of its path on the meshes and return their limit at `instants` (T,) [s].

    The meshes are refined by `RATIO` each.

    Args:
        duration: of the motion [s]. meshes: elements per strip, coarse to fine [1].
        element: "corotational" or "reissner".

    Raises:
        NoReference: a motion stopped early.
    """
    settings = (FeSettings(elements=count, element=element) for count in meshes)
    levels = [answer_release(problem, each, duration=duration, records=RECORDS) for each in settings]
    source, swings = _extrapolated(levels), [sampled(level, instants) for level in levels]
    limits = {name: extrapolate([getattr(swing, name) for swing in swings], ratio=RATIO) for name in SWUNG}
    before = extrapolate([swing.rotation for swing in swings[:-1]], ratio=RATIO).value
    values: dict[str, Any] = {name: limit.value for name, limit in limits.items()}
    frequency = SolvedMotion(time=instants, **values).frequency
    centre = limits["centre"].uncertainty.max(axis=0)
    uncertainty = {
        "rotation_rad": float(limits["rotation"].uncertainty.max()),
        "com_x_m": float(centre[0]),
        "com_y_m": float(centre[1]),
        "frequency": abs(swing_frequency(instants, before).value / frequency - 1.0),
    }
    return SwingReference(time=instants, **values, uncertainty=uncertainty, source=source)
