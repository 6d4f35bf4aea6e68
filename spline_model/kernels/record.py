"""What is looked at after a step: whether the state is a strip, and what is recorded of it."""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from spline_model.kernels.curve import tangent
from spline_model.kernels.energy import strain_energy

KINETIC, STRAIN, POSITION, VELOCITY, WEIGHT, WORK, DISSIPATED = range(7)
"""Places of a record: kinetic and strain energy [J], largest constraint residual [m] and its rate
[m/s], potential of the weight, work of loads and drives so far, energy dissipated so far [J]."""


@njit(cache=True, nogil=True)
def forward(z, tables):
    """True if every end tangent points forwards and |C'| stays above a tenth of its value at rest."""
    clamps = tables.clamps
    for c in range(clamps.end.size):
        end, inner, sign, body = clamps.end[c], clamps.inner[c], clamps.sign[c], clamps.body[c]
        m = clamps.direction[c] + (z[body + 2] if body >= 0 else 0.0)
        dx, dy = z[inner] - z[end], z[inner + 1] - z[end + 1]
        if not sign * (dx * math.cos(m) + dy * math.sin(m)) > 0.0:
            return False
    table = tables.bending
    for p in range(table.first.size):
        first, d1 = table.first[p], table.d1[p]
        x, y = tangent(z, first, table.width[p], d1)
        if not math.hypot(x, y) > 0.1 * table.speed[p]:
            return False
    return True


@njit(cache=True, nogil=True)
def record(z, v, motion, strains, totals, row):
    """Fill row (7,): see the names of its places."""
    row[KINETIC] = 0.5 * np.dot(v, np.dot(motion.mass, v))
    row[STRAIN] = strain_energy(z, motion.tables, motion.rigidity, v.size, strains)
    position = velocity = 0.0
    clamps = motion.tables.clamps
    for c in range(clamps.end.size):
        end, inner, sign, body = clamps.end[c], clamps.inner[c], clamps.sign[c], clamps.body[c]
        bx, by = clamps.point[c]
        gx = gy = angle = vx = vy = omega = 0.0
        if body >= 0:
            gx, gy, angle = z[body], z[body + 1], z[body + 2]
            vx, vy, omega = v[body], v[body + 1], v[body + 2]
        cos, sin = math.cos(angle), math.sin(angle)
        ax, ay = cos * bx - sin * by, sin * bx + cos * by
        m = clamps.direction[c] + angle
        mx, my = math.cos(m), math.sin(m)
        dx, dy = sign * (z[inner] - z[end]), sign * (z[inner + 1] - z[end + 1])
        wx, wy = sign * (v[inner] - v[end]), sign * (v[inner + 1] - v[end + 1])
        reach = motion.chord[c]
        position = max(position, abs(z[end] - gx - ax), abs(z[end + 1] - gy - ay))
        position = max(position, abs(mx * dy - my * dx) / math.hypot(dx, dy) * reach)
        velocity = max(velocity, abs(v[end] - vx + omega * ay), abs(v[end + 1] - vy - omega * ax))
        velocity = max(velocity, abs(mx * wy - my * wx - omega * (mx * dx + my * dy)))
    row[POSITION] = position
    row[VELOCITY] = velocity
    row[WEIGHT] = 0.0
    for i in range(motion.tables.weight.size):
        row[WEIGHT] -= motion.tables.weight[i] * z[i]
    row[WORK] = totals[0]
    row[DISSIPATED] = totals[1]
