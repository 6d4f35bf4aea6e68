"""The models that are compared: what each answers, what all check alike, the pivot as it is given.

The only coordinate of a surrogate is the body's rotation. With p the rotation, M(p) the inertia and V(p) the
energy, Lagrange's equation of T = M p'^2 / 2 is

    M p'' + M' p'^2 / 2 + V' = 0

It is integrated by the classical Runge-Kutta method of order four in compiled code, from Chebyshev series of
M and V' over the range of the swing, exact to round-off. Statics is V' and V'' at the rotations, and the
body's place.
"""

import math
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numba import njit
from numpy.polynomial import chebyshev

from studies.answers.adapters import answer_release, answer_static
from studies.answers.motion import Motion
from studies.answers.reference import RECORDS, SolvedMotion, SolvedPath
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


#: Highest degree of the series, and the part of their largest coefficient below which they end.
DEGREE = 64
ROUND_OFF = 1e-14
#: Part of the start by which the series reach further, lest round-off leads out of them.
MARGIN = 0.01


@dataclass(frozen=True, kw_only=True)
class State:
    """A surrogate of one pivot at S rotations p.

    Attributes:
        centre: centre of mass of the body (S, 2) [m].
        energy, torque, stiffness: V (S,) [J], V' [N m] and V'' [N m / rad].
        inertia: M (S,) [kg m^2].
    """

    centre: Array
    energy: Array
    torque: Array
    stiffness: Array
    inertia: Array


#: A surrogate of one pivot: what it is at rotations (S,) [rad].
Law = Callable[[Array], State]


@dataclass(eq=False, kw_only=True)
class Surrogate(Model):
    """A model whose only coordinate is the rotation, by the law of a pivot."""

    law_of: Callable[[Problem], Law]

    def path(self, problem: Problem) -> SolvedPath:
        """Return the path by evaluating its states, which is what `solve_s` is of."""
        law, turns = self.law_of(problem), turns_of(problem)
        begin = time.perf_counter()
        found = law(turns)
        return SolvedPath(
            rotation=turns,
            centre=found.centre,
            torque=found.torque,
            stiffness=found.stiffness,
            solve_s=time.perf_counter() - begin,
            counters={"unknowns": 1},
        )

    def swing(self, problem: Problem, duration: float, *, step: float) -> SolvedMotion:
        """Return the motion in steps of `step` [s]; `solve_s` is of the compiled integration."""
        law, steps = self.law_of(problem), steps_of(duration, step)
        states = np.empty((steps + 1, 2))
        series = _series_of(law, abs(problem.rotation) or 1.0)
        begin = time.perf_counter()
        integrate(problem.rotation, duration / steps, states, *series)
        return SolvedMotion(
            time=np.linspace(0.0, duration, steps + 1),
            rotation=states[:, 0].copy(),
            solve_s=time.perf_counter() - begin,
            counters={"unknowns": 1, "steps": steps, "evaluations": 4 * steps},
        )


def _series_of(law: Law, amplitude: float) -> tuple[float, Array, Array, Array]:
    """Return the reach for swings up to an amplitude [rad], and series of M, M' and V' in p / reach."""
    reach = (1.0 + MARGIN) * amplitude
    u = np.asarray(chebyshev.chebpts1(DEGREE + 1), dtype=float)
    found = law(reach * u)

    def fitted(values: Array) -> Array:
        terms = np.asarray(chebyshev.chebfit(u, values, DEGREE), dtype=float)
        kept = np.flatnonzero(np.abs(terms) > ROUND_OFF * np.abs(terms).max())
        return terms[: kept[-1] + 1]

    inertia = fitted(found.inertia)
    rate = np.asarray(chebyshev.chebder(inertia), dtype=float) / reach
    return reach, inertia, rate, fitted(found.torque)


@njit(cache=True)
def integrate(
    start: float,
    h: float,
    states: Array,
    reach: float,
    inertia: Array,
    inertia_rate: Array,
    torque: Array,
) -> None:
    """Fill states from rest in steps of the classical Runge-Kutta scheme.

    Args:
        start: rotation of the release [rad].
        h: step [s].
        states: (T, 2), rotation [rad] and its rate [rad/s], overwritten.
        reach: rotation of the end of the fits [rad].
        inertia, inertia_rate, torque: Chebyshev coefficients (K,) of the moment of inertia [kg m^2], its
            derivative by the rotation and the torque [N m].
    """
    p, v = start, 0.0
    states[0, 0], states[0, 1] = p, v
    for row in range(1, states.shape[0]):
        a = _acceleration(p, v, reach, inertia, inertia_rate, torque)
        v2 = v + 0.5 * h * a
        a2 = _acceleration(p + 0.5 * h * v, v2, reach, inertia, inertia_rate, torque)
        v3 = v + 0.5 * h * a2
        a3 = _acceleration(p + 0.5 * h * v2, v3, reach, inertia, inertia_rate, torque)
        v4 = v + h * a3
        a4 = _acceleration(p + h * v3, v4, reach, inertia, inertia_rate, torque)
        p += h * (v + 2.0 * v2 + 2.0 * v3 + v4) / 6.0
        v += h * (a + 2.0 * a2 + 2.0 * a3 + a4) / 6.0
        states[row, 0], states[row, 1] = p, v


@njit(cache=True)
def _acceleration(
    p: float, v: float, reach: float, inertia: Array, inertia_rate: Array, torque: Array
) -> float:
    """Return p'' [rad/s^2]."""
    u = p / reach
    return -(0.5 * _clenshaw(inertia_rate, u) * v * v + _clenshaw(torque, u)) / _clenshaw(inertia, u)


@njit(cache=True)
def _clenshaw(terms: Array, u: float) -> float:
    """Return a Chebyshev series at u."""
    last: float = 0.0
    before: float = 0.0
    for k in range(terms.size - 1, 0, -1):
        last, before = terms[k] + 2.0 * u * last - before, last
    return float(terms[0]) + u * last - before
