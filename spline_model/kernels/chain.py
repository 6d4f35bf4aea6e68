"""From derivatives at a Gauss point to derivatives in the control points."""

from __future__ import annotations

from numba import njit


@njit(cache=True, nogil=True)
def add_to_gradient(gradient, first, width, d1, d2, weight, g):
    """Add weight * (dp/dq)^T g, p = (x', y', x'', y''), to the entries from ``first`` on."""
    for a in range(width):
        gradient[first + 2 * a] += weight * (d1[a] * g[0] + d2[a] * g[2])
        gradient[first + 2 * a + 1] += weight * (d1[a] * g[1] + d2[a] * g[3])


@njit(cache=True, nogil=True)
def add_to_hessian(hessian, first, width, d1, d2, weight, h):
    """Add weight * (dp/dq)^T h (dp/dq) to the block that starts at (first, first)."""
    for a in range(width):
        wa1, wa2 = weight * d1[a], weight * d2[a]
        row = first + 2 * a
        for i in range(2):
            left0 = wa1 * h[i, 0] + wa2 * h[i + 2, 0]
            left1 = wa1 * h[i, 1] + wa2 * h[i + 2, 1]
            left2 = wa1 * h[i, 2] + wa2 * h[i + 2, 2]
            left3 = wa1 * h[i, 3] + wa2 * h[i + 2, 3]
            for b in range(width):
                column = first + 2 * b
                hessian[row + i, column] += left0 * d1[b] + left2 * d2[b]
                hessian[row + i, column + 1] += left1 * d1[b] + left3 * d2[b]


@njit(cache=True, nogil=True)
def add_isotropic(gradient, hessian, first, width, d1, tx, ty, v, force, slope):
    """Add a function e(v) of v = |C'| alone, t = C'/v, e' = force and e'' = slope.

    gradient  e' t,    Hessian  e'' t t^T + (e' / v) (1 - t t^T),
    """
    side = force / v
    hxx = slope * tx * tx + side * ty * ty
    hxy = (slope - side) * tx * ty
    hyy = slope * ty * ty + side * tx * tx
    for a in range(width):
        row = first + 2 * a
        gradient[row] += d1[a] * force * tx
        gradient[row + 1] += d1[a] * force * ty
        for b in range(width):
            column, dd = first + 2 * b, d1[a] * d1[b]
            hessian[row, column] += dd * hxx
            hessian[row, column + 1] += dd * hxy
            hessian[row + 1, column] += dd * hxy
            hessian[row + 1, column + 1] += dd * hyy
