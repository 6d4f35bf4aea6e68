"""Energy dissipated over a time step."""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from spline_model.kernels.discrete_stretching import tangents
from spline_model.kernels.energy import strain_of_bending


@njit(cache=True, nogil=True)
def dissipation(z0, z1, velocity, h, motion):
    """Energy [J] that damping takes out of a step of length h with the mean velocity (Q,)."""
    lost = 0.0
    table = motion.bending_damping
    for p in range(table.first.size):
        b0, w0 = strain_of_bending(z0, table, p)
        b1, w1 = strain_of_bending(z1, table, p)
        lost += table.weight[p] * table.rigidity[p] * 0.5 * (w0 + w1) * (b1 - b0) ** 2 / h
    stretching = motion.stretching_damping
    for p in range(stretching.first.size):
        x0, y0, x1, y1 = tangents(z0, z1, stretching.first[p], stretching.width[p], stretching.d1[p])
        v0, v1, speed = math.hypot(x0, y0), math.hypot(x1, y1), stretching.speed[p]
        w = speed if stretching.measure[p] == 0 else 0.5 * (v0 + v1)
        change = (v1 - v0) / speed
        lost += stretching.weight[p] * stretching.rigidity[p] * w * change * change / h
    if motion.axial_relaxation.size > 0:
        axial, start = motion.tables.axial_force, velocity.size
        relaxed = np.zeros(motion.rigidity.shape[0])
        plain = np.zeros(motion.rigidity.shape[0])
        for p in range(axial.first.size):
            x0, y0, x1, y1 = tangents(z0, z1, axial.first[p], axial.width[p], axial.d1[p])
            change = axial.weight[p] * (math.hypot(x1, y1) - math.hypot(x0, y0))
            for k in range(axial.mode_width[p]):
                mode = axial.mode_first[p] - start + k
                plain[mode] += change * axial.modes[p, k]
                relaxed[mode] += motion.axial_relaxation[p] * change * axial.modes[p, k] / h
        lost += np.dot(plain, np.dot(motion.rigidity, relaxed))
    for i in range(motion.drag.shape[0]):
        for j in range(velocity.size):
            lost += h * velocity[i] * motion.drag[i, j] * velocity[j]
    return lost
