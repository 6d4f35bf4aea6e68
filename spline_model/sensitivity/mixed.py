"""Mixed stretching: how its forces and its energy change with states and design."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from spline_model.sensitivity.lines import Line, Speed

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class MixedPoints:
    """V = sum w (N (v - J (1 + eps_0)) - 1/2 c N^2 J) over Q points, v = |C'|, N = modes @ z.

    modes (Q, N); strain eps_0 and compliance c (Q,), by_compliance (Q, P).
    """

    line: Line
    modes: Array
    weight: Array
    strain: Array
    compliance: Array
    speed: float
    by_compliance: Array
    by_speed: Array

    @property
    def by_flexibility(self) -> Array:
        """d(c J)/dp (Q, P)."""
        return self.by_compliance * self.speed + np.outer(self.compliance, self.by_speed)

    def residual(self, states: Array) -> Array:
        """d2V/(dz dp), (S, N, P): only the rows of the axial forces know the design."""
        force = (states @ self.modes.T)[..., None]
        rate = -np.outer(1.0 + self.strain, self.by_speed) - force * self.by_flexibility
        return np.asarray(self.modes.T @ (self.weight[:, None] * rate))

    def energy(self, states: Array, changes: Array) -> Array:
        """dV/dp along the changes (P, S, N) of the states, (S, P) [J over the parameter]."""
        tangent = self.line.at(states)
        v, force, pull = np.abs(tangent), states @ self.modes.T, changes @ self.modes.T
        along = (self.line.at(changes) * tangent.conj()).real / v
        gap = v - self.speed * (1.0 + self.strain + self.compliance * force)
        moved = (pull * gap + force * along) @ self.weight
        longer = (force * (1.0 + self.strain)) @ self.weight
        return np.asarray(
            moved.T - np.outer(longer, self.by_speed) - 0.5 * (self.weight * force**2) @ self.by_flexibility
        )

    def third(self, states: Array, rate: Array, changes: Array) -> Array:
        """d/dp of rate^T (d2V/dz2) rate along the changes of the states, (S, P)."""
        v = Speed.of(self.line, states, rate, changes)
        force, pull, push = (part @ self.modes.T for part in (states, rate, changes))
        moved = (force * v.third + push * v.twice + 2.0 * pull * v.mixed) @ self.weight
        return np.asarray(moved.T - (self.weight * pull**2) @ self.by_flexibility)
