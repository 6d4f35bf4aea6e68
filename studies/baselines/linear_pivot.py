"""The linear closed form of the cross-spring pivot: constant stiffness, and a centre shift that grows with
the square.

With EI and L of a strip, l the crossing point's distance from the moving end over L, and a the strips'
inclination to the ground plate,

    T = K p,  K = 8 (EI/L) (1 - 3 l + 3 l^2)                          [N m, N m / rad]
    d = -(9 l^2 - 9 l + 1) L p^2 / (15 sin(a)),  away from the ground  [m]

where d moves the point of the body that lies at the crossing at rest. Exact for rotations p towards zero
under a pure couple, K for strips that do not stretch (for l = 1/2 for any); leaves out all that follows in
p. Source: the line of Haringx and Wittrick, checked against the spline in the tests.

In motion the strips take the shape of small rotations (a cubic in the arc length) times p: with m, J and mu
of body and strips,

    M = J + m |dg/dp|^2 + 2 mu L^3 (b^2/5 + b c/3 + c^2/7),  b = 3 l - 1,  c = 1 - 2 l
"""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from studies.baselines.answer import BaselineMotion, BaselinePath
from studies.baselines.geometry import Geometry, geometry_of
from studies.baselines.one_coordinate import motion_of, path_of
from studies.cases.problem import Problem
from studies.kinds import Array

MODEL = "linear pivot"


def installed() -> bool:
    """Return True: the model is this file."""
    return True


def static_path(problem: Problem, rotations: Any, *, repeat: int = 1) -> BaselinePath:
    """Return the path through `rotations` (S,) [rad], the first of which is 0."""
    return path_of(law_of(problem), rotations, model=MODEL, settings={}, repeat=repeat)


def release(
    problem: Problem, *, start: float, duration: float, step: float, repeat: int = 1
) -> BaselineMotion:
    """Return the motion after a release at rest at `start` [rad] for `duration` in steps of `step` [s]."""
    return motion_of(
        law_of(problem),
        start=start,
        duration=duration,
        step=step,
        model=MODEL,
        settings={},
        repeat=repeat,
    )


def small_angle_stiffness(problem: Problem) -> float:
    """Return K [N m / rad]."""
    rigidity = problem.youngs_modulus * problem.second_moment_of_area
    away = 1.0 - problem.crossing_ratio
    return 8.0 * rigidity / problem.length * (1.0 - 3.0 * away + 3.0 * away**2)


def shift_coefficient(problem: Problem) -> float:
    """Return d / p^2 [m]."""
    away = 1.0 - problem.crossing_ratio
    return -(9.0 * away**2 - 9.0 * away + 1.0) * problem.length / (15.0 * math.sin(problem.inclination))


@dataclass(frozen=True, kw_only=True)
class LinearPivot:
    """The law of one pivot; see `studies.baselines.one_coordinate.Law`."""

    at_rest: Geometry
    constant: float
    shift: float
    mass: float
    turning_inertia: float

    def centre(self, p: Array) -> Array:
        """Return the centre of mass: about the crossing point, which moves."""
        arm = self.at_rest.centre - self.at_rest.crossing
        cosine, sine = np.cos(p), np.sin(p)
        x = cosine * arm[0] - sine * arm[1]
        y = sine * arm[0] + cosine * arm[1] + self.shift * p**2
        return np.stack((x, y), axis=-1) + self.at_rest.crossing

    def energy(self, p: Array) -> Array:
        """Return K p^2 / 2."""
        return np.asarray(0.5 * self.constant * p**2)

    def torque(self, p: Array) -> Array:
        """Return K p."""
        return np.asarray(self.constant * p)

    def stiffness(self, p: Array) -> Array:
        """Return K."""
        return np.full(len(p), self.constant)

    def inertia(self, p: Array) -> Array:
        """Return M."""
        arm = self.at_rest.centre - self.at_rest.crossing
        cosine, sine = np.cos(p), np.sin(p)
        x = -sine * arm[0] - cosine * arm[1]
        y = cosine * arm[0] - sine * arm[1] + 2.0 * self.shift * p
        return np.asarray(self.turning_inertia + self.mass * (x**2 + y**2))


def law_of(problem: Problem) -> LinearPivot:
    """Return the law of a pivot."""
    away = 1.0 - problem.crossing_ratio
    b, c = 3.0 * away - 1.0, 1.0 - 2.0 * away
    strip = problem.density * problem.area * problem.length**3
    strips = 2.0 * strip * (b**2 / 5.0 + b * c / 3.0 + c**2 / 7.0)
    return LinearPivot(
        at_rest=geometry_of(problem),
        constant=small_angle_stiffness(problem),
        shift=shift_coefficient(problem),
        mass=problem.body_mass,
        turning_inertia=problem.body_moment_of_inertia + strips,
    )
