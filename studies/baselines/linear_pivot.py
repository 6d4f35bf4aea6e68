"""Surrogates of constant stiffness: the linear cross-spring pivot, and the pseudo-rigid body with one pin.

`linear_pivot`: constant stiffness, and a centre shift that grows with the square. With EI and L of a strip,
l the crossing point's distance from the moving end over L, and a the strips' inclination to the ground plate,

    T = K p,  K = 8 (EI/L) (1 - 3 l + 3 l^2)                          [N m, N m / rad]
    d = -(9 l^2 - 9 l + 1) L p^2 / (15 sin(a)),  away from the ground  [m]

where d moves the point of the body that lies at the crossing at rest. Exact for rotations p towards zero
under a pure couple, K for strips that do not stretch (for l = 1/2 for any); leaves out all that follows in
p. Source: the line of Haringx and Wittrick, checked against the spline in the tests. In motion the strips
take the shape of small rotations (a cubic in the arc length) times p: with m, J and mu of body and strips,

    M = J + m |dg/dp|^2 + 2 mu L^3 (b^2/5 + b c/3 + c^2/7),  b = 3 l - 1,  c = 1 - 2 l

`pin_joint`: the model of Jensen and Howell with one pin, a joint at the crossing with a torsional spring.

    T = K p,  K = K_Theta EI / (2 L),  n = height / width of the pivot between its four clamps
    K_Theta = 5.300185 - 1.6866 n + 0.885356 n^2 - 0.2094 n^3 + 0.018385 n^4

The body turns about the crossing point at rest, which stays where it is. Published for strips that cross at
mid-length, as a mean over large rotations: at small ones it is several per cent too stiff, at large ones too
soft. Range of validity 0.5 <= n <= 4 (n = tan(inclination)); outside it is refused. Source: Jensen and
Howell, Mechanism and Machine Theory 37 (2002) 461-476, polynomial as public codes have it; the original was
not at hand. In motion the part of each strip beyond the pin turns with the body,
M = J + m |g - c|^2 + 2 mu (L/2)^3 / 3 with g - c from crossing to centre of mass: constant, so that the swing
is harmonic.
"""

import math
from dataclasses import dataclass

import numpy as np

from studies.baselines.answer import Geometry, geometry_of
from studies.baselines.one_coordinate import Surrogate
from studies.cases.problem import Problem
from studies.errors import BadInput
from studies.kinds import Array

PIN_JOINT = "pin joint"
#: Coefficients of K_Theta in ascending powers of n, and the range they are for.
COEFFICIENTS = (5.300185, -1.6866, 0.885356, -0.2094, 0.018385)
RANGE = (0.5, 4.0)
#: Distance from mid-length, over L, at which strips still count as crossing there.
MID_LENGTH = 1e-6


def small_angle_stiffness(problem: Problem) -> float:
    """Return K of the linear pivot [N m / rad]."""
    rigidity = problem.youngs_modulus * problem.second_moment_of_area
    away = 1.0 - problem.crossing_ratio
    return 8.0 * rigidity / problem.length * (1.0 - 3.0 * away + 3.0 * away**2)


def shift_coefficient(problem: Problem) -> float:
    """Return d / p^2 of the linear pivot [m]."""
    away = 1.0 - problem.crossing_ratio
    return -(9.0 * away**2 - 9.0 * away + 1.0) * problem.length / (15.0 * math.sin(problem.inclination))


def stiffness_coefficient(ratio: float) -> float:
    """Return K_Theta at n = `ratio` [1]."""
    return float(np.polynomial.polynomial.polyval(ratio, COEFFICIENTS))


@dataclass(frozen=True, kw_only=True)
class _LinearPivot:
    """The law of one pivot with a constant stiffness; see `studies.baselines.one_coordinate.Law`."""

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


def _linear_law(problem: Problem) -> _LinearPivot:
    """Return the law of the linear pivot."""
    away = 1.0 - problem.crossing_ratio
    b, c = 3.0 * away - 1.0, 1.0 - 2.0 * away
    strip = problem.density * problem.area * problem.length**3
    strips = 2.0 * strip * (b**2 / 5.0 + b * c / 3.0 + c**2 / 7.0)
    return _LinearPivot(
        at_rest=geometry_of(problem),
        constant=small_angle_stiffness(problem),
        shift=shift_coefficient(problem),
        mass=problem.body_mass,
        turning_inertia=problem.body_moment_of_inertia + strips,
    )


def _pinned_law(problem: Problem) -> _LinearPivot:
    """Return the law of the pin joint: that of the linear pivot without a shift.

    Raises:
        BadInput: a pivot outside the model's range.
    """
    if abs(problem.crossing_ratio - 0.5) > MID_LENGTH:
        raise BadInput(
            f"{PIN_JOINT}: got crossing ratio {problem.crossing_ratio:g}, expected 0.5 "
            "(crossing at mid-length)"
        )
    ratio = math.tan(problem.inclination)
    if not RANGE[0] <= ratio <= RANGE[1]:
        raise BadInput(f"{PIN_JOINT}: got height / width {ratio:.3g}, expected {RANGE[0]:g} to {RANGE[1]:g}")
    rigidity = problem.youngs_modulus * problem.second_moment_of_area
    strips = 2.0 * problem.density * problem.area * (0.5 * problem.length) ** 3 / 3.0
    return _LinearPivot(
        at_rest=geometry_of(problem),
        constant=stiffness_coefficient(ratio) * rigidity / (2.0 * problem.length),
        shift=0.0,
        mass=problem.body_mass,
        turning_inertia=problem.body_moment_of_inertia + strips,
    )


linear_pivot = Surrogate(model="linear pivot", law_of=_linear_law)
pin_joint = Surrogate(model=PIN_JOINT, law_of=_pinned_law)
