"""Loads and drives over a time step, and the work they do.

A moment and a drive's torque act on the Cayley velocity, so that their work over a step is
exactly moment * dtheta: they enter with the factor c(d) = d / (2 tan(d / 2)).
"""

from __future__ import annotations

import math

from numba import njit

from spline_model.kernels.drives import factor_at


@njit(cache=True, nogil=True)
def cayley(change):
    """c(d) = d / (2 tan(d / 2)) and its derivative."""
    if abs(change) < 1e-4:  # the series is exact to round-off here
        return 1.0 - change * change / 12.0, -change / 6.0
    half = 0.5 * change
    tan, sin = math.tan(half), math.sin(half)
    return half / tan, 0.5 / tan - 0.5 * half / (sin * sin)


@njit(cache=True, nogil=True)
def subtract_discrete_loads(table, time, h, delta, gradient, hessian):
    """Subtract the loads at mid-step."""
    for f in range(table.coordinate.size):
        i = table.coordinate[f]
        factor = factor_at(time + 0.5 * h, table.first[f], table.pairs[f], table.times, table.factors)
        value = factor * table.value[f]
        if table.turns[f] == 1:
            c, slope = cayley(delta[i])
            gradient[i] -= value * c
            hessian[i, i] -= value * slope
        else:
            gradient[i] -= value


@njit(cache=True, nogil=True)
def subtract_discrete_drives(z1, table, active, time, h, delta, gradient, hessian):
    """Subtract lambda D psi of the active drives and psi at the end of the step; others have lambda = 0."""
    for d in range(table.coordinate.size):
        i, row = table.coordinate[d], table.row[d]
        if active[d] == 0:
            gradient[row] -= z1[row]
            hessian[row, row] -= 1.0
            continue
        factor = factor_at(time + h, table.first[d], table.pairs[d], table.times, table.factors)
        gradient[row] -= z1[i] - table.origin[d] - factor * table.target[d]
        hessian[row, i] -= 1.0
        if table.turns[d] == 1:
            c, slope = cayley(delta[i])
            gradient[i] -= z1[row] * c
            hessian[i, row] -= c
            hessian[i, i] -= z1[row] * slope
        else:
            gradient[i] -= z1[row]
            hessian[i, row] -= 1.0


@njit(cache=True, nogil=True)
def external_work(z1, tables, active, time, h, delta):
    """Work of loads and drives over a step [J]."""
    work = 0.0
    loads = tables.loads
    for f in range(loads.coordinate.size):
        factor = factor_at(time + 0.5 * h, loads.first[f], loads.pairs[f], loads.times, loads.factors)
        work += factor * loads.value[f] * delta[loads.coordinate[f]]
    drives = tables.drives
    for d in range(drives.coordinate.size):
        if active[d] == 1:
            work += z1[drives.row[d]] * delta[drives.coordinate[d]]
    return work
