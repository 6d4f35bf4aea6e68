"""Newton's method on the bordered system of coordinates, axial forces and multipliers.

A control point of a cubic B-spline meets three neighbours on either side, so that of the N^2
entries of the tangent some 17 N are not zero. A dense factorisation takes time in proportion
to N^3; one that keeps to the order of the chain, to N: long B-splines are factorised by their pattern.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from time import perf_counter
from typing import TYPE_CHECKING, Self

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import get_lapack_funcs
from scipy.sparse import csc_matrix, diags_array
from scipy.sparse.linalg import SuperLU, splu

from spline_model.compile import System
from spline_model.quadrature import FIRST, MODE, MODES, WIDTH

if TYPE_CHECKING:
    from spline_model.continuation.followed import Followed

Array = NDArray[np.float64]
Change = Callable[[Array, float], tuple[Array, float]]

getrf, getrs = get_lapack_funcs(("getrf", "getrs"))  # without the checks and warnings of lu_factor

TOLERANCE = 1e-11
"""Largest residual of a solved state, in EI/L^2, EI/L, L and rad."""
FLOOR = 1e-8
"""Below this a residual that Newton no longer halves is the round-off of the residual itself
(it grows with EA L^2 / EI in the paper's stretch form); above it, that is a failure."""
MOST_ITERATIONS = 15
"""From a tangent predictor Newton takes two to four; more than this is a wrong start."""


LEAST_SIZE = 150
"""Unknowns from which on the sparse factorisation is the faster one (measured: two strips of 24 points)."""
LARGEST_FILL = 0.15
"""Share of entries that are not zero above which the dense one is: Bezier curves have 0.3 and more."""

COMPLIANCE = 1e-8
"""Of a constraint when eigenvalues are counted, in L^3/EI: the springs are 1e8 times as stiff as a strip."""


class Laps:
    """A stopwatch: each lap adds the time since the one before to the part it names.

    Parts of a solve: "compile" (tables and arrays from the design), "solve" (the path or the
    motion alone), "recover" (the answer from its states; what it is along the strips is made when asked for).
    """

    def __init__(self) -> None:
        self._seconds: dict[str, float] = {}
        self._last = perf_counter()

    def lap(self, part: str) -> dict[str, float]:
        """End a lap; returns the seconds by part so far."""
        now = perf_counter()
        self._seconds[part] = self._seconds.get(part, 0.0) + now - self._last
        self._last = now
        return dict(self._seconds)


@dataclass(kw_only=True)
class Counters:
    """Work that was done; the same on every machine."""

    increments: int = 0
    halved_increments: int = 0
    newton_iterations: int = 0
    residual_evaluations: int = 0
    tangent_evaluations: int = 0
    factorisations: int = 0


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


@dataclass(frozen=True, kw_only=True, eq=False)
class Pattern:
    """Where a tangent (N, N) can be other than zero, column by column, and the scale of each such entry.

    rows (K,), starts (N + 1,) as of a compressed column matrix; places (K,) in the flattened
    tangent; scale (K,) makes an entry dimensionless.
    """

    rows: NDArray[np.int32]
    starts: NDArray[np.int32]
    places: NDArray[np.int64]
    scale: Array

    @classmethod
    def of(cls, system: System) -> Self | None:
        """The pattern of a system's tangent, or None where a dense factorisation is as fast or needed."""
        size = system.layout.size
        if size < LEAST_SIZE:
            return None
        filled = filled_entries(system)
        if filled.mean() > LARGEST_FILL:
            return None
        columns, rows = np.nonzero(filled.T)
        unit, energy = system.scales.unit, system.scales.energy
        return cls(
            rows=rows.astype(np.int32),
            starts=np.concatenate(([0], np.cumsum(filled.sum(axis=0)))).astype(np.int32),
            places=rows * size + columns,
            scale=unit[rows] * unit[columns] / energy,
        )

    def matrix(self, hessian: Array) -> csc_matrix:
        """The scaled tangent; raises LinAlgError if it is not finite."""
        size = len(self.starts) - 1
        entries = hessian.ravel()[self.places] * self.scale
        if not np.isfinite(entries).all():
            raise np.linalg.LinAlgError("the tangent is not finite")
        return csc_matrix((entries, self.rows, self.starts), shape=(size, size))

    def negative(self, hessian: Array) -> int:
        """Negative eigenvalues of the scaled tangent, by an elimination that stays on the diagonal.

        The empty diagonal of constraints is given a small compliance for it: a stiff spring in the
        place of the constraint, which has the same inertia.
        """
        matrix = self.matrix(hessian)
        soft = diags_array(np.where(matrix.diagonal() == 0.0, -COMPLIANCE, 0.0))
        softened = csc_matrix(matrix + soft)
        options = {"SymmetricMode": True}
        try:
            factors = splu(softened, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=options)
        except RuntimeError:
            raise np.linalg.LinAlgError("the tangent is singular") from None
        pivots = factors.U.diagonal()
        left_diagonal = not np.array_equal(factors.perm_r, factors.perm_c)
        # a pivot that is round-off has the sign of chance, as where a straight strip has no stiffness
        by_chance = np.abs(pivots).min() < np.finfo(float).eps * np.abs(softened.data).max()
        if left_diagonal or by_chance:
            return int((np.linalg.eigvalsh(softened.toarray()) < 0.0).sum())
        return int((pivots < 0.0).sum())

    def factorise(self, hessian: Array) -> SuperLU:
        """LU factors of the scaled tangent, with pivoting; raises LinAlgError if it is singular."""
        matrix = self.matrix(hessian)
        try:
            return splu(matrix, permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True})
        except RuntimeError:
            raise np.linalg.LinAlgError("the tangent is singular") from None


def filled_entries(system: System) -> NDArray[np.bool_]:
    """Which entries of the tangent (N, N) the compiled tables can reach."""
    tables, size = system.tables, system.layout.size
    filled = np.zeros((size, size), dtype=np.bool_)
    spans = np.unique(tables.points.place[:, [FIRST, WIDTH, MODE, MODES]], axis=0)
    for first, width, mode, modes in spans:
        block = np.concatenate((np.arange(first, first + 2 * width), np.arange(mode, mode + modes)))
        filled[np.ix_(block, block)] = True
    drives = tables.drives
    for end, inner, body, row in tables.clamps.place:
        places = [end, end + 1, inner, inner + 1, *range(row, row + 3)]
        places += [] if body < 0 else range(body, body + 3)
        filled[np.ix_(places, places)] = True
    filled[drives.coordinate, drives.row] = filled[drives.row, drives.coordinate] = True
    return filled


def solve(work: Followed, start: Array, load_factor: float, change: Change | None = None) -> Newton:
    """Newton from ``start``, until the residual is below TOLERANCE.

    change: of the unknowns and of the load factor, from both; by default the latter is fixed.
    """
    z, energies, reason = start.copy(), (np.nan, np.nan), ""
    norms: list[float] = []
    for iteration in range(MOST_ITERATIONS + 1):
        energies = work.evaluate(z, load_factor)
        norms.append(work.norm())
        stalled = len(norms) > 1 and norms[-1] > 0.5 * norms[-2]
        if norms[-1] <= TOLERANCE or (stalled and norms[-1] <= FLOOR):
            break
        if not np.isfinite(norms[-1]):
            reason = "the residual is not finite"
            break
        if iteration == MOST_ITERATIONS:
            reason = f"no convergence in {MOST_ITERATIONS} iterations (residual {norms[-1]:.1e})"
            break
        try:
            moved, more = change(z, load_factor) if change else (work.solve(-work.gradient), 0.0)
        except np.linalg.LinAlgError as error:
            reason = str(error)
            break
        z, load_factor = z + moved, load_factor + more
        work.counters.newton_iterations += 1
    return Newton(z=z, load_factor=load_factor, energies=energies, norms=tuple(norms), reason=reason)


def correct(work: Followed, z: Array, load_factor: float, normal: Array, along: float) -> Newton:
    """Newton from (z, load factor), orthogonal to (normal (N,), along) in dimensionless unknowns.

    The bordered matrix is regular at a limit point, where the tangent is not. normal = 0 and
    along = 1 hold the load factor.
    """
    unit, energy, size = work.unit, work.energy, len(z)
    matrix, right = np.zeros((size + 1, size + 1)), np.zeros(size + 1)
    matrix[size, :size], matrix[size, size] = normal, along

    def change(z: Array, load_factor: float) -> tuple[Array, float]:
        matrix[:size, size] = -work.push(z, load_factor) * unit / energy
        matrix[:size, :size] = work.hessian * (unit[:, None] * unit / energy)
        right[:size] = -work.gradient * unit / energy
        work.counters.factorisations += 1
        factors, pivots, failed = getrf(matrix)
        if failed:
            raise np.linalg.LinAlgError("the bordered tangent is singular")
        found = getrs(factors, pivots, right)[0].ravel()
        return unit * found[:size], float(found[size])

    return solve(work, z, load_factor, change)
