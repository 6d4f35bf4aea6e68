"""The static operator: gradient and Hessian of L(z) = V - lambda psi - f q, kind by kind.

One compiled function walks the tables; a table of length zero costs its loop test, and
no combination of effects leads to another compilation.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from spline_model.kernels.axial_force import AxialForceTable, add_axial_force
from spline_model.kernels.bending import BendingTable, add_bending
from spline_model.kernels.clamps import ClampTable, subtract_clamps
from spline_model.kernels.drives import (
    DriveTable,
    LoadTable,
    subtract_drives,
    subtract_loads,
    subtract_weight,
)
from spline_model.kernels.stretching import StretchingTable, add_stretching


class Tables(NamedTuple):
    """The flat operator tables of a scene, one a kind of effect; weight (Q,) or (0,) [N]."""

    bending: BendingTable
    stretching: StretchingTable
    axial_force: AxialForceTable
    clamps: ClampTable
    drives: DriveTable
    loads: LoadTable
    weight: NDArray[np.float64]


@njit(cache=True, nogil=True)
def assemble(
    z: NDArray[np.float64],
    tables: Tables,
    load_factor: float,
    gradient: NDArray[np.float64],
    hessian: NDArray[np.float64],
) -> tuple[float, float]:
    """Fill gradient (N,) and hessian (N, N) at z (N,); returns bending and axial energy [J].

    Equilibrium (Eq 19) is gradient = 0: its rows are force balance, axial compatibility
    and, with a minus sign, the constraints.
    """
    gradient[:] = 0.0
    hessian[:] = 0.0
    bending = add_bending(z, tables.bending, gradient, hessian)
    axial = add_stretching(z, tables.stretching, gradient, hessian)
    axial += add_axial_force(z, tables.axial_force, gradient, hessian)
    subtract_clamps(z, tables.clamps, gradient, hessian)
    subtract_drives(z, tables.drives, load_factor, gradient, hessian)
    subtract_loads(tables.loads, load_factor, gradient)
    subtract_weight(tables.weight, gradient)
    return bending, axial
