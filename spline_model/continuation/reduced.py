"""The reduced tangent: second variation of the energy on what the constraints leave free."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh, null_space

from spline_model.continuation.followed import Followed

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class ReducedTangent:
    """stiffness (F, F) on the free directions (Q, F), which are orthonormal, all dimensionless (EI/L)."""

    stiffness: Array
    free: Array

    def eigenpair(self, number: int) -> tuple[float, Array]:
        """The eigenvalue of that number from the lowest, 0 on, and its direction (Q,)."""
        values, vectors = eigh(self.stiffness, subset_by_index=(number, number))
        return float(values[0]), np.asarray(self.free @ vectors[:, 0])


def reduced_tangent(work: Followed) -> ReducedTangent:
    """The reduced tangent at the state that ``work`` was last evaluated at.

    Forces with a compliance are condensed; those of clamps, drives and inextensible strips are constraints.
    """
    hessian = work.hessian * (work.unit[:, None] * work.unit / work.energy)
    count = work.count
    rows, between = hessian[count:, :count], hessian[count:, count:]
    soft = np.diag(between) != 0.0
    stiffness = hessian[:count, :count] + rows[soft].T @ np.linalg.solve(
        -between[np.ix_(soft, soft)], rows[soft]
    )
    constraints = rows[~soft]
    norms = np.linalg.norm(constraints, axis=1, keepdims=True)
    free = null_space(constraints / norms) if len(constraints) else np.eye(count)
    return ReducedTangent(stiffness=free.T @ stiffness @ free, free=free)
