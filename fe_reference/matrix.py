"""Symmetric matrices in the reduced coordinates: a pattern that is kept, and its factors in the same order.

scikit-fem assembles the pattern once; afterwards entries of elements go to their places in it, compiled.
The factors are K = L D L^T within the envelope of the rows, without pivoting: the coordinates are those of
the nodes along the strips, then those of the bodies, which leaves a band and a border, and no fill. By
Sylvester's law of inertia D has as many negative entries as K has negative eigenvalues. Rows of held
coordinates are excluded from the elimination.

Products of two vectors, which are not symmetric, are added to a matrix by their low rank, and to its inverse.

Source: A. George, J. W. H. Liu, Computer Solution of Large Sparse Positive Definite Systems (1981), ch. 4.
"""

from dataclasses import dataclass, field, replace

import numpy as np
from scipy.sparse import csc_matrix
from skfem.assembly.form.coo_data import COOData

from .arrays import Array, Flags, Indices, kernel
from .places import Carried

#: Where the entries of the rows of a matrix are, and where its factors have theirs.
Lines = tuple[Indices, Indices, Indices, Indices]

#: Part of a diagonal entry below which what elimination leaves of it is round-off, its sign of no meaning.
GRAIN = 2.0**-48


class Singular(ArithmeticError):
    """A matrix that has no inverse."""


@kernel()
def assemble(matrices: Array, ends: Indices, carried: Carried, places: Indices, data: Array) -> None:
    """Add matrices (E, 8, 8) [N/m, N, N m] between pairs of rows to the entries `data` of a matrix.

    The contributions of body rotations at carried rows are added to the last two rows and columns, which are
    zero.

    Args:
        ends (E, 2): which of the carried rows the ends are, or -1. places (E, 8, 8): of the entries in data,
            or -1.
    """
    arms = carried[4]
    for e in range(len(matrices)):
        matrix, many = matrices[e], 6
        for end in range(2):
            k, row, own = ends[e, end], 3 * end, 6 + end
            if k >= 0:
                many = 8
                x, y = arms[k]
                for j in range(8):
                    matrix[own, j] = x * matrix[row + 1, j] - y * matrix[row, j]
                for j in range(8):
                    matrix[j, own] = x * matrix[j, row + 1] - y * matrix[j, row]
        for i in range(many):
            for j in range(many):
                if places[e, i, j] >= 0:
                    data[places[e, i, j]] += matrix[i, j]


@kernel()
def _times(starts: Indices, rows: Indices, data: Array, x: Array, out: Array) -> None:
    """Write the product of the symmetric matrix and the rows of x (R, size)."""
    for r in range(len(x)):
        for i in range(len(starts) - 1):
            total = 0.0
            for p in range(starts[i], starts[i + 1]):
                total += data[p] * x[r, rows[p]]
            out[r, i] = total


@kernel()
def _factorise(lines: Lines, data: Array, held: Flags, grain: float, low: Array, d: Array) -> int:
    """Write L within the envelope and D; return the number of negative entries of D, -1 if one is round-off.

    Row i of L begins in column first[i], at low[begin[i]]. Round-off is up to `grain` of a diagonal entry.
    """
    starts, rows, begin, first = lines
    negative = 0
    for i in range(len(d)):
        at = begin[i] - first[i]
        for p in range(begin[i], begin[i] + i - first[i]):
            low[p] = 0.0
        d[i] = 1.0
        if held[i]:
            continue
        pivot = size = 0.0
        for p in range(starts[i], starts[i + 1]):
            j = rows[p]
            if j == i:
                pivot, size = data[p], abs(data[p])
            elif j < i and not held[j]:
                low[at + j] = data[p]
        for j in range(first[i], i):
            total, there = low[at + j], begin[j] - first[j]
            for k in range(max(first[i], first[j]), j):
                total -= low[at + k] * low[there + k]
            low[at + j] = total
        for j in range(first[i], i):
            entry = low[at + j] / d[j]
            pivot -= entry * low[at + j]
            low[at + j] = entry
        if abs(pivot) <= grain * size or not np.isfinite(pivot):
            return -1
        d[i] = pivot
        negative += pivot < 0.0
    return negative


@kernel()
def _solve(begin: Indices, first: Indices, low: Array, d: Array, x: Array) -> None:
    """Solve for the rows of x (R, size) in place."""
    for r in range(len(x)):
        for i in range(len(d)):
            at = begin[i] - first[i]
            for j in range(first[i], i):
                x[r, i] -= low[at + j] * x[r, j]
        for i in range(len(d)):
            x[r, i] /= d[i]
        for i in range(len(d) - 1, -1, -1):
            at = begin[i] - first[i]
            for j in range(first[i], i):
                x[r, j] -= low[at + j] * x[r, i]


class Envelope:
    """Where the entries of symmetric matrices of element blocks lie.

    Attributes:
        size: of the matrices.
        places (E, 8, 8), diagonal (size,): of the entries, -1 for none.
    """

    def __init__(self, numbers: Indices, size: int) -> None:
        """Take the coordinates of the blocks (E, 8), -1 for none."""
        every = np.arange(size)
        i, j = np.broadcast_arrays(numbers[:, :, None], numbers[:, None, :])
        indices = np.hstack([np.reshape((i, j), (2, -1)), (every, every)])
        indices = indices[:, (indices >= 0).all(axis=0)].astype(np.int32)
        summed = COOData(indices, np.ones(indices.shape[1]), (size, size), None).tocsr()
        summed.sort_indices()
        self.size, self.starts, self.rows = size, summed.indptr, summed.indices
        keys = np.repeat(every, np.diff(self.starts)) * size + self.rows
        self.places = np.where((i >= 0) & (j >= 0), np.searchsorted(keys, i * size + j), -1)
        self.diagonal = np.searchsorted(keys, every * (size + 1))
        self.first = np.minimum(self.rows[self.starts[:-1]], every).astype(np.int64) if size else every
        self.begin = np.concatenate([[0], np.cumsum(every - self.first)])[:-1]

    def zero(self) -> "Symmetric":
        """Return a matrix of zeros."""
        return Symmetric(self, np.zeros(len(self.rows)))


@dataclass(eq=False)
class Symmetric:
    """A symmetric matrix (size, size) on a pattern, in the units of its use: stiffness, damping or mass.

    Under loads that follow there are products left (x) right of vectors added, which are not symmetric.

    Attributes:
        pattern: where its entries lie.
        data: entries in the order of the pattern (entries,).
        left, right: vectors of the added products (R, size).
    """

    pattern: Envelope
    data: Array
    left: Array = field(default_factory=lambda: np.zeros((0, 0)))
    right: Array = field(default_factory=lambda: np.zeros((0, 0)))

    def sparse(self) -> csc_matrix:
        """Return what of it is symmetric as a sparse matrix."""
        p = self.pattern
        return csc_matrix((self.data, p.rows, p.starts), (p.size, p.size))

    def times(self, x: Array) -> Array:
        """Return the product with vectors (..., size), in the units of matrix times vector."""
        p, out = self.pattern, np.empty(np.shape(x))
        _times(p.starts, p.rows, self.data, np.atleast_2d(x), out.reshape(-1, p.size))
        return out + (x @ self.right.T) @ self.left if len(self.left) else out

    def apart(self, one: Array, other: Array) -> float:
        """Return one.K other less that of the symmetric part, of two vectors (size,): a number."""
        return float((self.left @ one) @ (self.right @ other)) if len(self.left) else 0.0

    def factors(self, held: Flags, grain: float = 0.0) -> "Factors":
        """Return the factors of its rows and columns that are not held.

        Args:
            held: which coordinates are held (size,).
            grain: part of its diagonal entry up to which a pivot is taken for zero [1]; 0 on a path, where a
                stiffness that vanishes at a critical point passes through round-off.

        Raises:
            Singular: a pivot is zero to round-off.
        """
        p = self.pattern
        low, d = np.empty(int(np.sum(np.arange(p.size) - p.first))), np.empty(p.size)
        negative = _factorise((p.starts, p.rows, p.begin, p.first), self.data, held, grain, low, d)
        if negative < 0:
            raise Singular("the tangent is singular to round-off")
        symmetric = Factors(p, held, low, d, negative)
        return symmetric.bordered(self.left, self.right) if len(self.left) else symmetric


@dataclass(eq=False)
class Factors:
    """Factors L D L^T of a matrix without the held rows.

    Attributes:
        pattern, held: where the entries of the matrix lie, and which coordinates are held (size,).
        low, d: entries of L below the diagonal, row by row (entries,), and of D (size,).
        negative: number of negative eigenvalues.
        border: of products left (x) right of vectors (R, size) that are added: right, the solutions for left
            (R, size) and the inverse of 1 + right.solutions (R, R).
    """

    pattern: Envelope
    held: Flags
    low: Array
    d: Array
    negative: int
    border: tuple[Array, Array, Array] | None = None

    def solve(self, b: Array) -> Array:
        """Return the solution (..., size) for right sides (..., size), zero at what is held [1/stiffness]."""
        x = np.where(self.held, 0.0, b)
        _solve(self.pattern.begin, self.pattern.first, self.low, self.d, x.reshape(-1, self.pattern.size))
        if self.border is None:
            return x
        right, solved, core = self.border
        return np.asarray(x - (x @ right.T) @ core.T @ solved)

    def bordered(self, left: Array, right: Array) -> "Factors":
        """Return the factors of the matrix with products of vectors (R, size) added.

        The inverse is that of M. A. Woodbury. The determinant is that of this matrix times one of size R;
        `negative` is 1 where it is below zero, for there is no inertia to count.

        Raises:
            Singular: the matrix with the products is singular to round-off.
        """
        solved = self.solve(left)
        core = np.eye(len(left)) + right @ solved.T
        sign, size = np.linalg.slogdet(core)
        if not np.isfinite(size):
            raise Singular("the tangent is singular to round-off")
        negative = int(sign * (-1.0) ** self.negative < 0.0)
        border = right, solved, np.asarray(np.linalg.inv(core), dtype=np.float64)
        return replace(self, negative=negative, border=border)
