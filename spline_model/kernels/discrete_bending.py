"""Discrete gradient of the bending energy between two states.

A discrete gradient D V(p0, p1) satisfies D V . (p1 - p0) = V(p1) - V(p0) exactly and tends
to the gradient as p1 -> p0. It is built here from the discrete product rule
d(fg) = mean(f) dg + mean(g) df, which needs no division by the step and is frame
indifferent. Source: McLachlan, Quispel and Robidoux, Phil Trans R Soc A 357 (1999) 1021;
Gonzalez, J Nonlinear Sci 6 (1996) 449.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from spline_model.kernels.chain import add_to_gradient, add_to_hessian


@njit(cache=True, nogil=True)
def inverse_power(s0, s1, spatial):
    """Mean of s^(-k), its divided difference F = (s1^-k - s0^-k) / (s1 - s0), and both ones' d/ds1.

    k = 1 (material) or 3/2 (spatial), s = |C'|^2.
    """
    if not spatial:
        product = s0 * s1
        return 0.5 * (1 / s0 + 1 / s1), -1 / product, -0.5 / (s1 * s1), 1 / (product * s1)
    v0, v1 = math.sqrt(s0), math.sqrt(s1)
    square = s0 + v0 * v1 + s1
    cubes = s0 * v0 * s1 * v1
    divided = -square / (cubes * (v0 + v1))
    by_v1 = divided * ((v0 + 2 * v1) / square - 3 / v1 - 1 / (v0 + v1))
    mean = 0.5 * (1 / (s0 * v0) + 1 / (s1 * v1))
    return mean, divided, -0.75 / (s1 * s1 * v1), by_v1 / (2 * v1)


@njit(cache=True, nogil=True)
def point_discrete_bending(p0, p1, speed, curvature0, rigidity, measure, mean_share, rate_share, g, h):
    """Discrete gradient g (4,) of 1/2 EI b^2 w from p0 to p1 (4,) and its derivative h (4, 4) in p1.

    p = (x', y', x'', y''), b = c s^-k scale - kappa_0, c = x' y'' - y' x''. The stress is
    EI (mean_share mean(b) + rate_share (b1 - b0)): (1, 0) elastic, (0, beta / h) viscous.
    """
    spatial = measure != 0
    s0, s1 = p0[0] ** 2 + p0[1] ** 2, p1[0] ** 2 + p1[1] ** 2
    c0, c1 = p0[0] * p0[3] - p0[1] * p0[2], p1[0] * p1[3] - p1[1] * p1[2]
    v0, v1 = math.sqrt(s0), math.sqrt(s1)
    mean_power, divided, mean_power_s, divided_s = inverse_power(s0, s1, spatial)
    power1 = 1 / (s1 * v1) if spatial else 1 / s1
    power0 = 1 / (s0 * v0) if spatial else 1 / s0
    slope1 = -1.5 / (s1 * s1 * v1) if spatial else -1 / (s1 * s1)
    scale = 1.0 if spatial else 1.0 / speed
    b0, b1 = c0 * power0 * scale - curvature0, c1 * power1 * scale - curvature0
    mean_b = mean_share * 0.5 * (b0 + b1) + rate_share * (b1 - b0)
    mean_c = 0.5 * (c0 + c1)
    w = 0.5 * (v0 + v1) if spatial else speed

    m0, m1, m2, m3 = (
        0.5 * (p0[0] + p1[0]),
        0.5 * (p0[1] + p1[1]),
        0.5 * (p0[2] + p1[2]),
        0.5 * (p0[3] + p1[3]),
    )
    factor = 2.0 * mean_c * divided  # of C'-mean in D(c s^-k)
    d = (
        factor * m0 + mean_power * m3,
        factor * m1 - mean_power * m2,
        -mean_power * m1,
        mean_power * m0,
    )
    cj = (p1[3], -p1[2], -p1[1], p1[0])
    sj = (2 * p1[0], 2 * p1[1], 0.0, 0.0)
    for j in range(4):
        factor_j = cj[j] * divided + 2.0 * mean_c * divided_s * sj[j]
        power_j = mean_power_s * sj[j]
        dj = (
            factor_j * m0
            + power_j * m3
            + (0.5 * factor if j == 0 else 0.0)
            + (0.5 * mean_power if j == 3 else 0.0),
            factor_j * m1
            - power_j * m2
            + (0.5 * factor if j == 1 else 0.0)
            - (0.5 * mean_power if j == 2 else 0.0),
            -power_j * m1 - (0.5 * mean_power if j == 1 else 0.0),
            power_j * m0 + (0.5 * mean_power if j == 0 else 0.0),
        )
        bj = (0.5 * mean_share + rate_share) * scale * (cj[j] * power1 + c1 * slope1 * sj[j])
        wj = 0.25 * sj[j] / v1 if spatial else 0.0
        for i in range(4):
            h[i, j] = rigidity * scale * (bj * w * d[i] + mean_b * wj * d[i] + mean_b * w * dj[i])
    for i in range(4):
        g[i] = rigidity * mean_b * w * scale * d[i]
    if spatial and mean_share > 0.0:  # + 1/2 EI mean(b^2) D|C'|
        push = 0.25 * rigidity * (b0 * b0 + b1 * b1) / w
        for i in range(2):
            mi = m0 if i == 0 else m1
            g[i] += push * mi
            for j in range(4):
                bj = scale * (cj[j] * power1 + c1 * slope1 * sj[j])
                h[i, j] += 0.5 * rigidity * b1 * bj / w * mi - push / w * mi * 0.25 * sj[j] / v1
            h[i, i] += 0.5 * push


@njit(cache=True, nogil=True)
def add_discrete_bending(z0, z1, table, mean_share, rate_share, gradient, hessian):
    """Add the discrete gradient between z0 and z1, and its derivative in z1; shares as in the point."""
    g, h = np.empty(4), np.empty((4, 4))
    p0, p1 = np.empty(4), np.empty(4)
    for p in range(table.first.size):
        first, width = table.first[p], table.width[p]
        d1, d2 = table.d1[p], table.d2[p]
        p0[:] = 0.0
        p1[:] = 0.0
        for a in range(width):
            for i in range(2):
                old, new = z0[first + 2 * a + i], z1[first + 2 * a + i]
                p0[i] += d1[a] * old
                p0[i + 2] += d2[a] * old
                p1[i] += d1[a] * new
                p1[i + 2] += d2[a] * new
        point_discrete_bending(
            p0,
            p1,
            table.speed[p],
            table.curvature[p],
            table.rigidity[p],
            table.measure[p],
            mean_share,
            rate_share,
            g,
            h,
        )
        add_to_gradient(gradient, first, width, d1, d2, table.weight[p], g)
        add_to_hessian(hessian, first, width, d1, d2, table.weight[p], h)
