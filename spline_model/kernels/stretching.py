"""Stretching energy by quadrature of the axial strain, its gradient and Hessian (Eqs 13 to 15)."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from spline_model.kernels.chain import add_isotropic
from spline_model.kernels.curve import tangent


class StretchingTable(NamedTuple):
    """One row a Gauss point.

    first (P,), width (P,), d1 (P, S), weight (P,), speed (P,) as in ``BendingTable``;
    strain (P,) natural strain eps_0; rigidity (P,) EA [N]; measure (P,) code of the measure.
    """

    first: NDArray[np.int64]
    width: NDArray[np.int64]
    d1: NDArray[np.float64]
    weight: NDArray[np.float64]
    speed: NDArray[np.float64]
    strain: NDArray[np.float64]
    rigidity: NDArray[np.float64]
    measure: NDArray[np.int64]


@njit(cache=True, nogil=True)
def point_stretching(v, speed, strain0, rigidity, measure):
    """Energy density, force and force derivative in v = |C'|.

    material  1/2 EA eps^2 J0; spatial  1/2 EA eps^2 v; printed: the force of the
    spatial one without the derivative of its length element v.
    """
    eps = v / speed - 1.0 - strain0
    if measure == 0:
        return 0.5 * rigidity * eps * eps * speed, rigidity * eps, rigidity / speed
    energy = 0.5 * rigidity * eps * eps * v
    if measure == 1:
        return (
            energy,
            rigidity * (eps * v / speed + 0.5 * eps * eps),
            rigidity * (v / speed + 2.0 * eps) / speed,
        )
    return energy, rigidity * eps * v / speed, rigidity * (v / speed + eps) / speed


@njit(cache=True, nogil=True)
def add_stretching(z, table, gradient, hessian):
    """Add the gradient and the Hessian of the stretching energy; returns the energy [J]."""
    energy = 0.0
    for p in range(table.first.size):
        first, width, d1 = table.first[p], table.width[p], table.d1[p]
        x1, y1 = tangent(z, first, width, d1)
        v = math.sqrt(x1 * x1 + y1 * y1)
        density, force, slope = point_stretching(
            v, table.speed[p], table.strain[p], table.rigidity[p], table.measure[p]
        )
        weight = table.weight[p]
        energy += weight * density
        add_isotropic(gradient, hessian, first, width, d1, x1 / v, y1 / v, v, weight * force, weight * slope)
    return energy
