"""The reduced tangent: second variation of the energy on what the constraints leave free."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh, null_space

from spline_model.effects import MixedStretching
from spline_model.newton import Workspace

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class ReducedTangent:
    """stiffness (F, F) on the free directions (Q, F), which are orthonormal, all dimensionless (EI/L)."""

    stiffness: Array
    free: Array

    def eigenpair(self, number: int) -> tuple[float, Array]:
        """The eigenvalue of that number from the lowest, 0 on, and its direction (Q,)."""
        values, vectors = eigh(self.stiffness, subset_by_index=(number, number))
        return float(values[0]), np.asarray(self.free @ vectors[:, 0])


def reduced_tangent(work: Workspace) -> ReducedTangent:
    """The reduced tangent at the state that ``work`` was last evaluated at.

    Axial forces are condensed; clamps, drives and inextensible strips are constraints.
    """
    system = work.system
    layout, unit = system.layout, system.scales.unit
    count = layout.coordinate_count
    hessian = work.hessian * (unit[:, None] * unit / system.scales.energy)
    stiffness = hessian[:count, :count].copy()
    rows = [hessian[layout.multiplier_start :, :count]]
    for i, effect in enumerate(system.scene.of(MixedStretching)):
        at = layout.axial_modes(i)
        if effect.axial_compliance == 0.0:
            rows.append(hessian[at, :count])
        else:
            stiffness += hessian[at, :count].T @ np.linalg.solve(-hessian[at, at], hessian[at, :count])
    constraints = np.concatenate(rows)
    norms = np.linalg.norm(constraints, axis=1, keepdims=True)
    free = null_space(constraints / norms) if len(constraints) else np.eye(count)
    return ReducedTangent(stiffness=free.T @ stiffness @ free, free=free)
