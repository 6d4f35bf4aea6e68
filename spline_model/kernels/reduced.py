"""Equations of motion in reduced coordinates: the clamps solved instead of enforced.

At a clamp the end control point follows from the body's pose and its neighbour lies on the
clamp's direction at a distance of its own, so that r holds, for each clamp, that distance
over its value at rest, all other control points, and the bodies' poses:

    q = q(r),   J = dq/dr,   J^T M J r'' = -J^T (dV/dq + M J' r')
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from spline_model.kernels.assemble import assemble
from spline_model.kernels.energy import axial_strains


@njit(cache=True, nogil=True)
def expand(r, w, free, clamps, chord, z, jacobian, drift):
    """Fill the coordinates of z, the Jacobian (Q, R) and drift = J' w (Q,) at r with rates w.

    free (F,) are the indices in q that r holds from its start; the clamps' distances follow.
    """
    jacobian[:] = 0.0
    drift[:] = 0.0
    place = np.full(jacobian.shape[0], -1)
    for i in range(free.size):
        z[free[i]] = r[i]
        jacobian[free[i], i] = 1.0
        place[free[i]] = i
    for c in range(clamps.end.size):
        end, inner, sign, body = clamps.end[c], clamps.inner[c], clamps.sign[c], clamps.body[c]
        at = free.size + c
        bx, by = clamps.point[c]
        gx = gy = angle = omega = 0.0
        if body >= 0:
            gx, gy, angle, omega = z[body], z[body + 1], z[body + 2], w[place[body + 2]]
        cos, sin = math.cos(angle), math.sin(angle)
        ax, ay = cos * bx - sin * by, sin * bx + cos * by
        m = clamps.direction[c] + angle
        reach = sign * chord[c]
        mx, my = reach * math.cos(m), reach * math.sin(m)
        s, ds = r[at], w[at]
        z[end], z[end + 1] = gx + ax, gy + ay
        z[inner], z[inner + 1] = gx + ax + s * mx, gy + ay + s * my
        jacobian[inner, at], jacobian[inner + 1, at] = mx, my
        if body >= 0:
            for i in range(2):
                jacobian[end + i, place[body + i]] = 1.0
                jacobian[inner + i, place[body + i]] = 1.0
            turn = place[body + 2]
            jacobian[end, turn], jacobian[end + 1, turn] = -ay, ax
            jacobian[inner, turn], jacobian[inner + 1, turn] = -ay - s * my, ax + s * mx
            spin = omega * omega
            drift[end], drift[end + 1] = -spin * ax, -spin * ay
            drift[inner] = -spin * (ax + s * mx) - 2.0 * omega * ds * my
            drift[inner + 1] = -spin * (ay + s * my) + 2.0 * omega * ds * mx


class Workspace(NamedTuple):
    """What one evaluation fills: z, gradient (N,), hessian (N, N), jacobian (Q, R), drift (Q,)."""

    z: NDArray[np.float64]
    gradient: NDArray[np.float64]
    hessian: NDArray[np.float64]
    jacobian: NDArray[np.float64]
    drift: NDArray[np.float64]
    strains: NDArray[np.float64]


@njit(cache=True, nogil=True)
def acceleration(r, w, free, motion, work):
    """Reduced acceleration (R,) at (r, w); work.z is left at the expanded coordinates."""
    z, strains, tables = work.z, work.strains, motion.tables
    count = motion.mass.shape[0]
    expand(r, w, free, tables.clamps, motion.chord, z, work.jacobian, work.drift)
    axial_strains(z, tables.axial_force, count, strains)
    z[count:] = 0.0
    z[count : count + strains.size] = np.dot(motion.rigidity, strains)
    assemble(z, tables, 1.0, work.gradient, work.hessian)
    force = work.gradient[:count] + np.dot(motion.mass, work.drift)
    inertia = np.dot(work.jacobian.T, np.dot(motion.mass, work.jacobian))
    return np.linalg.solve(inertia, -np.dot(work.jacobian.T, force))


@njit(cache=True, nogil=True)
def runge_kutta(r, w, h, steps, free, motion, work):
    """Take ``steps`` classical Runge-Kutta steps of length h in place; False if the state diverges."""
    for _ in range(steps):
        k1 = acceleration(r, w, free, motion, work)
        w2 = w + 0.5 * h * k1
        k2 = acceleration(r + 0.5 * h * w, w2, free, motion, work)
        w3 = w + 0.5 * h * k2
        k3 = acceleration(r + 0.5 * h * w2, w3, free, motion, work)
        w4 = w + h * k3
        k4 = acceleration(r + h * w3, w4, free, motion, work)
        r += h / 6.0 * (w + 2.0 * w2 + 2.0 * w3 + w4)
        w += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
        # far outside any pose, or not finite: the next stage would only overflow
        if not np.abs(r).max() + 1e-9 * np.abs(w).max() < 1e3:
            return False
    return True
