"""The stable step: implicit elastic forces, axial compliance in the constraint, positions stabilised.

With the rule's start values q~, v~ and spans s (of positions) and r (of velocities),

    M (v1 - v~) / r + dV/dq(q1) + D v1 - psi_q(q1)^T lambda + eps_q(q1)^T a - f = 0,
    q1 = q~ + s v1,    psi(q1) = 0,    eps(q1) + beta d(eps)/dt = C a.

Newton's iteration: the unconstrained update of strips and bodies one by one, then the
impulses that close the gaps of the constraints where the update leads, positions and all,
from the forces lambda and a of the step before. The axial forces are multipliers
of soft constraints, so that no stiffness EA stands in the update.
"""

from __future__ import annotations

from numba import njit

from spline_model.impulses.forces import fill
from spline_model.impulses.solve import apply_impulses, free_update, prepare, row_times
from spline_model.impulses.totals import SOLVES, SWEEPS

MOST_TURN = 0.5
"""Largest rotation of a body in one iteration [rad]."""


@njit(cache=True, nogil=True)
def solve_step(span, lag, time, active, motion, blocks, options, space, counters):
    """Solve the step in space.z (N,) and space.v (Q,) from the guess there; returns the residual.

    span s and lag r [s]; space.base and space.drift hold q~ and v~, space.drag D. The residual
    is in EI/L^2, EI/L, L and rad; far above the tolerance if the iterations were not enough.
    """
    z, v, x, matrix, gradient = space.z, space.v, space.x, space.matrix, space.gradient
    tolerance = options.tolerance
    before = norm = 1e300
    for _ in range(options.iterations):
        for i in range(v.size):
            z[i] = space.base[i] + span * v[i]
        fill(z, motion.tables, time, active, gradient, matrix)
        relax(v, span, blocks, v.size, gradient, matrix)
        add_inertia(v, span, lag, motion.mass, space)
        norm = largest_residual(gradient, motion.unit, motion.energy)
        if norm <= tolerance or (norm <= 1e3 * tolerance and norm > 0.5 * before) or not norm < 1e12:
            return norm
        before = norm
        prepare(blocks, matrix, space.schur)
        for i in range(v.size):
            x[i] = -gradient[i]
        free_update(blocks, matrix, x)
        for r in range(blocks.row.size):
            space.gap[r] = gradient[blocks.row[r]]
            space.mu[r] = 0.0
        done, _ = apply_impulses(blocks, matrix, space, x, options.sweeps, tolerance)
        counters[SOLVES] += 1
        counters[SWEEPS] += done
        share = 1.0
        for turn in motion.turns:
            if abs(x[turn]) * share > MOST_TURN:
                share = MOST_TURN / abs(x[turn])
        for i in range(v.size):
            v[i] += share * x[i] / span
        for r in range(blocks.row.size):
            z[blocks.row[r]] += share * space.mu[r]
    return norm


@njit(cache=True, nogil=True)
def relax(v, span, blocks, count, gradient, matrix):
    """Turn the compatibility of damped axial forces into eps + beta d(eps)/dt - C a, over 1 + beta / s.

    Divided so, it keeps its Jacobian (to the first order in the velocity), and the compliance is
    less: a soft constraint with a damper.
    """
    modes = blocks.relaxation.size
    for r in range(blocks.row.size):
        row = blocks.row[r]
        if row < count + modes and blocks.relaxation[row - count] > 0.0:
            beta = blocks.relaxation[row - count]
            less = 1.0 / (1.0 + beta / span)
            gradient[row] = less * (gradient[row] + beta * row_times(blocks, matrix, r, v))
            for k in range(count, count + modes):
                matrix[row, k] *= less


@njit(cache=True, nogil=True)
def add_inertia(v, span, lag, mass, space):
    """Add M (v - v~) / r + D v to the gradient and its derivative in q to the matrix."""
    count, over = v.size, 1.0 / (span * lag)
    for i in range(count):
        push = 0.0
        for j in range(count):
            push += mass[i, j] * (v[j] - space.drift[j]) / lag + space.drag[i, j] * v[j]
            space.matrix[i, j] += mass[i, j] * over + space.drag[i, j] / span
        space.gradient[i] += push


@njit(cache=True, nogil=True)
def largest_residual(gradient, unit, energy):
    """Largest entry, dimensionless; infinite if one is not a number."""
    norm = 0.0
    for i in range(gradient.size):
        value = abs(gradient[i]) * unit[i] / energy
        if not value < 1e300:
            return 1e300
        norm = max(norm, value)
    return norm
