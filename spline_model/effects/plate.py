"""A strip as a plate: its stiffness in the linear range, and the rigidity along the strip that has it.

Factors: how much stiffer a strip is as a plate whose ends are built in over the whole width. Kirchhoff's
plate of length 1 and width r = b/L, its long edges free, both ends moved as rigid bodies:

    w = w0(x) + z(x, y),    w0'' = 1 or x - 1/2,    z = z_x = 0 at both ends,
    a(w, v) = int w_xx v_xx + w_yy v_yy + nu (w_xx v_yy + w_yy v_xx) + 2 (1 - nu) w_xy v_xy,

z makes the energy least, a(z, v) = -a(w0, v), and the factors on EI of a beam are

    f = (1 - a(z, z) / a(w0, w0)) / (1 - nu^2)

of a constant moment and of one that is linear with zero mean. By Ritz: even Legendre polynomials
across the width, splines along one half of the length, whose knots come closer to the clamp in
proportion, where the corners have their singularities. A complex width gives complex factors, by which
the profile has their derivative. Source: Timoshenko and Woinowsky-Krieger,
Theory of Plates and Shells (1959), chapter 10.

Profile: the rigidity along a strip whose clamps hold its section flat.

    R(s) = EI (1 - nu^2 g(s)) / (1 - nu^2),      s in [0, 1] along the strip, u = s - 1/2,

from EI / (1 - nu^2) at a clamp, where the section cannot curl, to about EI inside. g is the share of the
curl that the clamps leave, the double root of the plate theory with one term across the width,
(l^2 d^2 - 1)^2 g = A with g = g' = 0 at both clamps:

    g = A (1 - alpha cosh(u/l) - beta (u/l) sinh(u/l)).

A and l are such that the strip has both factors of its plate in the linear range,

    1 / f_b = int EI/R ds,      1 / f_s = 12 int u^2 EI/R ds,

so that nothing is fitted to an answer. Neglected: all other nonlinear effects of the plate at large
rotations.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from spline_model.basis import gauss_legendre

Array = NDArray[Any]

ACROSS = 12
"""Even polynomials across the width, up to degree 2 ACROSS; factors stand to 1e-5 for b/L of 0.05 to 2."""
CELLS = 20
"""Knot spans from the clamp on, each twice as long as the one before, to three widths or the middle."""
DEGREE = 5
MOST_STEPS = 30
TOLERANCE = 1e-13
"""Of the two compliances, 1 / f; round-off is some 1e-15."""
NARROWEST = 0.005
"""Width over length below which the profile is the same in widths."""
STEP = 1e-40
"""Of derivatives by a complex step: its square is beyond any round-off."""


class Factors(NamedTuple):
    """Factors on EI for a constant moment and for one that is linear with zero mean [1]."""

    constant: float
    linear: float


def plate_factors(ratio: complex, poisson_ratio: float) -> Factors:
    """Return the factors of a plate on the stiffness of a beam.

    Parameters
    ----------
    ratio : float, 1
        Width over length, above 0; complex for derivatives by a complex step.
    poisson_ratio : float, 1

    Returns
    -------
    Factors
        Of a constant moment, and of one that is linear with zero mean [1]; upper bounds, by about 1e-6.

    References
    ----------
    Timoshenko and Woinowsky-Krieger, Theory of Plates and Shells (1959), ch. 10; the Ritz method of
    ``spline_model.effects.plate``.

    Examples
    --------
    >>> print(f"{plate_factors(0.25, 0.3).constant:.4f}")
    1.0188
    """
    nu, (x, weight, along), (mass, bent, cross, sheared, area) = poisson_ratio, _along(ratio), _across(ratio)
    found: list[Any] = []
    inner = [values[:, 2:] for values in along]  # the first two do not vanish at the clamp
    # functions whose slope vanishes at the middle, the last two as one; those that vanish there themselves
    even = [np.column_stack((values[:, :-2], values[:, -2] + values[:, -1])) for values in inner]
    odd = [values[:, :-1] for values in inner]
    for (value, slope, curvature), moment in ((even, np.ones_like(x)), (odd, x - 0.5)):
        mixed = np.kron(curvature.T @ (weight[:, None] * value), cross)
        stiffness = nu * (mixed + mixed.T)
        stiffness += np.kron(curvature.T @ (weight[:, None] * curvature), mass)
        stiffness += np.kron(value.T @ (weight[:, None] * value), bent)
        stiffness += 2.0 * (1.0 - nu) * np.kron(slope.T @ (weight[:, None] * slope), sheared)
        pull = np.kron((weight * moment) @ curvature, mass[0]) + nu * np.kron(
            (weight * moment) @ value, cross[0]
        )
        saved = pull @ np.linalg.solve(stiffness, pull) / (weight @ moment**2 * area)
        found.append((1.0 - saved).item() / (1.0 - nu * nu))
    return Factors(*found)


def _along(ratio: complex) -> tuple[Array, Array, list[Array]]:
    """Points and weights on half the length, and there the splines with two derivatives."""
    near = 3.0 * ratio if 3.0 * ratio.real < 0.5 else 0.5
    breaks = [0.0, *near * 0.5 ** np.arange(CELLS - 1, -1, -1)]
    if near != 0.5:
        breaks += [0.5 * (near + 0.5), 0.5]
    nodes, weights = gauss_legendre(DEGREE + 1)
    width = np.diff(breaks)[:, None]
    x = (np.array(breaks[:-1])[:, None] + width * (nodes + 1.0) / 2.0).ravel()
    knots = np.concatenate((np.zeros(DEGREE), breaks, np.full(DEGREE, 0.5)))
    span = DEGREE + np.repeat(np.arange(len(width)), len(nodes))
    return x, (width * weights / 2.0).ravel(), [_splines(knots, x, span, order) for order in range(3)]


def _splines(knots: Array, x: Array, span: NDArray[np.int64], order: int) -> Array:
    """That derivative of all splines at x in the spans (P,), by Cox and de Boor: knots may be complex."""
    values: Array = np.eye(len(knots) - 1)[span]
    for degree in range(1, DEGREE + 1):
        gap = knots[degree:] - knots[:-degree]
        over = np.divide(1.0, gap, out=np.zeros_like(gap), where=gap != 0.0)
        if degree <= DEGREE - order:
            left, right = (x[:, None] - knots[:-degree]) * over, (knots[degree:] - x[:, None]) * over
            values = left[:, :-1] * values[:, :-1] + right[:, 1:] * values[:, 1:]
        else:
            values = degree * (over[:-1] * values[:, :-1] - over[1:] * values[:, 1:])
    return values


def _across(ratio: complex) -> tuple[Array, Array, Array, Array, complex]:
    """int Y Y, Y'' Y'', Y Y'' and Y' Y' of the polynomials over the width, and the width; Y_0 = 1."""
    nodes, weights = gauss_legendre(2 * ACROSS + 2)
    even = np.eye(2 * ACROSS + 1)[:, ::2]
    y, dy, ddy = (legendre.legval(nodes, legendre.legder(even, k) if k else even) for k in range(3))
    half = ratio / 2.0
    w = weights * half
    return (
        (y * w) @ y.T,
        (ddy * w) @ ddy.T / half**4,
        (y * w) @ ddy.T / half**2,
        (dy * w) @ dy.T / half**2,
        w.sum(),
    )


@dataclass(frozen=True, kw_only=True)
class _Profile:
    """g(s) of a strip by its size A, its reach l over L, both complex for a complex width, and its Poisson
    ratio."""

    size: complex
    reach: complex
    poisson_ratio: float

    def share(self, s: Array) -> Array:
        """g at s (P,), zero at the clamps."""
        return self.size * (1.0 - _decay(np.asarray(s), self.reach))

    def compliance(self, s: Array, filled: float = 1.0) -> Array:
        """EI / R at s (P,); filled: part of the width that curls."""
        square = self.poisson_ratio**2
        return np.asarray((1.0 - square) / (1.0 - square * filled * self.share(s)))


def _decay(s: Array, reach: complex) -> Array:
    """alpha cosh(u/l) + beta (u/l) sinh(u/l): 1 with zero slope at both ends; relative to e^(1/2l)."""
    half, u = 0.5 / reach, np.abs(s - 0.5) / reach
    small, grown = np.exp(-2.0 * half), 0.5 * np.exp(u - half)
    cosh, sinh = grown * (1.0 + np.exp(-2.0 * u)), grown * (1.0 - np.exp(-2.0 * u))
    cosh_end, sinh_end = 0.5 * (1.0 + small), 0.5 * (1.0 - small)
    determinant = cosh_end * sinh_end + half * (cosh_end**2 - sinh_end**2)
    alpha, beta = (sinh_end + half * cosh_end) / determinant, -sinh_end / determinant
    return np.asarray(alpha * cosh + beta * u * sinh)


@lru_cache(maxsize=256)
def profile_of(ratio: complex, poisson_ratio: float) -> _Profile:
    """Return the profile of a strip of width over length ``ratio`` [1]; it is computed once.

    Newton's method in log A and log l; of a complex ratio in the real part, and their rates for the rest.
    """
    if abs(ratio) < NARROWEST:
        own, share = profile_of(NARROWEST, poisson_ratio), ratio / NARROWEST
        size, reach = 1.0 + (own.size - 1.0) * share, own.reach * share
        return _Profile(size=size, reach=reach, poisson_ratio=poisson_ratio)
    if ratio.imag != 0.0:
        own = profile_of(ratio.real, poisson_ratio)
        part = 1j * ratio.imag / ratio.real * _by_ratio(ratio.real, poisson_ratio)
        size, reach = np.array((own.size, own.reach)) * np.exp(part)
        return _Profile(size=size, reach=reach, poisson_ratio=poisson_ratio)
    aim = 1.0 / np.array(plate_factors(ratio, poisson_ratio))
    ratio, logs = ratio.real, np.log([1.0, 0.2 * ratio.real])
    square = poisson_ratio**2
    for _ in range(MOST_STEPS if square > 0.0 else 0):
        found = _compliances(logs, ratio, poisson_ratio)
        if np.abs(found - aim).max() < TOLERANCE:
            break
        change = np.linalg.solve(_rates(logs, ratio, poisson_ratio), aim - found)
        logs += change * min(1.0, 0.5 / np.abs(change).max())
    else:
        assert square == 0.0, f"no profile for b/L = {ratio:g}, nu = {poisson_ratio:g}"
    return _Profile(size=np.exp(logs[0]), reach=np.exp(logs[1]), poisson_ratio=poisson_ratio)


@lru_cache(maxsize=256)
def _by_ratio(ratio: float, poisson_ratio: float) -> Array:
    """Derivatives (2,) of log A and log l by log(b/L)."""
    if poisson_ratio == 0.0:
        return np.zeros(2)
    own = profile_of(ratio, poisson_ratio)
    aim = 1.0 / np.array(plate_factors(ratio * (1.0 + 1j * STEP), poisson_ratio))
    rates = _rates(np.log([own.size, own.reach]), ratio, poisson_ratio)
    return np.asarray(np.linalg.solve(rates, aim.imag / STEP))


def _rates(logs: Array, ratio: float, poisson_ratio: float) -> Array:
    """Derivatives (2, 2) of both compliances by log A and log l."""
    moved = [_compliances(logs + 1j * STEP * e, ratio, poisson_ratio).imag / STEP for e in np.eye(2)]
    return np.transpose(moved)


def _compliances(logs: Array, ratio: float, poisson_ratio: float) -> Array:
    """1 / f_b and 1 / f_s of a profile."""
    s, weight = graded(ratio, (0.0, 1.0), 16)
    size, reach = np.exp(logs)
    c = _Profile(size=size, reach=reach, poisson_ratio=poisson_ratio).compliance(s)
    return np.array([weight @ c, 12.0 * weight @ (c * (s - 0.5) ** 2)])


@lru_cache(maxsize=256)
def graded(ratio: float, reach: tuple[float, float], points: int) -> tuple[Array, Array]:
    """Return points (points,) and weights (points,) on a reach of [0, 1], graded towards its ends.

    They resolve layers of about 0.1 of the width; ratio: width over length [1].
    """
    layers = [min(0.5, part * ratio) for part in (0.25, 0.5, 1.0, 2.0, 4.0, 8.0)]
    edges = np.array([*reach, *layers, *(1.0 - part for part in layers)])
    edges = np.unique(edges[(edges >= reach[0]) & (edges <= reach[1])])
    nodes, weights = gauss_legendre(points)
    width = np.diff(edges)[:, None]
    return (edges[:-1, None] + width * (nodes + 1.0) / 2.0).ravel(), (width * weights / 2.0).ravel()
