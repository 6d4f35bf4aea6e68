"""A wide strip that is bent far between clamps that hold its section flat: a shallow shell, by Ritz.

The mid-surface is bent to a curvature k(s) along and departs from that by w(s, y), of zero mean over the
width, while it moves by u, v in its plane. With y across, of width b,

    V = D/2 int (k + w_ss)^2 + w_yy^2 + 2 nu (k + w_ss) w_yy + 2 (1 - nu) w_sy^2
      + 6 D/t^2 int e_s^2 + e_y^2 + 2 nu e_s e_y + (1 - nu)/2 (u_y + v_s)^2,

    e_s = u_s + n - k w,    e_y = v_y,

with n(s) the mean strain; a moment M(s) works on k. It holds both effects that the models know by themselves:
clamps over the width, where k is small (a plate), and suppressed anticlastic bending, far from clamps
(D. G. Ashwell, Journal of the Royal Aeronautical Society 54 (1950) 708). Legendre polynomials in all fields,
times (1 - s^2)^2 or (1 - s^2) where clamps hold them. Leaves out shear over the thickness.
"""

from dataclasses import dataclass

import numpy as np
from numpy.polynomial.legendre import Legendre, leggauss

from studies.kinds import Array

#: Terms along and across of every field, and of the curvature; Gauss points along and across.
TERMS, POINTS = (18, 5, 12), (60, 24)
ITERATIONS, SETTLED = 40, 1e-9
#: 1 - s^2 in Legendre polynomials.
BUBBLE = (2.0 / 3.0, 0.0, -2.0 / 3.0)


@dataclass(frozen=True, kw_only=True)
class Shell:
    """Values at the quadrature points (Q,) by the unknowns (N,): of bending, of the plane, of their product.

    along, across, twist: k + w_ss, w_yy, w_sy. mean, lateral, shear: u_s + n, v_y, u_y + v_s.
    curvature, rise: k, w. weights: (Q,). load: (N,) work of a moment that is s, from -1 to 1.
    """

    along: Array
    across: Array
    twist: Array
    mean: Array
    lateral: Array
    shear: Array
    curvature: Array
    rise: Array
    weights: Array
    load: Array


def linear_factor(moment: float, *, width: float, thickness: float, nu: float) -> float:
    """Return the secant stiffness over that of a beam [1] under a moment that is linear, with zero mean.

    Args:
        moment: at the ends [EI/L]. width, thickness: over the length [1]. nu: Poisson ratio.
    """
    shell = _shell(width)
    plate = 1.0 / (width * (1.0 - nu**2))  # D, with EI and L of 1
    plane, w = 12.0 * plate / thickness**2, shell.weights[:, None]
    bending = plate * (
        _work(shell.along, shell.along, w)
        + _work(shell.across, shell.across, w)
        + nu * (_work(shell.along, shell.across, w) + _work(shell.across, shell.along, w))
        + 2.0 * (1.0 - nu) * _work(shell.twist, shell.twist, w)
    )
    bending += plane * (
        _work(shell.lateral, shell.lateral, w) + 0.5 * (1.0 - nu) * _work(shell.shear, shell.shear, w)
    )
    force = moment * shell.load
    found = _bent(shell, bending, force, plane, nu)
    return float(moment**2 / 3.0 / (force @ found))


def _bent(shell: Shell, stiffness: Array, force: Array, plane: float, nu: float) -> Array:
    """Return the unknowns in equilibrium, by Newton's method from rest."""
    found, w = np.zeros(len(force)), shell.weights
    for _ in range(ITERATIONS):
        k, rise = shell.curvature @ found, shell.rise @ found
        strain, lateral = shell.mean @ found - k * rise, shell.lateral @ found
        by = shell.mean - k[:, None] * shell.rise - rise[:, None] * shell.curvature
        stress = w * plane * (strain + nu * lateral)
        residual = stiffness @ found - force + by.T @ stress + shell.lateral.T @ (w * plane * nu * strain)
        mixed = nu * _work(by, shell.lateral, w[:, None])
        tangent = stiffness + plane * (_work(by, by, w[:, None]) + mixed + mixed.T)
        bow = _work(shell.curvature, shell.rise, stress[:, None])
        tangent -= bow + bow.T
        scale = 1.0 / np.sqrt(np.abs(np.diag(tangent)))
        step = scale * np.linalg.lstsq(tangent * np.outer(scale, scale), scale * residual, rcond=1e-13)[0]
        found -= step
        if np.abs(shell.curvature @ step).max() <= SETTLED * np.abs(shell.curvature @ found).max():
            return found
    raise ArithmeticError(f"flattening: Newton's method did not settle in {ITERATIONS} iterations")


def _work(one: Array, other: Array, weights: Array) -> Array:
    return (one * weights).T @ other


def _shell(width: float) -> Shell:
    """Return the values of all fields at the quadrature points of a strip of length 1."""
    (s, by_s), (y, by_y) = leggauss(POINTS[0]), leggauss(POINTS[1])
    half, (along, across, bent) = 0.5 * width, TERMS

    def values(fields: list[tuple[Legendre, Legendre]], over_s: int, over_y: int) -> Array:
        """Return derivatives of products of a polynomial along and one across (Q, F)."""
        scale = 2.0**over_s / half**over_y
        each = [np.outer(f.deriv(over_s)(s), g.deriv(over_y)(y)).ravel() for f, g in fields]
        return scale * np.stack(each, axis=1)

    def products(held: int, orders: list[int]) -> list[tuple[Legendre, Legendre]]:
        bubble = Legendre(BUBBLE) ** held
        return [(bubble * Legendre.basis(i), Legendre.basis(j)) for i in range(along) for j in orders]

    even, odd = [2 * j for j in range(1, across + 1)], [2 * j + 1 for j in range(across)]
    rise, axial, lateral = products(2, even), products(1, even), products(1, odd)
    bends = [(Legendre.basis(2 * i + 1), Legendre.basis(0)) for i in range(bent)]
    mean = [(Legendre.basis(i), Legendre.basis(0)) for i in range(2 * along)]
    starts = np.cumsum([0, *map(len, (bends, rise, axial, lateral, mean))])

    def placed(**parts: Array) -> Array:
        whole = np.zeros((len(s) * len(y), int(starts[-1])))
        for name, values_of in parts.items():
            first = starts[("k", "w", "u", "v", "n").index(name)]
            whole[:, first : first + values_of.shape[1]] = values_of
        return whole

    weights = np.outer(0.5 * by_s, half * by_y).ravel()
    curvature = placed(k=values(bends, 0, 0))
    return Shell(
        along=placed(k=values(bends, 0, 0), w=values(rise, 2, 0)),
        across=placed(w=values(rise, 0, 2)),
        twist=placed(w=values(rise, 1, 1)),
        mean=placed(u=values(axial, 1, 0), n=values(mean, 0, 0)),
        lateral=placed(v=values(lateral, 0, 1)),
        shear=placed(u=values(axial, 0, 1), v=values(lateral, 1, 0)),
        curvature=curvature,
        rise=placed(w=values(rise, 0, 0)),
        weights=weights,
        load=curvature.T @ (weights * np.repeat(s, len(y))) / width,
    )
