"""The linear part: the unconstrained update group by group, and impulses block by block.

In the saddle point system

    A dx + B^T dmu = -g,        B dx - S dmu = -c,

A is block diagonal in the strips and bodies. It is overwritten by its factors, and B^T by
A^-1 B^T; the impulses follow from (B A^-1 B^T + S) dmu = c - B A^-1 g, block after block
(Gauss-Seidel, Eqs 24 to 26), or all at once where there is one block (Eq 30).
"""

from __future__ import annotations

from spline_model.strip.compiled import called

TINY = 1e-300
"""In place of a pivot of zero: what follows is not finite, and the step is refused."""


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
    """B x of one row."""
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
    """Sweep over the blocks until no gap exceeds the tolerance; returns sweeps and the largest gap.

    ``space.gap`` (R,) is c; x (Q,) and ``space.mu`` (R,) are updated in place. A gap is seen just before its
    block closes it, dimensionless. One block needs one sweep.
    """
    rows, groups, matrix = problem.rows, problem.groups, space.matrix
    mu, change = space.mu, space.change
    count, largest = problem.first.size - 1, 0.0
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
            return sweep + 1, largest
    return problem.sweeps, largest
