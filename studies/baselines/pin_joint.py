"""The pseudo-rigid-body model of Jensen and Howell with one pin: a joint at the crossing point with a
torsional spring.

    T = K p,  K = K_Theta EI / (2 L),  n = height / width of the pivot between its four clamps
    K_Theta = 5.300185 - 1.6866 n + 0.885356 n^2 - 0.2094 n^3 + 0.018385 n^4

The body turns about the crossing point at rest, which stays where it is. Published for strips that cross at
mid-length, as a mean over large rotations: at small ones it is several per cent too stiff, at large ones too
soft. Range of validity 0.5 <= n <= 4 (n = tan(inclination)); outside it is refused. Source: Jensen and
Howell, Mechanism and Machine Theory 37 (2002) 461-476, polynomial as public codes have it; the original was
not at hand.

In motion the part of each strip beyond the pin turns with the body, M = J + m |g - c|^2 + 2 mu (L/2)^3 / 3
with g - c from crossing to centre of mass: constant, so that the swing is harmonic.
"""

import math
from typing import Any

import numpy as np

from studies.baselines.answer import BaselineMotion, BaselinePath
from studies.baselines.geometry import geometry_of
from studies.baselines.linear_pivot import LinearPivot
from studies.baselines.one_coordinate import motion_of, path_of
from studies.cases.problem import Problem
from studies.errors import BadInput

MODEL = "pin joint"
#: Coefficients of K_Theta in ascending powers of n, and the range they are for.
COEFFICIENTS = (5.300185, -1.6866, 0.885356, -0.2094, 0.018385)
RANGE = (0.5, 4.0)
#: Distance from mid-length, over L, at which strips still count as crossing there.
MID_LENGTH = 1e-6


def installed() -> bool:
    """Return True: the model is this file."""
    return True


def static_path(problem: Problem, rotations: Any, *, repeat: int = 1) -> BaselinePath:
    """Return the path through `rotations` (S,) [rad], the first of which is 0.

    Raises:
        BadInput: a pivot outside the model's range.
    """
    return path_of(law_of(problem), rotations, model=MODEL, settings={}, repeat=repeat)


def release(
    problem: Problem, *, start: float, duration: float, step: float, repeat: int = 1
) -> BaselineMotion:
    """Return the motion after a release at rest at `start` [rad] for `duration` [s] in steps of `step` [s].

    Raises:
        BadInput: a pivot outside the model's range.
    """
    return motion_of(
        law_of(problem),
        start=start,
        duration=duration,
        step=step,
        model=MODEL,
        settings={},
        repeat=repeat,
    )


def stiffness_coefficient(ratio: float) -> float:
    """Return K_Theta at n = `ratio` [1]."""
    return float(np.polynomial.polynomial.polyval(ratio, COEFFICIENTS))


def law_of(problem: Problem) -> LinearPivot:
    """Return the law of a pivot: that of the linear one without a shift.

    Raises:
        BadInput: a pivot outside the model's range.
    """
    if abs(problem.crossing_ratio - 0.5) > MID_LENGTH:
        raise BadInput(
            f"{MODEL}: got crossing ratio {problem.crossing_ratio:g}, expected 0.5 (crossing at mid-length)"
        )
    ratio = math.tan(problem.inclination)
    if not RANGE[0] <= ratio <= RANGE[1]:
        raise BadInput(f"{MODEL}: got height / width {ratio:.3g}, expected {RANGE[0]:g} to {RANGE[1]:g}")
    rigidity = problem.youngs_modulus * problem.second_moment_of_area
    strips = 2.0 * problem.density * problem.area * (0.5 * problem.length) ** 3 / 3.0
    return LinearPivot(
        at_rest=geometry_of(problem),
        constant=stiffness_coefficient(ratio) * rigidity / (2.0 * problem.length),
        shift=0.0,
        mass=problem.body_mass,
        turning_inertia=problem.body_moment_of_inertia + strips,
    )
