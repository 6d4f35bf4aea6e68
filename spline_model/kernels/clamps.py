"""Clamped strip ends: residual, Jacobian and the multipliers' second derivatives (Eqs 5 and 6)."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray


class ClampTable(NamedTuple):
    """One row a clamp.

    end, inner (C,) indices in z of x of the end's control point and of its neighbour;
    sign (C,) +1 at the start of a strip, -1 at its end, so that sign * (inner - end)
    points along C'; body (C,) index in z of x of the body, -1 for the ground; point (C, 2)
    the clamped point, from the body's centre [m]; direction (C,) angle of m at rest [rad];
    row (C,) index in z of the first of its three multipliers.
    """

    end: NDArray[np.int64]
    inner: NDArray[np.int64]
    sign: NDArray[np.float64]
    body: NDArray[np.int64]
    point: NDArray[np.float64]
    direction: NDArray[np.float64]
    row: NDArray[np.int64]


@njit(cache=True, nogil=True)
def body_arm(z, table, c):
    """Arm R(theta) b and the body's rotation, or the ground point and 0."""
    bx, by = table.point[c, 0], table.point[c, 1]
    if table.body[c] < 0:
        return bx, by, 0.0
    angle = z[table.body[c] + 2]
    cos, sin = math.cos(angle), math.sin(angle)
    return cos * bx - sin * by, sin * bx + cos * by, angle


@njit(cache=True, nogil=True)
def subtract_clamps(z, table, gradient, hessian):
    """Subtract lambda psi, its gradient and its Hessian (L = V - lambda psi, Eq 4)."""
    for c in range(table.end.size):
        end, inner, row, body = table.end[c], table.inner[c], table.row[c], table.body[c]
        ax, ay, angle = body_arm(z, table, c)
        fx, fy, moment = z[row], z[row + 1], z[row + 2]

        gx, gy = (z[body], z[body + 1]) if body >= 0 else (0.0, 0.0)
        gradient[row] -= z[end] - gx - ax
        gradient[row + 1] -= z[end + 1] - gy - ay
        gradient[end] -= fx
        gradient[end + 1] -= fy
        _set(hessian, row, end, -1.0)
        _set(hessian, row + 1, end + 1, -1.0)

        sign = table.sign[c]
        dx, dy = sign * (z[inner] - z[end]), sign * (z[inner + 1] - z[end + 1])
        s = dx * dx + dy * dy
        m = table.direction[c] + angle
        mx, my = math.cos(m), math.sin(m)
        gradient[row + 2] -= math.atan2(mx * dy - my * dx, mx * dx + my * dy)
        px, py = -dy / s * sign, dx / s * sign  # d(angle of C') / d(inner)
        gradient[inner] -= moment * px
        gradient[inner + 1] -= moment * py
        gradient[end] += moment * px
        gradient[end + 1] += moment * py
        _set(hessian, row + 2, inner, -px)
        _set(hessian, row + 2, inner + 1, -py)
        _set(hessian, row + 2, end, px)
        _set(hessian, row + 2, end + 1, py)
        hxx = -moment * 2.0 * dx * dy / (s * s)
        hxy = -moment * (dy * dy - dx * dx) / (s * s)
        for i, j, h in ((0, 0, hxx), (0, 1, hxy), (1, 0, hxy), (1, 1, -hxx)):
            hessian[inner + i, inner + j] += h
            hessian[end + i, end + j] += h
            hessian[inner + i, end + j] -= h
            hessian[end + i, inner + j] -= h

        if body >= 0:
            gradient[body] += fx
            gradient[body + 1] += fy
            gradient[body + 2] += fy * ax - fx * ay + moment
            _set(hessian, row, body, 1.0)
            _set(hessian, row + 1, body + 1, 1.0)
            _set(hessian, row, body + 2, -ay)
            _set(hessian, row + 1, body + 2, ax)
            _set(hessian, row + 2, body + 2, 1.0)
            hessian[body + 2, body + 2] -= fx * ax + fy * ay


@njit(cache=True, nogil=True)
def _set(hessian, row, column, value):
    hessian[row, column] += value
    hessian[column, row] += value
