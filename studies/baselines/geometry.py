"""Where the strips of a cross-axis pivot and its body are at rest, as the baselines need it."""

import math
from dataclasses import dataclass

import numpy as np

from studies.cases.problem import Problem
from studies.errors import BadInput
from studies.kinds import Array

#: The effects of a scene that baselines can stand for: what they leave out of these is their error.
EFFECTS = ("bending", "stretching", "strip_inertia", "body_inertia")


@dataclass(frozen=True, kw_only=True)
class Geometry:
    """The pivot at rest: origin at the ground end of strip 1, x along the ground plate.

    Attributes:
        root: (2, 2) ground ends of the strips [m].
        direction: (2, 2) unit vectors from there to the body.
        tip: (2, 2) body ends [m].
        crossing: (2,) where the strips cross [m].
        centre: (2,) centre of mass of the body [m].
    """

    root: Array
    direction: Array
    tip: Array
    crossing: Array
    centre: Array


def geometry_of(problem: Problem) -> Geometry:
    """Return the pivot at rest.

    Raises:
        BadInput: a scene of other effects.
    """
    if set(problem.effects.names) != set(EFFECTS):
        raise BadInput(
            f"baseline: got the effects {', '.join(problem.effects.names)}, expected {', '.join(EFFECTS)}"
        )
    cosine, sine = math.cos(problem.inclination), math.sin(problem.inclination)
    crossing = np.array(problem.crossing_point)
    direction = np.array([[cosine, sine], [-cosine, sine]])
    root = crossing - problem.crossing_ratio * problem.length * direction
    tip = root + problem.length * direction
    return Geometry(
        root=root,
        direction=direction,
        tip=tip,
        crossing=crossing,
        centre=tip.mean(axis=0) + np.array(problem.centre_offset),
    )
