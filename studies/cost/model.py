"""The models that are compared: what each answers, what all check alike, the pivot as it is given."""

import math
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from studies.answers.adapters import answer_release, answer_static
from studies.answers.motion import Motion
from studies.answers.reference import RECORDS, SolvedPath
from studies.answers.response import Response
from studies.answers.settings import FeSettings, Settings, SplineSettings
from studies.cases.design import Design
from studies.cases.problem import Problem
from studies.errors import BadInput
from studies.kinds import Array


@dataclass(eq=False, kw_only=True)
class Model:
    """A model that is compared; keywords in `settings` are its own.

    Attributes:
        name: of the model. sheared: whether its strips shear.
    """

    name: str
    sheared: bool = False

    def installed(self) -> bool:
        """Return whether it can be asked, as all that need no other code."""
        return True

    def path(self, *args: Any, **settings: Any) -> Any:
        """Drive the body of a design, `args`, from rest to its rotation in its increments; return the path.

        Raises:
            BadInput: a design or setting out of range. Unanswered: the path is not reached.
        """
        raise NotImplementedError

    def swing(self, *args: Any, **settings: Any) -> Any:
        """Release the body of a design from rest at its rotation, for a duration [s]; return the motion.

        Raises: as of `path`.
        """
        raise NotImplementedError


#: Schemes whose steps are far shorter than what happens between two records.
EXPLICIT = ("leapfrog", "central-difference")


@dataclass(eq=False, kw_only=True)
class _Own(Model):
    """A model of the suite; keywords in `settings` are those of its discretisation and its integrator."""

    discretised: Callable[..., Settings]

    def path(self, design: Design, *, accuracy: float | None = None, **settings: Any) -> Response:
        """Return the path; `accuracy`: that a spline chooses its own control points for [1]."""
        return answer_static(design, self.discretised(**settings), accuracy=accuracy).whole()

    def swing(
        self,
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
        return answer_release(design, self.discretised(**settings), duration=duration, **how).whole()


spline = _Own(name="spline", discretised=SplineSettings)
elements = _Own(name="finite elements", discretised=FeSettings)


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


class State(NamedTuple):
    """A surrogate of one pivot at S rotations: centre of mass of the body (S, 2) [m], driving torque (S,)
    [N m] and its derivative by the rotation (S,) [N m / rad]."""

    centre: Array
    torque: Array
    stiffness: Array


@dataclass(eq=False, kw_only=True)
class Surrogate(Model):
    """A model of statics alone; `law`: what a pivot is at rotations (S,) [rad]."""

    law: Callable[[Problem, Array], State]

    def path(self, problem: Problem) -> SolvedPath:
        """Return the path."""
        turns, begin = turns_of(problem), time.perf_counter()
        found = self.law(problem, turns)
        return SolvedPath(
            rotation=turns,
            centre=found.centre,
            torque=found.torque,
            stiffness=found.stiffness,
            solve_s=time.perf_counter() - begin,
            counters={"unknowns": 1},
        )
