"""Work of loads and drives along an equilibrium path."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import System

Array = NDArray[np.float64]


def gravity_energy(system: System, states: Array) -> Array:
    """Potential of the dead weight against the state at rest, (S,) [J]; zero without gravity."""
    weight = system.weight
    if not weight.size:
        return np.zeros(len(states))
    return -(states[:, : weight.size] - system.rest[: weight.size]) @ weight


def external_work(system: System, t: Array, states: Array, rates: Array) -> Array:
    """Work of loads and drives since the first state, (S,) [J]; t (S,) are the load factors.

    int f . dq with f in proportion to the load factor t, by parts as t f q - int f q dt, and
    int lambda dt of the drives; both integrals by the trapezoidal rule corrected by the end
    slopes, which are known exactly: the error goes with the fourth power of the increment.
    """
    loads, drives = system.loads, system.drives
    value = states[:, loads.coordinate] @ loads.value
    slope = rates[:, loads.coordinate] @ loads.value
    moment = states[:, drives.row] @ drives.target
    moment_slope = rates[:, drives.row] @ drives.target
    by_loads = t * value - t[0] * value[0] - _integral(t, value, slope)
    return np.asarray(by_loads + _integral(t, moment, moment_slope))


def _integral(t: Array, value: Array, slope: Array) -> Array:
    """Running integral of a function with known slopes, shape (S,)."""
    h = np.diff(t)
    parts = h / 2 * (value[1:] + value[:-1]) - h**2 / 12 * np.diff(slope)
    return np.concatenate(([0.0], np.cumsum(parts)))
