"""The models that are compared: what each answers, what all check alike, the pivot as it is given."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from studies.answers.adapters import answer_release, answer_static
from studies.answers.motion import Motion
from studies.answers.reference import RECORDS
from studies.answers.response import Response
from studies.answers.settings import FeSettings, Settings, SplineSettings
from studies.cases.design import Design
from studies.cases.problem import Problem
from studies.errors import BadInput, Unanswered
from studies.kinds import Array


def _unanswered(*_: Any, **__: Any) -> Any:
    """Stand for the swing of a model of statics alone."""
    raise Unanswered("a model of statics alone")


@dataclass(eq=False, kw_only=True)
class Model:
    """A model that is compared.

    Attributes:
        name: of the model. sheared: whether its strips shear.
        path: of a design and settings of the model, the path on which the body is driven from rest to its
            rotation in its increments. swing: of these and a duration [s], the motion of the body, which is
            released from rest at its rotation. Both raise BadInput for a design or setting out of range, and
            Unanswered where the end is not reached.
        installed: whether the model can be asked.
    """

    name: str
    path: Callable[..., Any]
    swing: Callable[..., Any] = _unanswered
    sheared: bool = False
    installed: Callable[[], bool] = lambda: True


#: Schemes whose steps are far shorter than what happens between two records.
EXPLICIT = ("leapfrog", "central-difference")


def _path(
    kind: Callable[..., Settings], design: Design, *, accuracy: float | None = None, **settings: Any
) -> Response:
    """Return the path; `accuracy`: that a spline chooses its control points for [1]."""
    return answer_static(design, kind(**settings), accuracy=accuracy).whole()


def _swing(
    kind: Callable[..., Settings],
    design: Design,
    duration: float,
    *,
    integrator: str | None = None,
    step: float | None = None,
    **settings: Any,
) -> Motion:
    """Return the motion; the step [s] of an explicit scheme is its own, near the largest stable one."""
    records = RECORDS if integrator in EXPLICIT else None
    how: dict[str, Any] = {"records": records, "integrator": integrator, "step": step}
    return answer_release(design, kind(**settings), duration=duration, **how).whole()


spline = Model(name="spline", path=partial(_path, SplineSettings), swing=partial(_swing, SplineSettings))
elements = Model(name="finite elements", path=partial(_path, FeSettings), swing=partial(_swing, FeSettings))


def turns_of(problem: Problem) -> Array:
    """Return the rotations (S,) of the path of a pivot [rad]."""
    return np.linspace(0.0, problem.rotation, problem.increments + 1)


def steps_of(duration: float, step: float) -> int:
    """Return the number of steps of a motion.

    Raises:
        BadInput: a step [s] that is not positive, or longer than the duration.
    """
    if not 0.0 < step <= duration < math.inf:
        raise BadInput(f"step: got {step} for {duration} s, expected a positive part of the duration [s]")
    return max(1, round(duration / step))


#: The effects of a scene that all models of the comparison have: their error includes neglected ones.
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
        raise BadInput(f"effects: got {', '.join(problem.effects.names)}, expected {', '.join(EFFECTS)}")
    root, tip = (np.array([getattr(strip, end) for strip in problem.strips]) for end in ("start", "end"))
    return Geometry(
        root=root,
        direction=(tip - root) / problem.length,
        tip=tip,
        crossing=np.array(problem.crossing_point),
        centre=np.array(problem.bodies[0].centre),
    )
