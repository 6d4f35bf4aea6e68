"""Vectors in the plane and curves of them as complex arrays, x and y along axis 1; all is analytic."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]


@dataclass(frozen=True, kw_only=True, eq=False)
class Curve:
    """C' and C'' (Q, 2, G, P, S)."""

    first: Array
    second: Array

    @classmethod
    def of(cls, d1: Array, d2: Array, points: Array) -> Curve:
        """From tables (Q, n) and control points (n, 2, G, P, S)."""
        return cls(first=times(d1, points), second=times(d2, points))

    @cached_property
    def square(self) -> Array:
        """|C'|^2 (Q, G, P, S)."""
        return dot(self.first, self.first)

    @cached_property
    def speed(self) -> Array:
        """v = |C'|."""
        return np.sqrt(self.square)

    @cached_property
    def turning(self) -> Array:
        """phi, turning of the tangent per du."""
        return cross(self.first, self.second) / self.square


def turned(angle: Array, x: Array, y: Array | float) -> Array:
    """The vector (x, y) turned by an angle, x and y along axis 1."""
    c, s = np.cos(angle), np.sin(angle)
    return np.stack((c * x - s * y, s * x + c * y), axis=1)


def times(table: Array, values: Array) -> Array:
    """table @ values along the first axis, one product of real matrices."""
    flat = np.ascontiguousarray(values).reshape(len(values), -1)
    return (table @ flat.view(np.float64)).view(flat.dtype).reshape(len(table), *values.shape[1:])


def times_each(tables: Array, values: Array) -> Array:
    """The same with a table for each strip, (G, ...) of values (..., G, P, S)."""
    return np.stack([times(table, values[:, s]) for s, table in enumerate(tables)], axis=1)


def across(v: Array) -> Array:
    """The vectors turned by a right angle."""
    return np.stack((-v[:, 1], v[:, 0]), axis=1)


def cross(a: Array, b: Array) -> Array:
    """a x b."""
    return np.asarray(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])


def dot(a: Array, b: Array) -> Array:
    """a . b."""
    return np.asarray(a[:, 0] * b[:, 0] + a[:, 1] * b[:, 1])
