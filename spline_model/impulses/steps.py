"""The two steps of the solver: as printed, and one that is stable at any length.

As printed (Eqs 21 to 30, misprints corrected), explicit forces and impulses at velocity level:

    M (v~ - v0) / h = f - dV/dq(q0) - D v0              (21, 22)
    v1 = v~ + M^-1 psi_q(q0)^T P,    psi_q v1 = 0   (24 to 30)
    q1 = q0 + h v1                                      (23)

Symplectic Euler: first order, stable while omega h < 2 for every frequency of the constrained
system. Nothing corrects positions, so that the constraints drift.

Stable: implicit elastic forces, axial compliance in the constraint, positions stabilised.
With the rule's start values q~, v~ and spans s (of positions) and r (of velocities),

    M (v1 - v~) / r + dV/dq(q1) + D v1 - psi_q(q1)^T lambda + eps_q(q1)^T a - f = 0,
    q1 = q~ + s v1,    psi(q1) = 0,    eps(q1) + beta d(eps)/dt = C a.

Newton's iteration: the unconstrained update of strips and bodies one by one, then the
impulses that close the gaps of the constraints where the update leads, positions and all,
from the forces lambda and a of the step before. The axial forces are multipliers
of soft constraints, so that no stiffness EA stands in the update.
"""

from __future__ import annotations

from spline_model.impulses.arrays import COUNTS, ENERGY, HALVED, LIMITED, LOST, SOLVES, STEPS, SWEEPS
from spline_model.impulses.system import (
    apply_impulses,
    axial_strains,
    damped,
    fallen,
    fill,
    fill_drag,
    free_update,
    kinetic,
    prepare,
    row_times,
    strain_energy,
)
from spline_model.strip.compiled import copy, once

MOST_ENERGY = 100.0
"""A run whose kinetic energy exceeds this times the energy at its start is unstable; below the limit
symplectic Euler lets the energy swing by a factor 1 / (1 - omega h / 2)."""
FROM_REST = 1e-6
"""Energy in EI/L that a run may reach from rest."""
ITERATIONS = 12
"""Most Newton iterations of a stable step before it is halved."""
EULER, START, BACKWARD = range(3)
"""Rules of a step: implicit Euler (q1 = q0 + h v1); the start (q1 = q0 + h (v0 + v1) / 2), which
loses less; backward differences of second order from the two states before."""
MOST_TURN = 0.5
"""Largest rotation of a body in one iteration [rad]."""
MOST_REACH = 0.3
"""Largest rotation that the first guess of a step takes from the velocity [rad]."""
SLACK = 1e-14
"""Gain of energy in EI/L that is round-off."""
SLOWEST = 0.1
"""Least |C'| over its value at rest: with less the curve is folded."""
LEAST_PART = 2.0**-6
"""Least part of a step before it is refused: bounds the time that a step may take."""


@once()
def printed_advance(moving, h, problem, space):
    """Advance by one step; False, with the state as it was, if it is unstable.

    ``moving.z`` is left with the axial forces of q0 and the constraint forces P / h.
    """
    z, v, x, status = moving.z, moving.v, space.x, moving.status
    most = status[ENERGY] + abs(fallen(z, moving.begun, problem)) + FROM_REST * problem.energy
    copy(v, moving.earlier[1])
    for i in range(v.size):
        moving.earlier[0, i] = z[i]
    _explicit_axial_forces(z, v, problem, space)
    fill(z, problem, space)
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
    moving.counters[SWEEPS] += apply_impulses(problem, space, x, problem.tolerance / h)
    status[LOST] += damped(z, v, h, problem, space)
    for i in range(v.size):
        v[i] = x[i]
        z[i] += h * v[i]
    for r in range(space.mu.size):
        z[problem.rows[r, 0]] = space.mu[r] / h
    moving.counters[STEPS] += 1
    moving.counters[SOLVES] += 1
    if not kinetic(v, problem.mass) <= MOST_ENERGY * most:
        for i in range(z.size):
            z[i] = moving.earlier[0, i] if i < v.size else 0.0
        copy(moving.earlier[1], v)
        return False
    return True


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


@once()
def stable_advance(moving, duration, problem, space):
    """Advance by one step, or by halves of implicit Euler where that fails; False if none is solved."""
    status, done, step = moving.status, 0.0, duration
    while duration - done > 1e-9 * duration:
        step = min(step, duration - done)
        rule = EULER
        if step == duration:
            rule = BACKWARD if status[COUNTS] == 1.0 else START
        if _try_step(moving, step, rule, problem, space):
            done += step
            step *= 2.0
            continue
        moving.counters[HALVED] += 1
        status[COUNTS] = 0.0
        step *= 0.5
        if step < LEAST_PART * duration:
            return False
    status[COUNTS] = 1.0 if step == 2.0 * duration else 0.0
    return True


@once()
def _try_step(moving, h, rule, problem, space):
    """Take one step by a rule; False, with the state as it was, if it is not solved or gains energy."""
    z, v, status = moving.z, moving.v, moving.status
    span, lag = predict(moving, h, rule, problem.turns, space)
    fill_drag(z, problem, space)
    residual, slowest = _solve_step(span, lag, problem, space, moving.counters)
    if not residual <= 1e3 * problem.tolerance or not slowest > SLOWEST:
        return False
    moves, stored = kinetic(space.v, problem.mass), strain_energy(space.z, v, problem, space)
    stored -= fallen(space.z, moving.begun, problem)
    gains = moves + stored > status[ENERGY] + SLACK * problem.energy
    if problem.grounded == 1 and gains:
        # velocities scaled by one factor fulfil constraints at rest as they did before
        if stored > status[ENERGY]:
            return False
        share = ((status[ENERGY] - stored) / moves) ** 0.5
        for i in range(v.size):
            space.v[i] *= share
        moving.counters[LIMITED] += 1
        moves = status[ENERGY] - stored
    status[ENERGY] = moves + stored
    status[LOST] += damped(space.z, space.v, h, problem, space)
    for i in range(v.size):
        moving.earlier[0, i], moving.earlier[1, i] = z[i], v[i]
    copy(space.v, v)
    copy(space.z, z)
    status[COUNTS] = 1.0
    moving.counters[STEPS] += 1
    return True


@once()
def predict(moving, h, rule, turns, space):
    """Fill the rule's start values and the first guess in ``space``; returns the spans s and r [s]."""
    z, v, count = moving.z, moving.v, moving.v.size
    span = lag = h
    for i in range(count):
        space.base[i], space.drift[i] = z[i], v[i]
        if rule == START:
            space.base[i] += 0.5 * h * v[i]
        elif rule == BACKWARD:
            space.base[i] = (4.0 * z[i] - moving.earlier[0, i]) / 3.0
            space.drift[i] = (4.0 * v[i] - moving.earlier[1, i]) / 3.0
    if rule == START:
        span = 0.5 * h
    elif rule == BACKWARD:
        span = lag = 2.0 * h / 3.0
    reach = h
    for k in range(turns.size):
        if abs(v[turns[k]]) * reach > MOST_REACH:
            reach = MOST_REACH / abs(v[turns[k]])
    copy(z, space.z)
    for i in range(count):
        space.v[i] = (z[i] + reach * v[i] - space.base[i]) / span
    return span, lag


@once()
def _solve_step(span, lag, problem, space, counters):
    """Solve the step in space.z (N,) and space.v (Q,) from the guess there: residual and least v / J0.

    span s and lag r [s]; space.base and space.drift hold q~ and v~, space.drag D. The residual
    is in EI/L^2, EI/L, L and rad; far above the tolerance if the iterations were not enough.
    """
    z, v, x, matrix, gradient = space.z, space.v, space.x, space.matrix, space.gradient
    tolerance, rows, turns = problem.tolerance, problem.rows, problem.turns
    before = norm = 1e300
    slowest = 0.0
    for _ in range(ITERATIONS):
        for i in range(v.size):
            z[i] = space.base[i] + span * v[i]
        slowest = fill(z, problem, space)
        _relax(v, span, problem, gradient, matrix)
        _add_inertia(v, span, lag, problem.mass, space)
        norm = 0.0
        for i in range(gradient.size):
            value = abs(gradient[i]) * problem.unit[i]
            norm = max(norm, value) if value < 1e300 else 1e300
        if norm <= tolerance or (norm <= 1e3 * tolerance and norm > 0.5 * before) or not norm < 1e12:
            break
        before = norm
        prepare(problem, matrix, space.schur)
        for i in range(v.size):
            x[i] = -gradient[i]
        free_update(problem, matrix, x)
        for r in range(rows.shape[0]):
            space.gap[r] = gradient[rows[r, 0]]
            space.mu[r] = 0.0
        counters[SWEEPS] += apply_impulses(problem, space, x, tolerance)
        counters[SOLVES] += 1
        share = 1.0
        for k in range(turns.size):
            if abs(x[turns[k]]) * share > MOST_TURN:
                share = MOST_TURN / abs(x[turns[k]])
        for i in range(v.size):
            v[i] += share * x[i] / span
        for r in range(rows.shape[0]):
            z[rows[r, 0]] += share * space.mu[r]
    return norm, slowest


@once()
def _relax(v, span, problem, gradient, matrix):
    """Turn the compatibility of damped axial forces into eps + beta d(eps)/dt - C a, over 1 + beta / s.

    Divided so, it keeps its Jacobian (to the first order in the velocity), and the compliance is
    less: a soft constraint with a damper.
    """
    count, modes = v.size, problem.relaxation.size
    for r in range(problem.rows.shape[0]):
        row = problem.rows[r, 0]
        if row < count + modes and problem.relaxation[row - count] > 0.0:
            beta = problem.relaxation[row - count]
            less = 1.0 / (1.0 + beta / span)
            gradient[row] = less * (gradient[row] + beta * row_times(problem, matrix, r, v))
            for k in range(count, count + modes):
                matrix[row, k] *= less


@once()
def _add_inertia(v, span, lag, mass, space):
    """Add M (v - v~) / r + D v to the gradient and its derivative in q to the matrix."""
    count, over = v.size, 1.0 / (span * lag)
    for i in range(count):
        push = 0.0
        for j in range(count):
            push += mass[i, j] * (v[j] - space.drift[j]) / lag + space.drag[i, j] * v[j]
            space.matrix[i, j] += mass[i, j] * over + space.drag[i, j] / span
        space.gradient[i] += push
