"""Bending of the strips: how its forces and its energy change with states and design."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from spline_model.sensitivity.lines import Line, Turning

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class BendingPoints:
    """V = sum w 1/2 EI (phi^2 / J - 2 kappa_0 phi + kappa_0^2 J) over Q points; J = L, the strip is straight.

    rigidity EI, curvature kappa_0 (Q,), speed J and the rates by P parameters (P,).
    """

    first: Line
    second: Line
    weight: Array
    rigidity: float
    curvature: Array
    speed: float
    by_rigidity: Array
    by_speed: Array

    def residual(self, states: Array) -> Array:
        """d2V/(dz dp), (S, N, P)."""
        turning = Turning.of(self.first.at(states), self.second.at(states))
        phi, j, ei = turning.value[..., None], self.speed, self.rigidity
        rate = (phi / j - self.curvature[:, None]) * self.by_rigidity - ei * phi / j**2 * self.by_speed
        return np.asarray(
            turning.gradient(self.first, self.second).transpose(0, 2, 1) @ (self.weight[:, None] * rate)
        )

    def energy(self, states: Array, changes: Array) -> Array:
        """dV/dp along the changes (P, S, N) of the states, (S, P) [J over the parameter]."""
        turning = Turning.of(self.first.at(states), self.second.at(states))
        phi, j, ei, k0 = turning.value, self.speed, self.rigidity, self.curvature
        strain = phi / j - k0
        turned = turning.along(self.first.at(changes), self.second.at(changes)).imag
        moved = (ei * strain * turned @ self.weight).T
        stiffer = (0.5 * strain**2 * j) @ self.weight
        longer = (0.5 * ei * (k0**2 - (phi / j) ** 2)) @ self.weight
        return np.asarray(moved + np.outer(stiffer, self.by_rigidity) + np.outer(longer, self.by_speed))

    def third(self, states: Array, rate: Array, changes: Array) -> Array:
        """d/dp of rate^T (d2V/dz2) rate along the changes of the states, (S, P)."""
        turning = Turning.of(self.first.at(states), self.second.at(states))
        fv, fu = self.first.at(rate), self.first.at(changes)
        j, ei, k0, f = self.speed, self.rigidity, self.curvature, turning.tangent
        hv, hu = turning.along(fv, self.second.at(rate)), turning.along(fu, self.second.at(changes))
        hvv, huv = -2.0 * hv * fv / f, -(hu * fv + hv * fu) / f
        huvv = -(2.0 * huv * fv + hvv * fu) / f
        phi = turning.value
        square = (phi * hvv.imag + hv.imag**2) @ self.weight  # of 1/2 phi^2
        moved = phi * huvv.imag + hvv.imag * hu.imag + 2.0 * hv.imag * huv.imag
        return np.asarray(
            (ei * (moved / j - k0 * huvv.imag) @ self.weight).T
            + np.outer(square, self.by_rigidity / j - ei / j**2 * self.by_speed)
            - np.outer((k0 * hvv.imag) @ self.weight, self.by_rigidity)
        )
