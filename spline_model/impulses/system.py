"""The linear system of a step: what acts on strips and bodies, what a step adds up, and its solution.

In the saddle point system

    A dx + B^T dmu = -g,        B dx - S dmu = -c,

A is block diagonal in the strips and bodies: the unconstrained update goes group by group. A is overwritten
by its factors, and B^T by A^-1 B^T; the impulses follow from (B A^-1 B^T + S) dmu = c - B A^-1 g, block after
block (Gauss-Seidel, Eqs 24 to 26), or all at once where there is one block (Eq 30).
"""

from __future__ import annotations

import math

from spline_model.bordered import assemble, bend, derivatives, stretch
from spline_model.quadrature import (
    FIRST,
    MEASURE,
    MODE,
    MODES,
    RELAXATION,
    RIGIDITY,
    SPEED,
    STRAIN,
    STRETCHING,
    WEIGHT,
    WIDTH,
)
from spline_model.strip.compiled import called, kernel
from spline_model.strip.laws import MATERIAL

TINY = 1e-300
"""In place of a pivot of zero: what follows is not finite, and the step is refused."""


@called()
def fill(z, problem, space):
    """Fill the gradient (N,) and the matrix (N, N) of V - lambda psi - f q at z (N,).

    In the rows of the multipliers the gradient is - psi, and the Hessian - psi_q. Returns the least v / J0.
    """
    gradient, matrix = space.gradient, space.matrix
    _, _, slowest = assemble(z, problem.points, problem.clamps, gradient, matrix, space.work)
    for i in range(problem.force.size):
        gradient[i] -= problem.force[i]
    for d in range(problem.held_at.size):
        i, row = problem.held_at[d], problem.held_row[d]
        gradient[row] = problem.held_to[d] - z[i]
        gradient[i] -= z[row]
        matrix[row, i] = -1.0
        matrix[i, row] = -1.0
    return slowest


@called()
def axial_strains(z, v, rates, problem, strains):
    """Fill strains (M,) = int eps P_k ds0 of every axial mode at z, or with the rate of eps at velocity v."""
    points = problem.points
    for k in range(strains.size):
        strains[k] = 0.0
    for p in range(points.place.shape[0]):
        place, numbers = points.place[p], points.numbers[p]
        first, width, d1, d2 = place[FIRST], place[WIDTH], points.basis[0, p], points.basis[1, p]
        x, y, _, _ = derivatives(z, first, width, d1, d2)
        length = math.hypot(x, y)
        if rates:
            vx, vy, _, _ = derivatives(v, first, width, d1, d2)
            gap = (x * vx + y * vy) / length
        else:
            gap = length - (1.0 + numbers[STRAIN]) * numbers[SPEED]
        for k in range(place[MODES]):
            strains[place[MODE] - v.size + k] += numbers[WEIGHT] * points.modes[p, k] * gap


@kernel()
def strain_energy(z, v, problem, space):
    """Return the strain energy [J] at z (N,), the axial forces being those that the strains give."""
    points, strains, energy = problem.points, space.strains, 0.0
    for p in range(points.place.shape[0]):
        place, numbers = points.place[p], points.numbers[p]
        x1, y1, x2, y2 = derivatives(z, place[FIRST], place[WIDTH], points.basis[0, p], points.basis[1, p])
        s = x1 * x1 + y1 * y1
        length, phi = math.sqrt(s), (x1 * y2 - y1 * x2) / s
        bent = bend(phi, length, numbers, place[MEASURE])[0]
        stretched = stretch(length, 0.0, 0, numbers, place[MEASURE])[0]
        energy += numbers[WEIGHT] * (bent + stretched)
    axial_strains(z, v, False, problem, strains)
    for k in range(strains.size):
        for j in range(strains.size):
            energy += 0.5 * strains[k] * problem.rigidity[k, j] * strains[j]
    return energy


@called()
def kinetic(v, mass):
    """Return the kinetic energy [J] of velocities v (Q,)."""
    energy = 0.0
    for i in range(v.size):
        for j in range(v.size):
            energy += 0.5 * v[i] * mass[i, j] * v[j]
    return energy


@called()
def fallen(z, begun, problem):
    """Return the work [J] of weight and loads from the coordinates ``begun`` (Q,) to z (N,)."""
    work = 0.0
    for i in range(begun.size):
        work += problem.force[i] * (z[i] - begun[i])
    return work


@kernel()
def fill_drag(z, problem, space):
    """Fill the drag (Q, Q): the coordinates' own, and the strips' Kelvin-Voigt damping at z.

    int beta EI (db/dq)^T (db/dq) W du of bending, and so with the strain and EA of stretching by quadrature.
    """
    drag, points, g = space.drag, problem.points, space.work[0]
    for i in range(drag.shape[0]):
        for j in range(drag.shape[0]):
            drag[i, j] = problem.drag[i, j]
    for p in range(points.place.shape[0]):
        place, numbers = points.place[p], points.numbers[p]
        if numbers[RELAXATION] == 0.0:
            continue
        first, width, d1, d2 = place[FIRST], place[WIDTH], points.basis[0, p], points.basis[1, p]
        x1, y1, x2, y2 = derivatives(z, first, width, d1, d2)
        s, material = x1 * x1 + y1 * y1, place[MEASURE] == MATERIAL
        v = math.sqrt(s)
        w, turning = numbers[SPEED] if material else v, (2.0 if material else 3.0) * (x1 * y2 - y1 * x2) / s
        weight = numbers[WEIGHT] * numbers[RELAXATION] * w
        g[0], g[1] = (y2 - turning * x1) / (s * w), (-x2 - turning * y1) / (s * w)
        g[2], g[3] = -y1 / (s * w), x1 / (s * w)
        _add_square(drag, first, width, d1, d2, weight * numbers[RIGIDITY], g)
        if numbers[STRETCHING] > 0.0:
            g[0], g[1], g[2], g[3] = x1 / (v * numbers[SPEED]), y1 / (v * numbers[SPEED]), 0.0, 0.0
            _add_square(drag, first, width, d1, d2, weight * numbers[STRETCHING], g)


@called()
def _add_square(matrix, first, width, d1, d2, weight, g):
    """Add weight (dp/dq)^T g g^T (dp/dq), p = (x', y', x'', y'') and g (4,)."""
    for a in range(2 * width):
        mine = weight * (d1[a // 2] * g[a % 2] + d2[a // 2] * g[2 + a % 2])
        for b in range(2 * width):
            matrix[first + a, first + b] += mine * (d1[b // 2] * g[b % 2] + d2[b // 2] * g[2 + b % 2])


@called()
def damped(z, v, h, problem, space):
    """Return the energy [J] that damping takes in a step of length h with the velocity v and
    ``space.drag``."""
    lost, rates = 0.0, space.strains
    for i in range(v.size):
        for j in range(v.size):
            lost += h * v[i] * space.drag[i, j] * v[j]
    axial_strains(z, v, True, problem, rates)
    for k in range(rates.size):
        for j in range(rates.size):
            lost += h * problem.relaxation[k] * rates[k] * problem.rigidity[k, j] * rates[j]
    return lost


@called()
def _factorise(a, first, size):
    """L D L^T of a symmetric block in place, in the lower triangle.

    Pivots are taken in order: what they lose in digits, Newton's iteration gains again, and a
    step that does not converge is refused.
    """
    for j in range(first, first + size):
        pivot = a[j, j]
        for k in range(first, j):
            pivot -= a[j, k] * a[j, k] * a[k, k]
        if pivot == 0.0:
            pivot = TINY
        a[j, j] = pivot
        for i in range(j + 1, first + size):
            value = a[i, j]
            for k in range(first, j):
                value -= a[i, k] * a[j, k] * a[k, k]
            a[i, j] = value / pivot


@called()
def _solve(a, first, size, x, offset):
    """Solve with the factors of a block for x[offset : offset + size], in place."""
    shift = offset - first
    for i in range(first, first + size):
        for k in range(first, i):
            x[i + shift] -= a[i, k] * x[k + shift]
    for i in range(first, first + size):
        x[i + shift] /= a[i, i]
    for i in range(first + size - 1, first - 1, -1):
        for k in range(i + 1, first + size):
            x[i + shift] -= a[k, i] * x[k + shift]


@called()
def prepare(problem, matrix, schur):
    """Factorise the groups, overwrite B^T by A^-1 B^T and factorise the blocks' B A^-1 B^T + S.

    matrix (N, N) holds A, B^T in the columns and B and -S in the rows of the multipliers;
    schur (R, R) is filled block by block.
    """
    groups, rows = problem.groups, problem.rows
    for g in range(groups.shape[0]):
        _factorise(matrix, groups[g, 0], groups[g, 1])
    for r in range(rows.shape[0]):
        for k in range(1, 3):
            g = rows[r, k]
            if g >= 0:
                _solve(matrix, groups[g, 0], groups[g, 1], matrix[:, rows[r, 0]], groups[g, 0])
    for b in range(problem.first.size - 1):
        begin, end = problem.first[b], problem.first[b + 1]
        for r in range(begin, end):
            for s in range(begin, r + 1):
                value = -matrix[rows[r, 0], rows[s, 0]]
                for k in range(1, 3):
                    g = rows[r, k]
                    if g >= 0 and (g == rows[s, 1] or g == rows[s, 2]):
                        for i in range(groups[g, 0], groups[g, 0] + groups[g, 1]):
                            value += matrix[rows[r, 0], i] * matrix[i, rows[s, 0]]
                schur[r, s] = value
        _factorise(schur, begin, end - begin)


@called()
def free_update(problem, matrix, x):
    """Overwrite x (Q,) by A^-1 x: every group by itself, as if there were no constraint (Eq 21)."""
    for g in range(problem.groups.shape[0]):
        start, size = problem.groups[g, 0], problem.groups[g, 1]
        _solve(matrix, start, size, x, start)


@called()
def row_times(problem, matrix, r, x):
    """Return B x of one row."""
    value = 0.0
    for k in range(1, 3):
        g = problem.rows[r, k]
        if g >= 0:
            start = problem.groups[g, 0]
            for i in range(start, start + problem.groups[g, 1]):
                value += matrix[problem.rows[r, 0], i] * x[i]
    return value


@called()
def apply_impulses(problem, space, x, tolerance):
    """Sweep over the blocks until no gap exceeds the tolerance; returns the number of sweeps.

    ``space.gap`` (R,) is c; x (Q,) and ``space.mu`` (R,) are updated in place. A gap is seen just before its
    block closes it, dimensionless. One block needs one sweep.
    """
    rows, groups, matrix = problem.rows, problem.groups, space.matrix
    mu, change = space.mu, space.change
    count = problem.first.size - 1
    for sweep in range(problem.sweeps):
        largest = 0.0
        for b in range(count):
            begin, end = problem.first[b], problem.first[b + 1]
            for r in range(begin, end):
                value = space.gap[r] + row_times(problem, matrix, r, x)
                for s in range(begin, end):
                    value += matrix[rows[r, 0], rows[s, 0]] * mu[s]
                change[r] = value
                largest = max(largest, abs(value) * problem.unit[rows[r, 0]])
            _solve(space.schur, begin, end - begin, change, begin)
            for r in range(begin, end):
                mu[r] += change[r]
                for k in range(1, 3):
                    g = rows[r, k]
                    if g >= 0:
                        for i in range(groups[g, 0], groups[g, 0] + groups[g, 1]):
                            x[i] -= matrix[i, rows[r, 0]] * change[r]
        if count == 1 or largest <= tolerance:
            return sweep + 1
    return problem.sweeps
