"""What a step adds up: counters, work and dissipation."""

from __future__ import annotations

from numba import njit

from spline_model.impulses.forces import axial_rates
from spline_model.kernels.drives import factor_at

STEPS, SOLVES, SWEEPS, HALVED, LIMITED = range(5)
"""Places of the counters: steps, linear systems, sweeps over the blocks, steps that were halved, and
steps whose velocity was reduced so that no energy is gained."""


@njit(cache=True, nogil=True)
def external_work(z0, z1, tables, active, time):
    """Work [J] from z0 to z1 of the loads at ``time`` and of the drives' multipliers in z1."""
    work = 0.0
    loads, drives = tables.loads, tables.drives
    for f in range(loads.coordinate.size):
        i = loads.coordinate[f]
        factor = factor_at(time, loads.first[f], loads.pairs[f], loads.times, loads.factors)
        work += factor * loads.value[f] * (z1[i] - z0[i])
    for d in range(drives.coordinate.size):
        if active[d] == 1:
            i = drives.coordinate[d]
            work += z1[drives.row[d]] * (z1[i] - z0[i])
    return work


@njit(cache=True, nogil=True)
def damped(z, v, h, motion, relaxation, space):
    """Energy [J] that damping takes in a step of length h with the velocity v and ``space.drag``."""
    lost = 0.0
    for i in range(v.size):
        for j in range(v.size):
            lost += h * v[i] * space.drag[i, j] * v[j]
    if motion.axial_relaxation.size > 0:
        rates = space.strains
        axial_rates(z, v, motion.tables.axial_force, v.size, rates)
        for k in range(rates.size):
            for j in range(rates.size):
                lost += h * relaxation[k] * rates[k] * motion.rigidity[k, j] * rates[j]
    return lost
