"""The rigidity of a straight strip along its length, between ends that are clamped over their whole width.

A clamp holds the section flat, and the strip curls freely again within about its width from there. With
g(s) the share of the curl that is left at s in [0, 1], u = s - 1/2 and a length l,

    EI(s) = EI (1 - nu^2 g(s)) / (1 - nu^2),    (l^2 d^2/ds^2 - 1)^2 g = A,    g = g' = 0 at both clamps,

the double root being that of the plate's equation with one shape across the width. A and l are the numbers
with which a beam of this rigidity has both stiffnesses of the plate (`plate`), exactly and at any width:

    1 / f_b = int EI / EI(s) ds,    1 / f_s = 12 int u^2 EI / EI(s) ds.

It is a rigidity of the section, and so one that holds in large rotations.
"""

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import root

from .errors import InvalidParameter
from .plate import plate_factors

Array = NDArray[np.float64]

#: Gauss points of the strip and of an element: layers at clamps are as thin as a tenth of the width.
STRIP_POINTS, ELEMENT_POINTS = 400, 60
#: Width over length below which the clamps do not see each other: the profile is the same, in widths.
NARROW = 0.05
#: Largest residual of the plate's factors, in parts of the square of Poisson's ratio.
FITTED = 1e-12


def left_by_clamps(width_ratio: float, poisson_ratio: float, places: Array) -> Array:
    """Return g at places s in [0, 1] of a strip of width over length b/L and a Poisson ratio.

    Raises:
        InvalidParameter: a width or a Poisson ratio that no such strip has.
    """
    if poisson_ratio == 0.0:
        return np.ones_like(places)
    return _profile(*_layers(width_ratio, poisson_ratio), np.asarray(places) - 0.5)


def shares(width_ratio: float, poisson_ratio: float, ends: Array, points: int) -> Array:
    """Return g at the points of elements between the places `ends` (E + 1,) in [0, 1], (E, points).

    One point has the mean compliance of its element. Two Gauss points have its first moment as well: what a
    linear moment bends is then that of the strip to second order, however thin the layer at a clamp is.
    """
    x, weights = np.polynomial.legendre.leggauss(ELEMENT_POINTS)
    middle, half = 0.5 * (ends[1:] + ends[:-1]), 0.5 * np.diff(ends)
    g = left_by_clamps(width_ratio, poisson_ratio, middle[:, None] + half[:, None] * x)
    compliance = 1.0 / (1.0 - poisson_ratio**2 * g)
    at = np.array([[0.0]] if points == 1 else [[-1.0, 1.0]]) / np.sqrt(3.0)
    mean, slope = 0.5 * compliance @ weights, 1.5 * compliance @ (weights * x)
    free: Array = 1.0 - 1.0 / (mean[:, None] + slope[:, None] * at)
    return free / poisson_ratio**2 if poisson_ratio else np.ones_like(free)


@lru_cache(maxsize=256)
def _layers(width_ratio: float, poisson_ratio: float) -> tuple[float, float]:
    """Return A and l."""
    if width_ratio < NARROW:
        size, length = _layers(NARROW, poisson_ratio)
        return size, length * width_ratio / NARROW
    factors = plate_factors(width_ratio, poisson_ratio)
    x, weights = np.polynomial.legendre.leggauss(STRIP_POINTS)
    u, weights, square = 0.5 * x, 0.5 * weights, poisson_ratio**2
    known = np.array([factors.constant, factors.linear])

    def residual(logarithms: Array) -> Array:
        size, length = np.exp(logarithms)
        compliance = (1.0 - square) / (1.0 - square * _profile(size, length, u))
        found = 1.0 / np.array([weights @ compliance, 12.0 * (weights * u * u) @ compliance])
        gap: Array = (found - known) / square
        return gap

    fit = root(residual, [0.0, np.log(min(0.2 * width_ratio, 0.25))], tol=1e-14)
    if not np.abs(residual(fit.x)).max() <= FITTED:
        raise InvalidParameter("clamped_width", width_ratio, "a width over length up to 30 [1]")
    size, length = np.exp(fit.x)
    return float(size), float(length)


def _profile(size: float, length: float, u: Array) -> Array:
    """Return A [1 - alpha cosh(u/l) - beta (u/l) sinh(u/l)], all relative to the exponential of the ends."""
    end, e = 0.5 / length, np.abs(u) / length

    def even_and_odd(e: Array) -> tuple[Array, Array]:
        near, far = 0.5 * np.exp(e - end), 0.5 * np.exp(-e - end)
        return near + far, near - far

    (cosh, sinh), (cosh_end, sinh_end) = even_and_odd(e), even_and_odd(np.array(end))
    whole = cosh_end * sinh_end + end * np.exp(-2.0 * end)
    alpha, beta = (sinh_end + end * cosh_end) / whole, -sinh_end / whole
    profile: Array = size * (1.0 - alpha * cosh - beta * e * sinh)
    return profile
