"""The elastic force of one strip, without tangent: what an explicit time step asks for.

As in ``spline_model.strip`` everything is dimensionless, lengths over L and energy over
EI/L, in the ground clamp's frame. The axial forces are condensed:
N = sum P_k (2 k + 1) / c_k int P_k (v - 1) du is, at the Gauss points, one constant matrix
times v - 1.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from spline_model.fast.frame import Grid
from spline_model.strip.compiled import part

Array = NDArray[np.float64]


def axial_matrix(grid: Grid, compliance: Array) -> Array:
    """N at the Gauss points from v - 1 at the Gauss points, (G, G), for compliances (K,) of the modes."""
    stiffness = (2 * np.arange(len(compliance)) + 1) / compliance
    return np.ascontiguousarray((grid.modes * stiffness) @ (grid.modes * grid.weight[:, None]).T)


@part()
def strip_force(s, x, y, grid, axial, at_points, stretch, force_x, force_y):
    """Fill the gradient (n,) of a strip's energy in its points x, y (n,); P0 is at the origin.

    stretch (G,) is left with v - 1. Components in arrays of their own: twice as fast as pairs.
    """
    n, count = x.shape[1], grid.weight.size
    d1, d2 = grid.d1, grid.d2
    evaluate_points(s, x, y, grid, at_points, stretch)
    for p in range(count):
        force = 0.0
        for k in range(count):
            force += axial[s, p, k] * stretch[k]
        x1, y1, x2, y2 = at_points[0, p], at_points[1, p], at_points[2, p], at_points[3, p]
        inverse = 1.0 / (1.0 + stretch[p])
        square = inverse * inverse
        f = (x1 * y2 - y1 * x2) * square  # theta'
        bend, pull = grid.weight[p] * f * square, grid.weight[p] * force * inverse
        at_points[0, p] = bend * (y2 - 2.0 * f * x1) + pull * x1
        at_points[1, p] = bend * (-x2 - 2.0 * f * y1) + pull * y1
        at_points[2, p], at_points[3, p] = -bend * y1, bend * x1
    for i in range(1, n):
        sum_x = sum_y = 0.0
        for p in range(count):
            sum_x += d1[p, i] * at_points[0, p] + d2[p, i] * at_points[2, p]
            sum_y += d1[p, i] * at_points[1, p] + d2[p, i] * at_points[3, p]
        force_x[s, i], force_y[s, i] = sum_x, sum_y


@part()
def evaluate_points(s, x, y, grid, at_points, stretch):
    """C' and C'' at the Gauss points in at_points (4, G), |C'| - 1 in stretch (G,)."""
    for p in range(grid.weight.size):
        x1 = y1 = x2 = y2 = 0.0
        for i in range(1, x.shape[1]):
            u, q = grid.d1[p, i], grid.d2[p, i]
            x1 += u * x[s, i]
            y1 += u * y[s, i]
            x2 += q * x[s, i]
            y2 += q * y[s, i]
        at_points[0, p], at_points[1, p], at_points[2, p], at_points[3, p] = x1, y1, x2, y2
        stretch[p] = math.sqrt(x1 * x1 + y1 * y1) - 1.0


@part()
def strip_energy(s, x, y, grid, axial, at_points, stretch):
    """Bending and axial energy of a strip."""
    evaluate_points(s, x, y, grid, at_points, stretch)
    bending = axial_energy = 0.0
    for p in range(grid.weight.size):
        force = 0.0
        for k in range(grid.weight.size):
            force += axial[s, p, k] * stretch[k]
        c = at_points[0, p] * at_points[3, p] - at_points[1, p] * at_points[2, p]
        f = c / (1.0 + stretch[p]) ** 2
        bending += 0.5 * grid.weight[p] * f * f
        axial_energy += 0.5 * grid.weight[p] * force * stretch[p]
    return bending, axial_energy
