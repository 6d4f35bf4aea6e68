"""Stretching by quadrature: how its forces and its energy change with states and design."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from spline_model.sensitivity.lines import Line, Speed

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class StretchingPoints:
    """V = sum w 1/2 EA (v / J - 1 - eps_0)^2 J over Q points, v = |C'|."""

    line: Line
    weight: Array
    strain: Array
    rigidity: float
    speed: float
    by_rigidity: Array
    by_speed: Array

    def residual(self, states: Array) -> Array:
        """d2V/(dz dp), (S, N, P)."""
        tangent = self.line.at(states)
        v, j, ea = np.abs(tangent), self.speed, self.rigidity
        rate = (v / j - 1.0 - self.strain)[..., None] * self.by_rigidity - (ea * v / j**2)[
            ..., None
        ] * self.by_speed
        gradient = ((tangent / v)[..., None].conj() * self.line.table).real
        return np.asarray(gradient.transpose(0, 2, 1) @ (self.weight[:, None] * rate))

    def energy(self, states: Array, changes: Array) -> Array:
        """dV/dp along the changes (P, S, N) of the states, (S, P) [J over the parameter]."""
        tangent = self.line.at(states)
        v, j, ea, given = np.abs(tangent), self.speed, self.rigidity, 1.0 + self.strain
        along = (self.line.at(changes) * tangent.conj()).real / v
        strain = v / j - given
        moved = (ea * strain * along) @ self.weight
        stiffer, longer = 0.5 * strain**2 * j, 0.5 * ea * (given**2 - (v / j) ** 2)
        return np.asarray(
            moved.T
            + np.outer(stiffer @ self.weight, self.by_rigidity)
            + np.outer(longer @ self.weight, self.by_speed)
        )

    def third(self, states: Array, rate: Array, changes: Array) -> Array:
        """d/dp of rate^T (d2V/dz2) rate along the changes of the states, (S, P)."""
        v = Speed.of(self.line, states, rate, changes)
        j, ea, given = self.speed, self.rigidity, 1.0 + self.strain
        square = v.value * v.twice + v.by_rate**2  # of 1/2 v^2
        moved = v.value * v.third + v.twice * v.by_change + 2.0 * v.by_rate * v.mixed
        return np.asarray(
            (ea * (moved / j - given * v.third) @ self.weight).T
            + np.outer(square @ self.weight, self.by_rigidity / j - ea / j**2 * self.by_speed)
            - np.outer((given * v.twice) @ self.weight, self.by_rigidity)
        )
