"""The clamps of a pivot: how their rows and reactions change with states and design."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import System
from spline_model.effects import Clamp
from spline_model.effects.base import Constraint
from spline_model.kernels.clamps import ClampTable
from spline_model.pivot import STRIPS
from spline_model.sensitivity.parameters import Rates

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class ClampRows:
    """-lambda psi of C clamps; by_point (P, C) the clamped points' rates as x + i y, by_direction (P, C).

    A clamp holds the end of a strip in g + e^(i theta) b, and the direction of C' there at m + theta.
    """

    table: ClampTable
    by_point: NDArray[np.complex128]
    by_direction: Array

    @classmethod
    def of(cls, system: System, rates: Rates) -> ClampRows:
        """The clamps of a pivot's scene."""
        points, directions = [], []
        for clamp in system.scene.of(Constraint):
            if isinstance(clamp, Clamp):
                i = STRIPS.index(clamp.strip)
                point = (rates.ground if clamp.end == "start" else rates.arm)[:, i]
                points.append(point[:, 0] + 1j * point[:, 1])
                directions.append(rates.direction[:, i])
        return cls(
            table=system.tables.clamps,
            by_point=np.stack(points, axis=1),
            by_direction=np.stack(directions, axis=1),
        )

    def residual(self, states: Array) -> Array:
        """d2(-lambda psi)/(dz dp), (S, N, P)."""
        out = np.zeros((*states.shape, len(self.by_point)))
        table = self.table
        for c, (row, body) in enumerate(zip(table.row, table.body, strict=True)):
            moved = self._turned(states, c)
            out[:, row], out[:, row + 1] = moved.real, moved.imag
            out[:, row + 2] = self.by_direction[:, c]
            if body >= 0:
                force = states[:, row] + 1j * states[:, row + 1]
                out[:, body + 2] -= (force.conj()[:, None] * moved).imag
        return out

    def third(self, states: Array, rate: Array, changes: Array) -> Array:
        """d/dp of rate^T (d2(-lambda psi)/dz2) rate along the changes of the states, (S, P)."""
        total = np.zeros((len(states), len(self.by_point)))
        for c in range(self.table.row.size):
            total += self._bent(c, states, rate, changes)
            if self.table.body[c] >= 0:
                total += self._swung(c, states, rate, changes)
        return total

    def _turned(self, states: Array, c: int) -> NDArray[np.complex128]:
        """Rate of the clamped point in the ground's axes, (S, P)."""
        body = self.table.body[c]
        turn = np.exp(1j * states[:, body + 2]) if body >= 0 else np.ones(len(states))
        return np.asarray(turn[:, None] * self.by_point[:, c])

    def _bent(self, c: int, states: Array, rate: Array, changes: Array) -> Array:
        """Share of the moment's row: the angle of d is Im(log d), with d along C'."""
        end, inner, row, sign = (
            x[c] for x in (self.table.end, self.table.inner, self.table.row, self.table.sign)
        )
        d, a, u = (sign * (_point(z, inner) - _point(z, end)) for z in (states, rate, changes))
        m, push, pull = (z[..., row + 2] for z in (states, rate, changes))
        once, other = a / d, u / d
        third = m * (2.0 * once**2 * other).imag - pull * (once**2).imag - 2.0 * push * (once * other).imag
        return np.asarray(-third.T)

    def _swung(self, c: int, states: Array, rate: Array, changes: Array) -> Array:
        """Share of the point's rows: b turns with the body, whose rate of rotation is one."""
        row, body = self.table.row[c], self.table.body[c]
        force, push, pull = (_point(z, row).conj() for z in (states, rate, changes))
        spin = rate[:, body + 2]
        arm = np.exp(1j * states[:, body + 2]) * complex(*self.table.point[c])
        moved = self._turned(states, c)
        third = (
            -force[:, None] * moved * spin[:, None] ** 2
            - pull.T * (arm * spin**2)[:, None]
            + 2j * push[:, None] * moved * spin[:, None]
        )
        return np.asarray(third.real)


def _point(z: Array, first: int) -> NDArray[np.complex128]:
    return np.asarray(z[..., first] + 1j * z[..., first + 1])
