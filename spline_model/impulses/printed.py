"""The step as printed (Eqs 21 to 30, misprints corrected): explicit forces, impulses at velocity level.

    M (v~ - v0) / h = f - dV/dq(q0) - D v0              (21, 22)
    v1 = v~ + M^-1 psi_q(q0)^T P,    psi_q v1 + psi_t = 0   (24 to 30)
    q1 = q0 + h v1                                      (23)

Symplectic Euler: first order, stable while omega h < 2 for every frequency of the constrained
system. Nothing corrects positions, so that the constraints drift.
"""

from __future__ import annotations

from spline_model.impulses.arrays import ACTIVE, DRIVE, ENERGY, RESIDUAL, SIZE, SOLVES, STEPS, SWEEPS
from spline_model.impulses.forces import (
    axial_strains,
    damped,
    external_work,
    factor,
    fill,
    fill_drag,
    kinetic,
)
from spline_model.impulses.linear import apply_impulses, free_update, prepare
from spline_model.strip.compiled import copy, once

MOST_ENERGY = 100.0
"""A run whose kinetic energy exceeds this times the energy at its start is unstable; below the limit
symplectic Euler lets the energy swing by a factor 1 / (1 - omega h / 2)."""
FROM_REST = 1e-6
"""Energy in EI/L that a run may reach from rest."""


@once()
def printed_advance(moving, time, h, problem, space):
    """Advance by one step; False, with the state as it was, if it is unstable."""
    z, v, status = moving.z, moving.v, moving.status
    work = abs(moving.totals[0])
    copy(v, moving.earlier[1])
    for i in range(v.size):
        moving.earlier[0, i] = z[i]
    gap = _printed_step(moving, time, h, problem, space)
    if not kinetic(v, problem.mass) <= MOST_ENERGY * (status[ENERGY] + work + FROM_REST * problem.energy):
        for i in range(z.size):
            z[i] = moving.earlier[0, i] if i < v.size else 0.0
        copy(moving.earlier[1], v)
        return False
    status[RESIDUAL] = max(status[RESIDUAL], gap)
    return True


@once()
def _printed_step(moving, time, h, problem, space):
    """Advance by h; returns the largest gap, dimensionless, that the last impulses found.

    ``moving.z`` is left with the axial forces of q0 and the constraint forces P / h.
    """
    z, v, x = moving.z, moving.v, space.x
    _explicit_axial_forces(z, v, problem, space)
    fill(z, problem, time, space)
    fill_drag(z, problem, space)
    for i in range(v.size):
        push = space.gradient[i]
        for j in range(v.size):
            push += space.drag[i, j] * v[j]
            space.matrix[i, j] = problem.mass[i, j]
        x[i] = -h * push
    prepare(problem, space.matrix, space.schur)
    free_update(problem, space.matrix, x)
    for i in range(v.size):
        x[i] += v[i]
    for r in range(space.mu.size):
        space.gap[r] = space.mu[r] = 0.0
    for a in range(problem.acting.shape[0]):  # psi_t: the mean rate of the active drives over the step
        acting = problem.acting[a]
        if acting[DRIVE] >= 0 and acting[ACTIVE] == 1:
            change = factor(a, time + h, problem) - factor(a, time, problem)
            space.gap[acting[DRIVE]] = change * problem.sizes[a, SIZE] / h
    done, gap = apply_impulses(problem, space, x, problem.tolerance / h)
    copy(z, space.z)
    moving.totals[1] += damped(z, v, h, problem, space)
    for i in range(v.size):
        v[i] = x[i]
        z[i] += h * v[i]
    for r in range(space.mu.size):
        z[problem.rows[r, 0]] = space.mu[r] / h
    moving.totals[0] += external_work(space.z, z, problem, time)
    moving.counters[STEPS] += 1
    moving.counters[SOLVES] += 1
    moving.counters[SWEEPS] += done
    return gap * h


@once()
def _explicit_axial_forces(z, v, problem, space):
    """Set the axial forces of extensible strips in z, a = C^-1 (eps + beta d(eps)/dt), and no others."""
    strains = space.strains
    for i in range(v.size, z.size):
        z[i] = 0.0
    for rates in (False, True):
        axial_strains(z, v, rates, problem, strains)
        for k in range(strains.size):
            share = problem.relaxation[k] * strains[k] if rates else strains[k]
            for j in range(strains.size):
                z[v.size + j] += problem.rigidity[j, k] * share
