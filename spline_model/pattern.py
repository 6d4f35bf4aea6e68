"""Sparse elimination of the bordered system of long B-splines.

A control point of a cubic B-spline meets three neighbours on either side, so that of the N^2
entries of the tangent some 17 N are not zero. A dense factorisation takes time in proportion
to N^3; one that keeps to the order of the chain, to N: long B-splines are factorised by their pattern.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_matrix, diags_array
from scipy.sparse.linalg import SuperLU, splu

from spline_model.compile import System
from spline_model.quadrature import FIRST, MODE, MODES, WIDTH

Array = NDArray[np.float64]

LEAST_SIZE = 150
"""Unknowns from which on the sparse factorisation is the faster one (measured: two strips of 24 points)."""
LARGEST_FILL = 0.15
"""Share of entries that are not zero above which the dense one is: Bezier curves have 0.3 and more."""

COMPLIANCE = 1e-8
"""Of a constraint when eigenvalues are counted, in L^3/EI: the springs are 1e8 times as stiff as a strip."""


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
