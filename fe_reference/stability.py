"""Stability of a state of equilibrium: the negative eigenvalues of its tangent, and the one next to zero."""

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigvalsh
from scipy.sparse import csc_matrix, diags_array
from scipy.sparse.linalg import splu

Array = NDArray[np.float64]

#: Inverse iterations to the critical mode; next to a critical point each gains several digits.
INVERSE_ITERATIONS = 6


def negative_eigenvalues(tangent: csc_matrix) -> int:
    """Return how many eigenvalues of the tangent on the free coordinates are negative; 0: stable.

    K = L D L^T by eliminations on the diagonal, in the order that keeps it sparse: by Sylvester's law of
    inertia D has as many negative entries. If the elimination had to leave the diagonal, the eigenvalues
    themselves are counted.
    """
    try:
        factors = splu(
            tangent, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True}
        )
    except RuntimeError:
        return _counted(tangent)
    if not np.array_equal(factors.perm_r, factors.perm_c):
        return _counted(tangent)
    return int(np.count_nonzero(factors.U.diagonal() < 0.0))


def critical_mode(tangent: csc_matrix) -> tuple[float, Array]:
    """Return the eigenvalue nearest to zero of the tangent, scaled to units on its diagonal, and its mode.

    The mode (n,) is in the coordinates of the tangent, of any size.
    """
    scaled, root = _scaled(tangent)
    factors = splu(scaled)
    mode = np.cos(np.arange(1.0, len(root) + 1.0) ** 2)  # along no symmetry of the structure
    for _ in range(INVERSE_ITERATIONS):
        mode = factors.solve(mode)
        mode /= np.linalg.norm(mode)
    return float(mode @ (scaled @ mode)), mode * root


def _scaled(matrix: csc_matrix) -> tuple[csc_matrix, Array]:
    """Return the matrix with its rows and columns times (n,), which make ones of its diagonal, and these."""
    root = 1.0 / np.sqrt(np.abs(matrix.diagonal()) + np.finfo(float).tiny)
    scale = diags_array(root)
    return csc_matrix(scale @ matrix @ scale), root


def _counted(matrix: csc_matrix) -> int:
    return int(np.count_nonzero(eigvalsh(_scaled(matrix)[0].toarray()) < 0.0))
