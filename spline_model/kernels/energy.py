"""Strain energy alone, without derivatives: what a run records at every step."""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from spline_model.kernels.curve import derivatives, tangent


@njit(cache=True, nogil=True)
def axial_strains(z, table, start, strains):
    """Fill strains (M,) = int eps P_k ds0 of every axial mode, ``start`` being the first one's index in z."""
    strains[:] = 0.0
    for p in range(table.first.size):
        first, d1 = table.first[p], table.d1[p]
        x, y = tangent(z, first, table.width[p], d1)
        gap = table.weight[p] * (math.hypot(x, y) - (1.0 + table.strain[p]) * table.speed[p])
        for k in range(table.mode_width[p]):
            strains[table.mode_first[p] - start + k] += table.modes[p, k] * gap


@njit(cache=True, nogil=True)
def strain_of_bending(z, table, p):
    """Bending strain b [1/m] and length element w [m] at a point."""
    first, d1, d2 = table.first[p], table.d1[p], table.d2[p]
    x1, y1, x2, y2 = derivatives(z, first, table.width[p], d1, d2)
    s = x1 * x1 + y1 * y1
    w = table.speed[p] if table.measure[p] == 0 else math.sqrt(s)
    return (x1 * y2 - y1 * x2) / (s * w) - table.curvature[p], w


@njit(cache=True, nogil=True)
def strain_energy(z, tables, rigidity, start, strains):
    """Strain energy [J] at z; rigidity (M, M) is the inverse compliance of the axial modes."""
    energy = 0.0
    bending = tables.bending
    for p in range(bending.first.size):
        b, w = strain_of_bending(z, bending, p)
        energy += 0.5 * bending.weight[p] * bending.rigidity[p] * b * b * w
    table = tables.stretching
    for p in range(table.first.size):
        first, d1 = table.first[p], table.d1[p]
        x, y = tangent(z, first, table.width[p], d1)
        v = math.hypot(x, y)
        eps = v / table.speed[p] - 1.0 - table.strain[p]
        w = table.speed[p] if table.measure[p] == 0 else v
        energy += 0.5 * table.weight[p] * table.rigidity[p] * eps * eps * w
    axial_strains(z, tables.axial_force, start, strains)
    return energy + 0.5 * np.dot(strains, np.dot(rigidity, strains))
