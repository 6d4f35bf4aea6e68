"""Newton's method on the unknowns of a followed path."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from time import perf_counter

import numpy as np
from numpy.typing import NDArray

from spline_model.continuation.followed import Followed, solved

Array = NDArray[np.float64]
Change = Callable[[Array, float], tuple[Array, float]]

TOLERANCE = 1e-11
"""Largest residual of a solved state, in EI/L^2, EI/L, L and rad of the longest and the stiffest strip."""
FLOOR = 1e-8
"""The same where neither residual nor correction shrinks: the round-off of the residual, which grows with
EA L^2 / EI in the paper's stretch form, over a stiffness that vanishes."""
LAST = 1e-6
"""Largest correction, in lengths and rad, behind which a residual below its tolerance tells of equilibrium:
what is left is the square of the correction. The residual alone does not tell, where a strip is softer by
orders than the one in whose units it is measured."""
ROUND_OFF = 1e-9
"""Corrections that are smaller and no longer shrink are round-off, whatever the residual: short strips
between long ones answer the last digit of a place with large forces in balance, which move nothing."""
MOST_ITERATIONS = 15
"""From a tangent predictor Newton takes two to four; more than this is a wrong start."""


class Laps:
    """A stopwatch: each lap adds the time since the one before to the part it names.

    Parts of a solve: "compile" (tables and arrays from the design), "solve" (the path or the
    motion alone), "recover" (the answer from its states; what it is along the strips is made when asked for).
    """

    def __init__(self) -> None:
        self._seconds: dict[str, float] = {}
        self._last = perf_counter()

    def lap(self, part: str) -> dict[str, float]:
        """End a lap; return the seconds by part so far."""
        now = perf_counter()
        self._seconds[part] = self._seconds.get(part, 0.0) + now - self._last
        self._last = now
        return dict(self._seconds)


@dataclass(frozen=True, kw_only=True, eq=False)
class Newton:
    """Outcome of one solve: the state, its load factor, energies (bending, axial) [J] and residual norms.

    ``reason`` is empty when it converged and says what went wrong otherwise.
    """

    z: Array
    load_factor: float
    energies: tuple[float, float]
    norms: tuple[float, ...]
    reason: str


def solve(work: Followed, start: Array, load_factor: float, change: Change | None = None) -> Newton:
    """Return Newton's method from ``start`` (N,) at a load factor, until residual and correction are small.

    It also ends if corrections no longer shrink. change: of the unknowns and of the load factor, from both;
    by default the load factor is fixed.
    """
    z, energies, reason = start.copy(), (np.nan, np.nan), ""
    norms: list[float] = []
    before, last = np.inf, (z, load_factor)
    for iteration in range(MOST_ITERATIONS + 1):
        energies = work.evaluate(z, load_factor)
        norms.append(work.norm())
        if len(norms) > 1 and norms[-2] <= TOLERANCE and not norms[-1] <= TOLERANCE:
            z, load_factor = last  # a correction that spoils what was balanced: nothing is stiff along it
            energies = work.evaluate(z, load_factor)
            break
        if not np.isfinite(norms[-1]):
            reason = "the residual is not finite"
            break
        if norms[-1] <= TOLERANCE and before <= LAST:
            break
        try:
            moved, more = change(z, load_factor) if change else (work.solve(-work.gradient), 0.0)
        except np.linalg.LinAlgError as error:
            reason = str(error)
            break
        size = work.size(moved)
        floored = norms[-1] <= FLOOR and len(norms) > 1 and norms[-1] > 0.5 * norms[-2]
        stalled = size > 0.5 * before and (size <= ROUND_OFF or floored)
        if stalled or (norms[-1] <= TOLERANCE and size <= ROUND_OFF):
            break
        if iteration == MOST_ITERATIONS:
            reason = f"no convergence in {MOST_ITERATIONS} iterations (residual {norms[-1]:.1e})"
            break
        last, before = (z, load_factor), size
        z, load_factor = z + moved, load_factor + more
        work.counters.newton_iterations += 1
    return Newton(z=z, load_factor=load_factor, energies=energies, norms=tuple(norms), reason=reason)


def correct(work: Followed, z: Array, load_factor: float, normal: Array, along: float) -> Newton:
    """Return Newton's method from (z (N,), load factor), orthogonal to (normal (N,), along).

    The unknowns are dimensionless. The bordered matrix is regular at a limit point, where the tangent is
    singular. normal = 0 and along = 1 hold the load factor.
    """
    unit, energy, size = work.unit, work.energy, len(z)
    matrix, right = np.zeros((size + 1, size + 1)), np.zeros(size + 1)
    matrix[size, :size], matrix[size, size] = normal, along

    def change(z: Array, load_factor: float) -> tuple[Array, float]:
        matrix[:size, size] = -work.push(z, load_factor) * unit / energy
        matrix[:size, :size] = work.hessian * (unit[:, None] * unit / energy)
        right[:size] = -work.gradient * unit / energy
        work.counters.factorisations += 1
        found = solved(matrix, right)
        return unit * found[:size], float(found[size])

    return solve(work, z, load_factor, change)
