"""The models that are compared: what each answers, what all check alike, the pivot as it is given."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from studies.answers.adapters import answer_release, answer_static
from studies.answers.motion import Motion
from studies.answers.reference import RECORDS
from studies.answers.response import Response
from studies.answers.settings import FeSettings, Settings, SplineSettings
from studies.cases.design import Design
from studies.cases.problem import Problem
from studies.errors import BadInput, Unanswered
from studies.kinds import Array

#: Places in the plane, x + iy [m].
Places = NDArray[np.complex128]


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


def ends_of(problem: Problem) -> Places:
    """Return root and tip of both strips of a pivot at rest (2, 2) [m], as x + iy."""
    return np.asarray(np.array([(strip.start, strip.end) for strip in problem.strips]) @ [1.0, 1.0j])


def centre_of(problem: Problem) -> complex:
    """Return the centre of mass of the body of a pivot at rest [m], as x + iy.

    Raises:
        BadInput: a scene of other effects.
    """
    if set(problem.effects.names) != set(EFFECTS):
        raise BadInput(f"effects: got {', '.join(problem.effects.names)}, expected {', '.join(EFFECTS)}")
    return complex(*problem.bodies[0].centre)
