"""Derivatives of the centreline at a point, from the coordinates of the control points that it sees.

A part of its callers: a call for each point of the quadrature costs a tenth of a time step.
"""

from __future__ import annotations

from numba import njit


@njit(cache=True, nogil=True, inline="always")
def tangent(z, first, width, d1):
    """C' = (x', y') from ``width`` points in z, the first at ``first``, with the basis' derivatives d1."""
    x = y = 0.0
    for a in range(width):
        x += d1[a] * z[first + 2 * a]
        y += d1[a] * z[first + 2 * a + 1]
    return x, y


@njit(cache=True, nogil=True, inline="always")
def derivatives(z, first, width, d1, d2):
    """C' and C'': x', y', x'', y''."""
    x1 = y1 = x2 = y2 = 0.0
    for a in range(width):
        x, y = z[first + 2 * a], z[first + 2 * a + 1]
        x1 += d1[a] * x
        y1 += d1[a] * y
        x2 += d2[a] * x
        y2 += d2[a] * y
    return x1, y1, x2, y2
