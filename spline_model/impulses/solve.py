"""The linear part: the unconstrained update group by group, and impulses block by block.

In the saddle point system

    A dx + B^T dmu = -g,        B dx - S dmu = -c,

A is block diagonal in the strips and bodies. It is overwritten by its factors, and B^T by
A^-1 B^T; the impulses follow from (B A^-1 B^T + S) dmu = c - B A^-1 g, block after block
(Gauss-Seidel, Eqs 24 to 26), or all at once where there is one block (Eq 30).
"""

from __future__ import annotations

from numba import njit

TINY = 1e-300
"""In place of a pivot of zero: what follows is not finite, and the step is refused."""


@njit(cache=True, nogil=True)
def factorise(a, first, size):
    """L D L^T of a symmetric block in place, in the lower triangle; returns the number of negative pivots.

    Pivots are taken in order: what they lose in digits, Newton's iteration gains again, and a
    step that does not converge is refused.
    """
    negative = 0
    for j in range(first, first + size):
        pivot = a[j, j]
        for k in range(first, j):
            pivot -= a[j, k] * a[j, k] * a[k, k]
        if pivot == 0.0:
            pivot = TINY
        negative += pivot < 0.0
        a[j, j] = pivot
        for i in range(j + 1, first + size):
            value = a[i, j]
            for k in range(first, j):
                value -= a[i, k] * a[j, k] * a[k, k]
            a[i, j] = value / pivot
    return negative


@njit(cache=True, nogil=True)
def solve_vector(a, first, size, x, offset):
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


@njit(cache=True, nogil=True)
def solve_column(a, first, size, column):
    """Solve with the factors of a block for its part of a column of the same matrix, in place."""
    for i in range(first, first + size):
        for k in range(first, i):
            a[i, column] -= a[i, k] * a[k, column]
    for i in range(first, first + size):
        a[i, column] /= a[i, i]
    for i in range(first + size - 1, first - 1, -1):
        for k in range(i + 1, first + size):
            a[i, column] -= a[k, i] * a[k, column]


@njit(cache=True, nogil=True)
def prepare(blocks, matrix, schur):
    """Factorise the groups, overwrite B^T by A^-1 B^T and factorise the blocks' B A^-1 B^T + S.

    matrix (N, N) holds A, B^T in the columns and B and -S in the rows of the multipliers;
    schur (R, R) is filled block by block. Returns the number of negative pivots of A.
    """
    start, size, row, groups = blocks.start, blocks.size, blocks.row, blocks.groups
    negative = 0
    for g in range(start.size):
        negative += factorise(matrix, start[g], size[g])
    for r in range(row.size):
        for k in range(2):
            g = groups[r, k]
            if g >= 0:
                solve_column(matrix, start[g], size[g], row[r])
    for b in range(blocks.first.size - 1):
        begin, end = blocks.first[b], blocks.first[b + 1]
        for r in range(begin, end):
            for s in range(begin, r + 1):
                value = -matrix[row[r], row[s]]
                for k in range(2):
                    g = groups[r, k]
                    if g >= 0 and (g == groups[s, 0] or g == groups[s, 1]):
                        for i in range(start[g], start[g] + size[g]):
                            value += matrix[row[r], i] * matrix[i, row[s]]
                schur[r, s] = value
        factorise(schur, begin, end - begin)
    return negative


@njit(cache=True, nogil=True)
def free_update(blocks, matrix, x):
    """Overwrite x (Q,) by A^-1 x: every group by itself, as if there were no constraint (Eq 21)."""
    for g in range(blocks.start.size):
        solve_vector(matrix, blocks.start[g], blocks.size[g], x, blocks.start[g])


@njit(cache=True, nogil=True)
def row_times(blocks, matrix, r, x):
    """B x of one row."""
    value = 0.0
    for k in range(2):
        g = blocks.groups[r, k]
        if g >= 0:
            for i in range(blocks.start[g], blocks.start[g] + blocks.size[g]):
                value += matrix[blocks.row[r], i] * x[i]
    return value


@njit(cache=True, nogil=True)
def apply_impulses(blocks, matrix, space, x, sweeps, tolerance):
    """Sweep over the blocks until no gap exceeds the tolerance; returns sweeps and the largest gap.

    ``space.gap`` (R,) is c; x (Q,) and ``space.mu`` (R,) are updated in place. A gap is seen just before its
    block closes it, times ``space.unit``. One block needs one sweep.
    """
    start, size, row, groups = blocks.start, blocks.size, blocks.row, blocks.groups
    mu, change = space.mu, space.change
    count, largest = blocks.first.size - 1, 0.0
    for sweep in range(sweeps):
        largest = 0.0
        for b in range(count):
            begin, end = blocks.first[b], blocks.first[b + 1]
            for r in range(begin, end):
                value = space.gap[r] + row_times(blocks, matrix, r, x)
                for s in range(begin, end):
                    value += matrix[row[r], row[s]] * mu[s]
                change[r] = value
                largest = max(largest, abs(value) * space.unit[r])
            solve_vector(space.schur, begin, end - begin, change, begin)
            for r in range(begin, end):
                mu[r] += change[r]
                for k in range(2):
                    g = groups[r, k]
                    if g >= 0:
                        for i in range(start[g], start[g] + size[g]):
                            x[i] -= matrix[i, row[r]] * change[r]
        if count == 1 or largest <= tolerance:
            return sweep + 1, largest
    return sweeps, largest
