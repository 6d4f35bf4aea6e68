"""Mixed stretching: energy, gradient and Hessian in the control points and the axial force."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from spline_model.kernels.chain import add_isotropic
from spline_model.kernels.curve import tangent


class AxialForceTable(NamedTuple):
    """One row a Gauss point.

    first (P,), width (P,), d1 (P, S), weight (P,), speed (P,) as in ``BendingTable``;
    strain (P,) natural strain eps_0; compliance (P,) 1/EA [1/N]; mode_first (P,) index in z
    of the first axial mode of the support, mode_width (P,) their number, modes (P, M) their
    values; measure (P,) code.
    """

    first: NDArray[np.int64]
    width: NDArray[np.int64]
    d1: NDArray[np.float64]
    weight: NDArray[np.float64]
    speed: NDArray[np.float64]
    strain: NDArray[np.float64]
    compliance: NDArray[np.float64]
    mode_first: NDArray[np.int64]
    mode_width: NDArray[np.int64]
    modes: NDArray[np.float64]
    measure: NDArray[np.int64]


@njit(cache=True, nogil=True)
def add_axial_force(z, table, gradient, hessian):
    """Add the derivatives of int (N eps - 1/2 c N^2) W du in z; returns its value [J].

    At a solution the value is the stretching energy 1/2 int c N^2 W du.
    """
    energy = 0.0
    for p in range(table.first.size):
        first, width, d1 = table.first[p], table.width[p], table.d1[p]
        mode_first, mode_width, modes = table.mode_first[p], table.mode_width[p], table.modes[p]
        speed, c, weight = table.speed[p], table.compliance[p], table.weight[p]
        x1, y1 = tangent(z, first, width, d1)
        v = math.sqrt(x1 * x1 + y1 * y1)
        tx, ty = x1 / v, y1 / v
        force = 0.0
        for k in range(mode_width):
            force += modes[k] * z[mode_first + k]

        eps = v / speed - 1.0 - table.strain[p]
        if table.measure[p] == 0:  # W = J0
            value, by_v, by_vv = (force * eps - 0.5 * c * force * force) * speed, force, 0.0
            by_n, by_nv, by_nn = (eps - c * force) * speed, 1.0, -c * speed
        else:  # W = |C'|
            density = force * eps - 0.5 * c * force * force
            value, by_v, by_vv = density * v, density + force * v / speed, 2.0 * force / speed
            by_n, by_nv, by_nn = (eps - c * force) * v, eps - c * force + v / speed, -c * v
        energy += weight * value
        add_isotropic(gradient, hessian, first, width, d1, tx, ty, v, weight * by_v, weight * by_vv)
        for k in range(mode_width):
            row, pk = mode_first + k, weight * modes[k]
            gradient[row] += pk * by_n
            for j in range(mode_width):
                hessian[row, mode_first + j] += pk * by_nn * modes[j]
            for a in range(width):
                column = first + 2 * a
                hx, hy = pk * by_nv * d1[a] * tx, pk * by_nv * d1[a] * ty
                hessian[row, column] += hx
                hessian[column, row] += hx
                hessian[row, column + 1] += hy
                hessian[column + 1, row] += hy
    return energy
