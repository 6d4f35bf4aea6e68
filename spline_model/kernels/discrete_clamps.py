"""Clamps over a time step: constraints at its end, discrete Jacobian over it.

The direction row is m x d / |d at rest|, bilinear in the clamp's direction m and the strip's
end chord d, so that its discrete derivative is exact. Bodies turn by the Cayley map,
mean(omega) = (2 / h) tan(dtheta / 2), with which both energy and angular momentum balance:
R(theta1) - R(theta0) = R'(mid) cos(dtheta / 2) * 2 tan(dtheta / 2).
"""

from __future__ import annotations

import math

from numba import njit


@njit(cache=True, nogil=True)
def subtract_discrete_clamps(z0, z1, table, chord, gradient, hessian):
    """Subtract lambda D psi over the step and psi at its end; chord (C,) is |d| at rest [m]."""
    for c in range(table.end.size):
        end, inner, row, body = table.end[c], table.inner[c], table.row[c], table.body[c]
        bx, by = table.point[c, 0], table.point[c, 1]
        angle0 = z0[body + 2] if body >= 0 else 0.0
        angle1 = z1[body + 2] if body >= 0 else 0.0
        mid, half = 0.5 * (angle0 + angle1), 0.5 * (angle1 - angle0)
        cos_half, sin_half = math.cos(half), math.sin(half)
        fx, fy, moment = z1[row], z1[row + 1], z1[row + 2] / chord[c]

        c1, s1 = math.cos(angle1), math.sin(angle1)
        ax1, ay1 = c1 * bx - s1 * by, s1 * bx + c1 * by
        gx, gy = (z1[body], z1[body + 1]) if body >= 0 else (0.0, 0.0)
        gradient[row] -= z1[end] - gx - ax1
        gradient[row + 1] -= z1[end + 1] - gy - ay1
        gradient[end] -= fx
        gradient[end + 1] -= fy
        for i in range(2):
            hessian[row + i, end + i] -= 1.0
            hessian[end + i, row + i] -= 1.0

        sign = table.sign[c]
        dx1, dy1 = sign * (z1[inner] - z1[end]), sign * (z1[inner + 1] - z1[end + 1])
        dx = 0.5 * (dx1 + sign * (z0[inner] - z0[end]))
        dy = 0.5 * (dy1 + sign * (z0[inner + 1] - z0[end + 1]))
        m1 = table.direction[c] + angle1
        mx1, my1 = math.cos(m1), math.sin(m1)
        mx, my = math.cos(table.direction[c] + mid), math.sin(table.direction[c] + mid)
        gradient[row + 2] -= (mx1 * dy1 - my1 * dx1) / chord[c]
        hessian[row + 2, inner] += my1 * sign / chord[c]
        hessian[row + 2, inner + 1] -= mx1 * sign / chord[c]
        hessian[row + 2, end] -= my1 * sign / chord[c]
        hessian[row + 2, end + 1] += mx1 * sign / chord[c]
        px, py = -my * cos_half * sign, mx * cos_half * sign
        gradient[inner] -= moment * px
        gradient[inner + 1] -= moment * py
        gradient[end] += moment * px
        gradient[end + 1] += moment * py
        hessian[inner, row + 2] -= px / chord[c]
        hessian[inner + 1, row + 2] -= py / chord[c]
        hessian[end, row + 2] += px / chord[c]
        hessian[end + 1, row + 2] += py / chord[c]

        if body >= 0:
            turn = body + 2
            cm, sm = math.cos(mid), math.sin(mid)
            ax, ay = cm * bx - sm * by, sm * bx + cm * by
            gradient[body] += fx
            gradient[body + 1] += fy
            torque = fy * ax - fx * ay + moment * (mx * dx + my * dy)
            gradient[turn] += cos_half * torque
            hessian[row, body] += 1.0
            hessian[row + 1, body + 1] += 1.0
            hessian[body, row] += 1.0
            hessian[body + 1, row + 1] += 1.0
            hessian[row, turn] -= ay1
            hessian[row + 1, turn] += ax1
            hessian[turn, row] -= cos_half * ay
            hessian[turn, row + 1] += cos_half * ax
            hessian[row + 2, turn] += (mx1 * dx1 + my1 * dy1) / chord[c]
            hessian[turn, row + 2] += cos_half * (mx * dx + my * dy) / chord[c]
            twist = -(fx * ax + fy * ay) + moment * (mx * dy - my * dx)
            hessian[turn, turn] += 0.5 * (cos_half * twist - sin_half * torque)
            hx, hy = 0.5 * moment * cos_half * mx * sign, 0.5 * moment * cos_half * my * sign
            hessian[turn, inner] += hx
            hessian[turn, inner + 1] += hy
            hessian[turn, end] -= hx
            hessian[turn, end + 1] -= hy
            # d(p)/d(theta1): p = cos(half) * sign * (-my, mx)
            qx = 0.5 * sign * (sin_half * my - cos_half * mx)
            qy = 0.5 * sign * (-sin_half * mx - cos_half * my)
            hessian[inner, turn] -= moment * qx
            hessian[inner + 1, turn] -= moment * qy
            hessian[end, turn] += moment * qx
            hessian[end + 1, turn] += moment * qy
