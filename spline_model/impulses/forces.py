"""Gradient and Hessian of what acts on the strips and bodies at an instant."""

from __future__ import annotations

import math

from numba import njit

from spline_model.kernels.axial_force import add_axial_force
from spline_model.kernels.bending import add_bending
from spline_model.kernels.clamps import subtract_clamps
from spline_model.kernels.curve import derivatives, tangent
from spline_model.kernels.drives import factor_at, subtract_weight
from spline_model.kernels.stretching import add_stretching


@njit(cache=True, nogil=True)
def fill(z, tables, time, active, gradient, hessian):
    """Fill gradient (N,) and hessian (N, N) of V - lambda psi - f q at z (N,) and ``time``.

    active (D,) is 1 for the drives that hold; the others have lambda = 0. In the rows of the
    multipliers the gradient is - psi, and the Hessian - psi_q.
    """
    gradient[:] = 0.0
    hessian[:] = 0.0
    add_bending(z, tables.bending, gradient, hessian)
    add_stretching(z, tables.stretching, gradient, hessian)
    add_axial_force(z, tables.axial_force, gradient, hessian)
    subtract_clamps(z, tables.clamps, gradient, hessian)
    subtract_weight(tables.weight, gradient)
    loads = tables.loads
    for f in range(loads.coordinate.size):
        factor = factor_at(time, loads.first[f], loads.pairs[f], loads.times, loads.factors)
        gradient[loads.coordinate[f]] -= factor * loads.value[f]
    drives = tables.drives
    for d in range(drives.coordinate.size):
        i, row = drives.coordinate[d], drives.row[d]
        if active[d] == 0:
            gradient[row] = -z[row]
            hessian[row, row] = -1.0
            continue
        factor = factor_at(time, drives.first[d], drives.pairs[d], drives.times, drives.factors)
        gradient[row] = drives.origin[d] + factor * drives.target[d] - z[i]
        gradient[i] -= z[row]
        hessian[row, i] = hessian[i, row] = -1.0


@njit(cache=True, nogil=True)
def axial_rates(z, v, table, start, rates):
    """Fill rates (M,) of the axial modes' strains, int d(eps)/dt P_k ds0, at z with velocity v (Q,)."""
    rates[:] = 0.0
    for p in range(table.first.size):
        first, d1 = table.first[p], table.d1[p]
        x, y = tangent(z, first, table.width[p], d1)
        vx, vy = tangent(v, first, table.width[p], d1)
        rate = table.weight[p] * (x * vx + y * vy) / math.hypot(x, y)
        for k in range(table.mode_width[p]):
            rates[table.mode_first[p] - start + k] += table.modes[p, k] * rate


@njit(cache=True, nogil=True)
def fill_drag(z, motion, drag):
    """Fill drag (Q, Q): the coordinates' own, and the Kelvin-Voigt damping of bending and stretching at z."""
    drag[:] = 0.0
    for i in range(motion.drag.shape[0]):
        for j in range(motion.drag.shape[0]):
            drag[i, j] = motion.drag[i, j]
    add_bending_damping(z, motion.bending_damping, drag)
    add_stretching_damping(z, motion.stretching_damping, drag)


@njit(cache=True, nogil=True)
def add_bending_damping(z, table, drag):
    """Add the Kelvin-Voigt damping of bending at z to drag (Q, Q): int beta EI (db/dq)^T (db/dq) W du."""
    for p in range(table.first.size):
        first, d1, d2 = table.first[p], table.d1[p], table.d2[p]
        x1, y1, x2, y2 = derivatives(z, first, table.width[p], d1, d2)
        s = x1 * x1 + y1 * y1
        w = table.speed[p] if table.measure[p] == 0 else math.sqrt(s)
        power = 2.0 if table.measure[p] == 0 else 3.0
        c = (x1 * y2 - y1 * x2) * power / s
        scale = 1.0 / (s * w)
        g0, g1, g2, g3 = scale * (y2 - c * x1), scale * (-x2 - c * y1), -scale * y1, scale * x1
        weight = table.weight[p] * table.rigidity[p] * w
        for a in range(table.width[p]):
            row = first + 2 * a
            ax, ay = weight * (d1[a] * g0 + d2[a] * g2), weight * (d1[a] * g1 + d2[a] * g3)
            for b in range(table.width[p]):
                column = first + 2 * b
                bx, by = d1[b] * g0 + d2[b] * g2, d1[b] * g1 + d2[b] * g3
                drag[row, column] += ax * bx
                drag[row, column + 1] += ax * by
                drag[row + 1, column] += ay * bx
                drag[row + 1, column + 1] += ay * by


@njit(cache=True, nogil=True)
def add_stretching_damping(z, table, drag):
    """Add that of stretching by quadrature: int beta EA (d(eps)/dq)^T (d(eps)/dq) W du."""
    for p in range(table.first.size):
        first, d1 = table.first[p], table.d1[p]
        x, y = tangent(z, first, table.width[p], d1)
        length, speed = math.hypot(x, y), table.speed[p]
        w = speed if table.measure[p] == 0 else length
        along = (x / length, y / length)
        weight = table.weight[p] * table.rigidity[p] * w / (speed * speed)
        for a in range(table.width[p]):
            for b in range(table.width[p]):
                for i in range(2):
                    for j in range(2):
                        share = weight * d1[a] * d1[b] * along[i] * along[j]
                        drag[first + 2 * a + i, first + 2 * b + j] += share
