"""The step as printed (Eqs 21 to 30, misprints corrected): explicit forces, impulses at velocity level.

    M (v~ - v0) / h = f - dV/dq(q0) - D v0              (21, 22)
    v1 = v~ + M^-1 psi_q(q0)^T P,    psi_q v1 + psi_t = 0   (24 to 30)
    q1 = q0 + h v1                                      (23)

Symplectic Euler: first order, stable while omega h < 2 for every frequency of the constrained
system. Nothing corrects positions, so that the constraints drift.
"""

from __future__ import annotations

from numba import njit

from spline_model.impulses.forces import axial_rates, fill, fill_drag
from spline_model.impulses.solve import apply_impulses, free_update, prepare
from spline_model.impulses.totals import SOLVES, STEPS, SWEEPS, damped, external_work
from spline_model.kernels.drives import factor_at
from spline_model.kernels.energy import axial_strains


@njit(cache=True, nogil=True, inline="always")
def printed_step(moving, time, h, active, motion, blocks, options, space):
    """Advance by h; returns the largest gap, dimensionless, that the last impulses found.

    ``moving.z`` is left with the axial forces of q0 and the constraint forces P / h.
    """
    z, v, matrix, x = moving.z, moving.v, space.matrix, space.x
    count = v.size
    explicit_axial_forces(z, v, motion, blocks, space)
    fill(z, motion.tables, time, active, space.gradient, matrix)
    fill_drag(z, motion, space.drag)
    for i in range(count):
        push = space.gradient[i]
        for j in range(count):
            push += space.drag[i, j] * v[j]
            matrix[i, j] = motion.mass[i, j]
        x[i] = -h * push
    prepare(blocks, matrix, space.schur)
    free_update(blocks, matrix, x)
    for i in range(count):
        x[i] += v[i]
    driven_rates(motion.tables.drives, blocks, active, time, h, space.gap)
    space.mu[:] = 0.0
    done, gap = apply_impulses(blocks, matrix, space, x, options.sweeps, options.tolerance / h)
    space.z[:] = z
    moving.totals[1] += damped(z, v, h, motion, blocks.relaxation, space)
    for i in range(count):
        v[i] = x[i]
        z[i] += h * v[i]
    for r in range(blocks.row.size):
        z[blocks.row[r]] = space.mu[r] / h
    moving.totals[0] += external_work(space.z, z, motion.tables, active, time)
    moving.counters[STEPS] += 1
    moving.counters[SOLVES] += 1
    moving.counters[SWEEPS] += done
    return gap * h


@njit(cache=True, nogil=True)
def explicit_axial_forces(z, v, motion, blocks, space):
    """Set the axial forces of extensible strips in z, a = C^-1 (eps + beta d(eps)/dt), and no others."""
    count, strains, table = v.size, space.strains, motion.tables.axial_force
    z[count:] = 0.0
    for damping in range(2 if motion.axial_relaxation.size > 0 else 1):
        if damping == 0:
            axial_strains(z, table, count, strains)
        else:
            axial_rates(z, v, table, count, strains)
        for k in range(strains.size):
            share = strains[k] if damping == 0 else blocks.relaxation[k] * strains[k]
            for j in range(strains.size):
                z[count + j] += motion.rigidity[j, k] * share


@njit(cache=True, nogil=True)
def driven_rates(drives, blocks, active, time, h, gap):
    """Fill gap (R,) with psi_t: the mean rate of the active drives over the step, else 0."""
    gap[:] = 0.0
    for d in range(drives.row.size):
        if active[d] == 1:
            first, pairs = drives.first[d], drives.pairs[d]
            before = factor_at(time, first, pairs, drives.times, drives.factors)
            after = factor_at(time + h, first, pairs, drives.times, drives.factors)
            gap[blocks.drive[d]] = (after - before) * drives.target[d] / h
