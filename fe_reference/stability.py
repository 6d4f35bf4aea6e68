"""Stability of a state of equilibrium: the negative eigenvalues of its tangent."""

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigvalsh
from scipy.sparse import csc_matrix, diags_array
from scipy.sparse.linalg import splu

from .control import Control

Array = NDArray[np.float64]


def negative_eigenvalues(control: Control, y: Array, parameter: float) -> int:
    """Return how many eigenvalues of the tangent on the free coordinates are negative; 0: stable.

    K = L D L^T by eliminations on the diagonal, in the order that keeps it sparse: by Sylvester's law of
    inertia D has as many negative entries. If the elimination had to leave the diagonal, the eigenvalues
    themselves are counted.
    """
    free = control.free
    block = control.tangent(y, parameter)[:, free][free]
    scale = diags_array(1.0 / np.sqrt(np.abs(block.diagonal()) + np.finfo(float).tiny))
    scaled = csc_matrix(scale @ block @ scale)
    try:
        factors = splu(
            scaled, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True}
        )
    except RuntimeError:
        return _counted(scaled)
    if not np.array_equal(factors.perm_r, factors.perm_c):
        return _counted(scaled)
    return int(np.count_nonzero(factors.U.diagonal() < 0.0))


def _counted(matrix: csc_matrix) -> int:
    return int(np.count_nonzero(eigvalsh(matrix.toarray()) < 0.0))
