"""The reference that answers are held against: the limit of refinement of the finite elements."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from studies.answers.adapters import answer_static
from studies.answers.metrics import extrapolate, relative_error, trajectory_error
from studies.answers.response import Response
from studies.answers.settings import FeSettings
from studies.cases.problem import Problem
from studies.kinds import Array

#: Meshes that the limit is taken from: four, so that its own uncertainty can be measured. On finer ones the
#: round-off of the stiffness, which grows fast with the count, exceeds what is left to extrapolate.
MESHES = (20, 40, 80, 160)


class NoReference(RuntimeError):
    """The finite elements do not reach the end of the path, so that there is no reference."""


@dataclass(frozen=True, kw_only=True)
class Reference:
    """Limit of refinement of the finite-element path and how uncertain it is.

    Attributes:
        finest: the response on the finest mesh, for shapes and what else is not extrapolated.
        rotation: (S,) [rad]; centre: (S, 2) [m]; torque: (S,) [N m]; stiffness: (S,) [N m / rad], the limits.
        uncertainty: largest over the path, relative, of "trajectory", "torque" and "stiffness" [1].
    """

    finest: Response
    rotation: Array
    centre: Array
    torque: Array
    stiffness: Array
    uncertainty: Mapping[str, float]


@dataclass(frozen=True, kw_only=True)
class Errors:
    """Errors of one path against a reference, (S,) each: trajectory >= 0, torque and stiffness signed [1]."""

    trajectory: Array
    torque: Array
    stiffness: Array

    def largest(self) -> dict[str, float]:
        """Return the largest magnitude of each over the path [1]."""
        return {
            "trajectory": float(self.trajectory.max()),
            "torque": float(np.abs(self.torque).max()),
            "stiffness": float(np.abs(self.stiffness).max()),
        }


def reference(problem: Problem) -> Reference:
    """Solve `problem` on the meshes and return their limit.

    Raises:
        NoReference: the finite elements do not reach the end of the path.
    """
    return limit_of([answer_static(problem, FeSettings(elements=count)) for count in MESHES])


def limit_of(answers: list[Response]) -> Reference:
    """Return the limit of finite-element answers, each on twice as many elements as the one before.

    Raises:
        NoReference: one of them does not reach the end of the path.
    """
    for answer in answers:
        if not answer.converged:
            raise NoReference(f"reference with {answer.settings['elements']} elements: {answer.message}")
    centre = extrapolate([answer.centre for answer in answers])
    torque = extrapolate([answer.torque for answer in answers])
    stiffness = extrapolate([answer.stiffness for answer in answers])
    uncertainty = {
        "trajectory": float(trajectory_error(centre.value + centre.uncertainty, centre.value).max()),
        "torque": float(relative_error(torque.value + torque.uncertainty, torque.value).max()),
        "stiffness": float(relative_error(stiffness.value + stiffness.uncertainty, stiffness.value).max()),
    }
    return Reference(
        finest=answers[-1],
        rotation=answers[-1].rotation,
        centre=centre.value,
        torque=torque.value,
        stiffness=stiffness.value,
        uncertainty=uncertainty,
    )


def errors(answer: Response, against: Reference) -> Errors:
    """Return the errors of `answer`, of which only the states it reached count."""
    return Errors(
        trajectory=trajectory_error(answer.centre, against.centre),
        torque=relative_error(answer.torque, against.torque),
        stiffness=relative_error(answer.stiffness, against.stiffness),
    )
