"""What all surrogates share: models whose only coordinate is the body's rotation.

With p the rotation, M(p) the inertia and V(p) the energy, Lagrange's equation of T = M p'^2 / 2 is

    M p'' + M' p'^2 / 2 + V' = 0

It is integrated by the classical Runge-Kutta method of order four in compiled code, from Chebyshev series of
M and V' over the range of the swing, exact to round-off. Statics is V' and V'' at the rotations, and the
body's place.
"""

import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.polynomial import chebyshev

from studies.answers.reference import SolvedMotion, SolvedPath
from studies.cases.problem import Problem
from studies.cost.model import Model, steps_of, turns_of
from studies.kinds import Array

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
    """Fill states (T, 2), rotation [rad] and its rate [rad/s], from rest at `start` in steps of h [s]."""
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
