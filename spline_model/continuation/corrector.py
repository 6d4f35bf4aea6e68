"""Newton on a plane across the path: both the unknowns and the load factor are free."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from spline_model.continuation.followed import Followed
from spline_model.newton import FLOOR, MOST_ITERATIONS, TOLERANCE, getrf, getrs

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class Corrected:
    """Where Newton ended: unknowns, load factor, energies [J], norms; reason is empty if it converged."""

    z: Array
    load_factor: float
    energies: tuple[float, float]
    norms: tuple[float, ...]
    reason: str


def correct(work: Followed, z: Array, load_factor: float, normal: Array, along: float) -> Corrected:
    """Newton from (z, load factor), orthogonal to (normal (N,), along) in dimensionless unknowns.

    The bordered matrix is regular at a limit point, where the tangent is not. normal = 0 and
    along = 1 hold the load factor.
    """
    unit, energy = work.unit, work.energy
    size = len(z)
    matrix = np.zeros((size + 1, size + 1))
    matrix[size, :size], matrix[size, size] = normal, along
    right, norms = np.zeros(size + 1), []
    energies, reason = (np.nan, np.nan), ""
    for iteration in range(MOST_ITERATIONS + 1):
        energies = work.evaluate(z, load_factor)
        norms.append(work.norm())
        stalled = len(norms) > 1 and norms[-1] > 0.5 * norms[-2]
        if norms[-1] <= TOLERANCE or (stalled and norms[-1] <= FLOOR):
            break
        if not np.isfinite(norms[-1]) or iteration == MOST_ITERATIONS:
            reason = f"no convergence in {iteration} iterations (residual {norms[-1]:.1e})"
            break
        matrix[:size, size] = -work.push(z, load_factor) * unit / energy
        matrix[:size, :size] = work.hessian * (unit[:, None] * unit / energy)
        right[:size] = -work.gradient * unit / energy
        work.counters.factorisations += 1
        factors, pivots, failed = getrf(matrix)
        if failed:
            reason = "the bordered tangent is singular"
            break
        change = getrs(factors, pivots, right)[0].ravel()
        z, load_factor = z + unit * change[:size], load_factor + float(change[size])
        work.counters.newton_iterations += 1
    return Corrected(z=z, load_factor=load_factor, energies=energies, norms=tuple(norms), reason=reason)
