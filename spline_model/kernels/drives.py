"""Driven coordinates and dead loads: rows that are linear in the unknowns (Eq 7)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray


class DriveTable(NamedTuple):
    """One row a driven coordinate: index in z, value at load factor 1, index of its multiplier; (D,) each."""

    coordinate: NDArray[np.int64]
    target: NDArray[np.float64]
    row: NDArray[np.int64]


class LoadTable(NamedTuple):
    """One row a dead generalised force: index in z (F,) and value at load factor 1 (F,)."""

    coordinate: NDArray[np.int64]
    value: NDArray[np.float64]


@njit(cache=True, nogil=True)
def subtract_drives(z, table, load_factor, gradient, hessian):
    """Subtract lambda (q_i - load_factor * target) and its derivatives."""
    for d in range(table.coordinate.size):
        i, row = table.coordinate[d], table.row[d]
        gradient[row] -= z[i] - load_factor * table.target[d]
        gradient[i] -= z[row]
        hessian[row, i] -= 1.0
        hessian[i, row] -= 1.0


@njit(cache=True, nogil=True)
def subtract_loads(table, load_factor, gradient):
    """Subtract the generalised forces."""
    for f in range(table.coordinate.size):
        gradient[table.coordinate[f]] -= load_factor * table.value[f]
