"""How much stiffer a strip is as a plate whose ends are built in over the whole width.

Kirchhoff's plate of length 1 and width r = b/L, its long edges free, both ends moved as rigid bodies:

    w = w0(x) + z(x, y),    w0'' = 1 or x - 1/2,    z = z_x = 0 at both ends,
    a(w, v) = int w_xx v_xx + w_yy v_yy + nu (w_xx v_yy + w_yy v_xx) + 2 (1 - nu) w_xy v_xy,

z makes the energy least, a(z, v) = -a(w0, v), and the factors on EI of a beam are

    f = (1 - a(z, z) / a(w0, w0)) / (1 - nu^2)

of a constant moment and of one that is linear with zero mean. By Ritz: even Legendre polynomials
across the width, splines along one half of the length, whose knots come closer to the clamp in
proportion, where the corners have their singularities. A complex width gives complex factors, by which
``spline_model.plate.profile`` has their derivative. Source: Timoshenko and Woinowsky-Krieger,
Theory of Plates and Shells (1959), chapter 10.
"""

from __future__ import annotations

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


class Factors(NamedTuple):
    """Factors on EI for a constant moment and for one that is linear with zero mean [1]."""

    constant: float
    linear: float


def plate_factors(ratio: complex, poisson_ratio: float) -> Factors:
    """The factors of a plate of width over length ``ratio`` > 0; upper bounds, by some 1e-6."""
    nu, (x, weight, along), (mass, bent, cross, sheared, area) = poisson_ratio, _along(ratio), _across(ratio)
    found: list[Any] = []
    for middle, moment in ((_even, np.ones_like(x)), (_odd, x - 0.5)):
        functions = [middle(values[:, 2:]) for values in along]  # the first two do not vanish at the clamp
        value, slope, curvature = functions
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


def _even(values: Array) -> Array:
    """Functions whose slope vanishes at the middle: the last two as one."""
    return np.column_stack((values[:, :-2], values[:, -2] + values[:, -1]))


def _odd(values: Array) -> Array:
    """Functions that vanish at the middle: without the last one."""
    return values[:, :-1]


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
