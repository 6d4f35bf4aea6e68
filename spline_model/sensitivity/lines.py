"""Values along the strips as linear maps of the unknowns, and what follows from them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from spline_model.layout import Layout
from spline_model.scene import Strip

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


@dataclass(frozen=True, kw_only=True, eq=False)
class Line:
    """A derivative of the centreline at Q points, table (Q, N) @ z, as complex numbers x + i y [m]."""

    table: Complex

    @classmethod
    def at_gauss(cls, first: NDArray[np.int64], values: Array, size: int) -> Line:
        """From a kernel's table: first (Q,) index in z of the support, values (Q, S) of its functions."""
        columns = first[:, None] + 2 * np.arange(values.shape[1])
        return cls(table=_spread(columns, values, size))

    @classmethod
    def at_stations(cls, strips: Sequence[Strip], layout: Layout, stations: Array, order: int) -> Line:
        """The derivative of that order at stations u of all strips, one strip after the other."""
        parts = []
        for strip in strips:
            start, count = layout.strips[strip.name]
            columns = np.tile(start + 2 * np.arange(count), (len(stations), 1))
            parts.append(_spread(columns, strip.basis.evaluate(stations, order), layout.size))
        return cls(table=np.concatenate(parts))

    @cached_property
    def _parts(self) -> Array:
        """The table's transpose with real and imaginary parts in turn, (N, 2 Q): real products are faster."""
        return np.ascontiguousarray(self.table.T).view(np.float64)

    def at(self, z: Array) -> Complex:
        """Values for unknowns z (..., N): (..., Q)."""
        return (z @ self._parts).view(np.complex128)


def _spread(columns: NDArray[np.int64], values: Array, size: int) -> Complex:
    table = np.zeros((len(values), size), dtype=np.complex128)
    rows = np.arange(len(values))[:, None]
    table[rows, columns] = values
    table[rows, columns + 1] = 1j * values
    return table


@dataclass(frozen=True, kw_only=True, eq=False)
class Turning:
    """phi = d(theta)/du = Im(C'' / C') at Q points of S states, and the ratio itself (S, Q)."""

    tangent: Complex
    ratio: Complex

    @classmethod
    def of(cls, tangent: Complex, bend: Complex) -> Turning:
        """From C' and C''."""
        return cls(tangent=tangent, ratio=bend / tangent)

    @property
    def value(self) -> Array:
        """phi (S, Q) [1]."""
        return self.ratio.imag

    def gradient(self, first: Line, second: Line) -> Array:
        """d(phi)/dz, (S, Q, N) [1/m]."""
        bent = second.table - self.ratio[..., None] * first.table
        return np.asarray((bent / self.tangent[..., None]).imag)

    def along(self, tangent: Complex, bend: Complex) -> Complex:
        """Derivative of the ratio in a direction whose C' and C'' are given, (S, Q) or (P, S, Q)."""
        return np.asarray((bend - self.ratio * tangent) / self.tangent)


@dataclass(frozen=True, kw_only=True, eq=False)
class Speed:
    """v = |C'| at Q points of S states and its derivatives by two directions a and u in the unknowns.

    by_rate v_a, twice v_aa (S, Q); by_change v_u, mixed v_au, third v_aau (P, S, Q).
    """

    value: Array
    by_rate: Array
    twice: Array
    by_change: Array
    mixed: Array
    third: Array

    @classmethod
    def of(cls, line: Line, states: Array, rate: Array, changes: Array) -> Speed:
        """For states and rate (S, N) and changes (P, S, N)."""
        tangent = line.at(states)
        v = np.abs(tangent)
        unit = tangent.conj() / v
        a, u = line.at(rate) * unit, line.at(changes) * unit  # along + i across
        return cls(
            value=v,
            by_rate=a.real,
            twice=a.imag**2 / v,
            by_change=u.real,
            mixed=a.imag * u.imag / v,
            third=-a.imag * (a.imag * u.real + 2.0 * u.imag * a.real) / v**2,
        )
