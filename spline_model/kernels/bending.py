"""Bending energy, gradient and Hessian, summed over Gauss points (Eqs 10 to 12)."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from spline_model.kernels.chain import add_to_gradient, add_to_hessian
from spline_model.kernels.curve import derivatives


class BendingTable(NamedTuple):
    """One row a Gauss point; S is the widest support of any basis in the scene.

    first (P,) index in z of x of the first control point of the support; width (P,) its
    number of control points; d1, d2 (P, S) first and second derivatives of the basis;
    weight (P,) Gauss weight; speed (P,) |C0'| [m]; curvature (P,) at rest [1/m];
    rigidity (P,) EI [N m^2]; measure (P,) code of the measure.
    """

    first: NDArray[np.int64]
    width: NDArray[np.int64]
    d1: NDArray[np.float64]
    d2: NDArray[np.float64]
    weight: NDArray[np.float64]
    speed: NDArray[np.float64]
    curvature: NDArray[np.float64]
    rigidity: NDArray[np.float64]
    measure: NDArray[np.int64]


@njit(cache=True, nogil=True)
def point_bending(x1, y1, x2, y2, speed, curvature0, rigidity, measure, g, h):
    """Energy density, gradient g (4,) and Hessian h (4, 4) in p = (x', y', x'', y'').

    f = c |C'|^(-2k) with c = x' y'' - y' x'': k = 1 turning of the tangent per du
    (material), k = 3/2 Frenet curvature (spatial). b = f * scale - kappa_0 is the
    bending strain and w the length element, so that V = 1/2 EI b^2 w.
    """
    s = x1 * x1 + y1 * y1
    v = math.sqrt(s)
    c = x1 * y2 - y1 * x2
    spatial = measure != 0
    k = 1.5 if spatial else 1.0
    scale = 1.0 if spatial else 1.0 / speed
    w = v if spatial else speed
    power = s ** (-k)
    b = c * power * scale - curvature0

    cp = (y2, -x2, -y1, x1)
    sp = (2.0 * x1, 2.0 * y1, 0.0, 0.0)
    wp = (x1 / v, y1 / v, 0.0, 0.0) if spatial else (0.0, 0.0, 0.0, 0.0)
    exact = 0.0 if measure == 2 else 1.0  # the printed forces leave d|C'|/dq out
    f1 = -k * power / s
    f2 = k * (k + 1.0) * c * power / (s * s)
    for i in range(4):
        bi = scale * (cp[i] * power + c * f1 * sp[i])
        g[i] = rigidity * (b * w * bi + exact * 0.5 * b * b * wp[i])
        for j in range(4):
            bj = scale * (cp[j] * power + c * f1 * sp[j])
            bij = f1 * (cp[i] * sp[j] + sp[i] * cp[j]) + f2 * sp[i] * sp[j]
            wij = 0.0
            if i < 2 and j < 2:
                if i == j:
                    bij += 2.0 * c * f1
                if spatial:
                    wij = ((1.0 if i == j else 0.0) - wp[i] * wp[j]) / v
            elif i + j == 3:  # (x', y'') and (y', x'')
                bij += power if (i == 0 or i == 3) else -power
            h[i, j] = rigidity * (
                bi * bj * w
                + b * scale * bij * w
                + b * (bi * wp[j] + exact * wp[i] * bj)
                + exact * 0.5 * b * b * wij
            )
    return 0.5 * rigidity * b * b * w


@njit(cache=True, nogil=True)
def add_bending(z, table, gradient, hessian):
    """Add the gradient and the Hessian of the bending energy; returns the energy [J]."""
    energy = 0.0
    g = np.empty(4)
    h = np.empty((4, 4))
    for p in range(table.first.size):
        first, width = table.first[p], table.width[p]
        d1, d2 = table.d1[p], table.d2[p]
        x1, y1, x2, y2 = derivatives(z, first, width, d1, d2)
        weight = table.weight[p]
        energy += weight * point_bending(
            x1, y1, x2, y2, table.speed[p], table.curvature[p], table.rigidity[p], table.measure[p], g, h
        )
        add_to_gradient(gradient, first, width, d1, d2, weight, g)
        add_to_hessian(hessian, first, width, d1, d2, weight, h)
    return energy
