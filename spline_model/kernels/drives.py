"""Driven coordinates, loads and dead weight: rows that are linear in the unknowns (Eq 7)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray


class DriveTable(NamedTuple):
    """One row a driven coordinate, D in all.

    coordinate (D,) its index in z; origin (D,) its value at rest; target (D,) its change at
    factor 1; row (D,) index of its multiplier; turns (D,) 1 for a rotation; first, pairs (D,)
    its piece of times and factors (H,), the history in a motion; begin, until (D,) when it
    holds [s].
    """

    coordinate: NDArray[np.int64]
    origin: NDArray[np.float64]
    target: NDArray[np.float64]
    row: NDArray[np.int64]
    turns: NDArray[np.int64]
    first: NDArray[np.int64]
    pairs: NDArray[np.int64]
    times: NDArray[np.float64]
    factors: NDArray[np.float64]
    begin: NDArray[np.float64]
    until: NDArray[np.float64]


class LoadTable(NamedTuple):
    """One row a generalised force, F in all.

    coordinate (F,) its index in z; value (F,) at factor 1; turns (F,) 1 for a moment;
    first, pairs (F,) its piece of times and factors (H,), the history in a motion.
    """

    coordinate: NDArray[np.int64]
    value: NDArray[np.float64]
    turns: NDArray[np.int64]
    first: NDArray[np.int64]
    pairs: NDArray[np.int64]
    times: NDArray[np.float64]
    factors: NDArray[np.float64]


@njit(cache=True, nogil=True)
def factor_at(time, first, count, times, factors):
    """Value of a piecewise linear history, constant before its first and after its last time."""
    if time <= times[first]:
        return factors[first]
    for i in range(first + 1, first + count):
        if time <= times[i]:
            share = (time - times[i - 1]) / (times[i] - times[i - 1])
            return factors[i - 1] + share * (factors[i] - factors[i - 1])
    return factors[first + count - 1]


@njit(cache=True, nogil=True)
def subtract_drives(z, table, load_factor, gradient, hessian):
    """Subtract lambda (q_i - origin - load_factor * target) and its derivatives."""
    for d in range(table.coordinate.size):
        i, row = table.coordinate[d], table.row[d]
        gradient[row] -= z[i] - table.origin[d] - load_factor * table.target[d]
        gradient[i] -= z[row]
        hessian[row, i] -= 1.0
        hessian[i, row] -= 1.0


@njit(cache=True, nogil=True)
def subtract_loads(table, load_factor, gradient):
    """Subtract the generalised forces."""
    for f in range(table.coordinate.size):
        gradient[table.coordinate[f]] -= load_factor * table.value[f]


@njit(cache=True, nogil=True)
def subtract_weight(weight, gradient):
    """Subtract the dead weight, a constant generalised force (Q,), or none (0,)."""
    for i in range(weight.size):
        gradient[i] -= weight[i]
