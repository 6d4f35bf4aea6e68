"""Surrogates of rigid links and springs: the linear cross-spring pivot, the pin joint and the four-bar.

`linear_pivot`: constant stiffness, and a centre shift that grows with the square. With EI and L of a strip,
l the crossing point's distance from the moving end over L, and a the strips' inclination to the ground plate,

    T = K p,  K = 8 (EI/L) (1 - 3 l + 3 l^2)                          [N m, N m / rad]
    d = -(9 l^2 - 9 l + 1) L p^2 / (15 sin(a)),  away from the ground  [m]

where d moves the point of the body that lies at the crossing at rest. Exact for rotations p towards zero
under a pure couple, K for strips that do not stretch (for l = 1/2 for any); neglects all that follows in
p. Source: the line of Haringx and Wittrick, checked against the spline in the tests.

`pin_joint`: the model of Jensen and Howell with one pin, a joint at the crossing with a torsional spring.

    T = K p,  K = K_Theta EI / (2 L),  n = height / width of the pivot between its four clamps
    K_Theta = 5.300185 - 1.6866 n + 0.885356 n^2 - 0.2094 n^3 + 0.018385 n^4

The body turns about the crossing point at rest, which stays where it is. Published for strips that cross at
mid-length, as a mean over large rotations: at small ones it is several per cent too stiff, at large ones too
soft. Range of validity 0.5 <= n <= 4 (n = tan(inclination)); outside it is refused. Source: Jensen and
Howell, Mechanism and Machine Theory 37 (2002) 461-476, polynomial as public codes have it; the original was
not at hand.

`four_bar`: their model with four pins, crossed rigid links with torsional springs. Each strip is a rigid link
of length c L in the middle of it, with a pin and a spring k at either end; what is left of the strip is rigid
with ground or body. THE PUBLISHED COEFFICIENTS WERE NOT FOUND: c and k are fitted to the exact small-angle
stiffness and centre shift of the pivot (`linear_pivot`), which is not what Jensen and Howell did. For strips
that cross at mid-length this gives c = 2/3 and k = 2 EI/L. Exact, by that fit, for small rotations; neglects
that the real links' springs and lengths change with the load. With q, b the pins' distances from the
crossing towards ground and body, p the rotation, a the inclination, in complex numbers,

    w = q + b e^(ip),  m = arg(w),  h = acos(cos(a) |w| / (q + b)) - a
    V = k (m^2 + (p - m)^2 + 2 h^2)
    u = i w (sqrt((q + b)^2 / |w|^2 - cos(a)^2) - sin(a))

where the links turn by m + h and m - h and u moves the body's point that lies at the crossing at rest.
Source of the model: as of the pin joint; own derivation of the rest.
"""

import math
from typing import Any

import numpy as np

from studies.cases.problem import Problem
from studies.cost.model import Geometry, State, Surrogate, geometry_of
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


def _shift_coefficient(problem: Problem) -> float:
    """Return d / p^2 of the linear pivot [m]."""
    away = 1.0 - problem.crossing_ratio
    return -(9.0 * away**2 - 9.0 * away + 1.0) * problem.length / (15.0 * math.sin(problem.inclination))


def _centre(at_rest: Geometry, p: Array, shift: Any) -> Array:
    """Return the centre of mass (S, 2) of a body whose point at the crossing moves by x + iy [m]."""
    z = shift + complex(*(at_rest.centre - at_rest.crossing)) * np.exp(1j * p)
    return np.stack((z.real, z.imag), axis=-1) + at_rest.crossing


def _constant(problem: Problem, p: Array, stiffness: float, shift: float = 0.0) -> State:
    """Return a pivot of constant stiffness [N m/rad]; shift: of the body's point at the crossing, over p^2
    [m]."""
    centre = _centre(geometry_of(problem), p, 1j * shift * p**2)
    return State(centre, stiffness * p, np.full(len(p), stiffness))


def _linear_law(problem: Problem, p: Array) -> State:
    """Return the linear pivot at rotations p (S,)."""
    return _constant(problem, p, small_angle_stiffness(problem), _shift_coefficient(problem))


def _pinned_law(problem: Problem, p: Array) -> State:
    """Return the pin joint at rotations p (S,): the linear pivot without a shift.

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
    coefficient = float(np.polynomial.polynomial.polyval(ratio, COEFFICIENTS))
    return _constant(problem, p, coefficient * rigidity / (2.0 * problem.length))


def link_length(problem: Problem) -> float:
    """Return the links' length over L, c [1], for which the small-angle centre shift is exact.

    The linkage shifts by q b p^2 / (2 (q + b) sin(a)) with q b = L^2 (c^2/4 - e^2), e = crossing ratio - 1/2.
    """
    offset = problem.crossing_ratio - 0.5
    wanted = _shift_coefficient(problem) * math.sin(problem.inclination) / problem.length
    return 4.0 * wanted + math.sqrt(16.0 * wanted**2 + 4.0 * offset**2)


def spring(problem: Problem) -> float:
    """Return k [N m / rad], with which the small-angle stiffness k (1 + 4 (e / c)^2) is exact."""
    offset = problem.crossing_ratio - 0.5
    return small_angle_stiffness(problem) / (1.0 + 4.0 * (offset / link_length(problem)) ** 2)


def _links(p: Array, ground: float, body: float, inclination: float) -> tuple[tuple[Array, ...], ...]:
    """Return mean rotation m and half difference h of the links, each with two derivatives by p.

    Args:
        ground, body: the pins' distances from the crossing, q and b [m]. inclination: a [rad].
    """
    w = ground + body * np.exp(1j * p)
    size, first, second = _apart(p, ground, body)
    mean_1 = body * (body + ground * np.cos(p)) / size**2
    mean_2 = -ground * body * np.sin(p) / size**2 - 2.0 * mean_1 * first / size
    z, z_1, z_2 = (math.cos(inclination) / (ground + body) * each for each in (size, first, second))
    height = np.sqrt(1.0 - z**2)
    half_2 = -z_2 / height - z * z_1**2 / height**3
    return (np.unwrap(np.angle(w)), mean_1, mean_2), (np.arccos(z) - inclination, -z_1 / height, half_2)


def _apart(p: Array, ground: float, body: float) -> tuple[Array, Array, Array]:
    """Return |w| and its two derivatives by p [m]."""
    size = np.abs(ground + body * np.exp(1j * p))
    first = -ground * body * np.sin(p) / size
    return size, first, (-ground * body * np.cos(p) - first**2) / size


def _shift(p: Array, ground: float, body: float, inclination: float) -> Array:
    """Return the displacement of the body's point at the crossing, as x + iy [m]."""
    size = _apart(p, ground, body)[0]
    height = np.sqrt((ground + body) ** 2 / size**2 - math.cos(inclination) ** 2)
    shift: Array = 1j * (ground + body * np.exp(1j * p)) * (height - math.sin(inclination))
    return shift


def _linkage_law(problem: Problem, p: Array) -> State:
    """Return the linkage at rotations p (S,)."""
    k, left = spring(problem), 0.5 * (1.0 - link_length(problem)) * problem.length
    ground = problem.crossing_ratio * problem.length - left
    body = (1.0 - problem.crossing_ratio) * problem.length - left
    (m, m_1, m_2), (h, h_1, h_2) = _links(p, ground, body, problem.inclination)
    by_mean = m_1**2 + m * m_2 + (1.0 - m_1) ** 2 - (p - m) * m_2
    return State(
        centre=_centre(geometry_of(problem), p, _shift(p, ground, body, problem.inclination)),
        torque=2.0 * k * (m * m_1 + (p - m) * (1.0 - m_1) + 2.0 * h * h_1),
        stiffness=2.0 * k * (by_mean + 2.0 * (h_1**2 + h * h_2)),
    )


linear_pivot = Surrogate(name="linear pivot", law=_linear_law)
pin_joint = Surrogate(name=PIN_JOINT, law=_pinned_law)
four_bar = Surrogate(name="four-bar", law=_linkage_law)
