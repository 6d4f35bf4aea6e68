"""Discrete gradient of the stretching energies between two states.

With v = |C'| the difference of v is exactly mean(C') / mean(v) . dC', and any energy e(v)
gets the force (e(v1) - e(v0)) / (v1 - v0) along it.
"""

from __future__ import annotations

import math

from numba import njit

from spline_model.kernels.curve import tangent


@njit(cache=True, nogil=True)
def tangents(z0, z1, first, width, d1):
    """C' at both states: x0', y0', x1', y1'."""
    x0, y0 = tangent(z0, first, width, d1)
    x1, y1 = tangent(z1, first, width, d1)
    return x0, y0, x1, y1


@njit(cache=True, nogil=True)
def add_along(gradient, hessian, first, width, d1, mx, my, mean_v, tx, ty, force, slope):
    """Add force * D v and its derivative, D v = m / mean_v, t = C1' / v1, slope = d(force)/d(v1)."""
    dx, dy = mx / mean_v, my / mean_v
    turn = 0.5 * force / mean_v
    rate = slope - turn
    hxx, hxy = rate * dx * tx + turn, rate * dx * ty
    hyx, hyy = rate * dy * tx, rate * dy * ty + turn
    for a in range(width):
        row = first + 2 * a
        gradient[row] += d1[a] * force * dx
        gradient[row + 1] += d1[a] * force * dy
        for b in range(width):
            column, dd = first + 2 * b, d1[a] * d1[b]
            hessian[row, column] += dd * hxx
            hessian[row, column + 1] += dd * hxy
            hessian[row + 1, column] += dd * hyx
            hessian[row + 1, column + 1] += dd * hyy


@njit(cache=True, nogil=True)
def add_discrete_stretching(z0, z1, table, mean_share, rate_share, gradient, hessian):
    """Add the discrete gradient of the stretching energy by quadrature, and its derivative in z1.

    The stress is EA (mean_share mean(eps) + rate_share (eps1 - eps0)), as in bending.
    """
    for p in range(table.first.size):
        first, width, d1 = table.first[p], table.width[p], table.d1[p]
        x0, y0, x1, y1 = tangents(z0, z1, first, width, d1)
        v0, v1 = math.hypot(x0, y0), math.hypot(x1, y1)
        speed, rigidity = table.speed[p], table.rigidity[p]
        rest = 1.0 + table.strain[p]
        e0, e1, mean_v = v0 / speed - rest, v1 / speed - rest, 0.5 * (v0 + v1)
        mean_e = mean_share * 0.5 * (e0 + e1) + rate_share * (e1 - e0)
        share = 0.5 * mean_share + rate_share
        if table.measure[p] == 0:
            force, slope = rigidity * mean_e, share * rigidity / speed
        else:
            force = rigidity * (mean_v * mean_e / speed + mean_share * 0.25 * (e0 * e0 + e1 * e1))
            slope = rigidity * (0.5 * mean_e + share * mean_v / speed + mean_share * 0.5 * e1) / speed
        w = table.weight[p]
        add_along(
            gradient,
            hessian,
            first,
            width,
            d1,
            0.5 * (x0 + x1),
            0.5 * (y0 + y1),
            mean_v,
            x1 / v1,
            y1 / v1,
            w * force,
            w * slope,
        )


@njit(cache=True, nogil=True)
def add_discrete_axial_force(z0, z1, table, gradient, hessian):
    """Add the mixed stretching between z0 and z1; the axial force in z1 is the mean one of the step.

    Rows of the force: mean(eps) - c N, so that N D eps is the change of 1/2 c N^2 at the ends.
    Exact for the material measure.
    """
    for p in range(table.first.size):
        first, width, d1 = table.first[p], table.width[p], table.d1[p]
        mode_first, mode_width, modes = table.mode_first[p], table.mode_width[p], table.modes[p]
        speed, c, w = table.speed[p], table.compliance[p], table.weight[p]
        x0, y0, x1, y1 = tangents(z0, z1, first, width, d1)
        v0, v1 = math.hypot(x0, y0), math.hypot(x1, y1)
        mean_v, mx, my = 0.5 * (v0 + v1), 0.5 * (x0 + x1), 0.5 * (y0 + y1)
        force = 0.0
        for k in range(mode_width):
            force += modes[k] * z1[mode_first + k]
        add_along(gradient, hessian, first, width, d1, mx, my, mean_v, x1 / v1, y1 / v1, w * force, 0.0)
        gap = mean_v - (1.0 + table.strain[p]) * speed - c * force * speed
        for k in range(mode_width):
            row, pk = mode_first + k, w * modes[k]
            gradient[row] += pk * gap
            for j in range(mode_width):
                hessian[row, mode_first + j] -= pk * c * speed * modes[j]
            for a in range(width):
                column = first + 2 * a
                hessian[row, column] += 0.5 * pk * d1[a] * x1 / v1
                hessian[row, column + 1] += 0.5 * pk * d1[a] * y1 / v1
                hessian[column, row] += pk * d1[a] * mx / mean_v
                hessian[column + 1, row] += pk * d1[a] * my / mean_v


@njit(cache=True, nogil=True)
def add_discrete_axial_damping(z0, z1, table, relaxation, h, gradient, hessian):
    """Add beta (eps1 - eps0) / h to the rows of the axial force: N = EA (eps + beta d(eps)/dt).

    relaxation (P,) is beta [s] at the points of ``table``, which are those of the mixed stretching.
    """
    for p in range(relaxation.size):
        first, width, d1 = table.first[p], table.width[p], table.d1[p]
        x0, y0, x1, y1 = tangents(z0, z1, first, width, d1)
        v0, v1 = math.hypot(x0, y0), math.hypot(x1, y1)
        w = table.weight[p] * relaxation[p] / h
        for k in range(table.mode_width[p]):
            row, pk = table.mode_first[p] + k, w * table.modes[p, k]
            gradient[row] += pk * (v1 - v0)
            for a in range(width):
                column = first + 2 * a
                hessian[row, column] += pk * d1[a] * x1 / v1
                hessian[row, column + 1] += pk * d1[a] * y1 / v1
