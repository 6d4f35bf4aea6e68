"""The static operator of a system: its compiled tables and the potentials in Python."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import System
from spline_model.kernels.assemble import assemble

Array = NDArray[np.float64]


def evaluate(
    system: System, z: Array, load_factor: float, gradient: Array, hessian: Array
) -> tuple[float, float]:
    """Fill gradient (N,) and hessian (N, N) at z (N,); returns bending and axial energy [J].

    Energies of potentials in Python are not in what is returned.
    """
    bending, axial = assemble(z, system.tables, load_factor, gradient, hessian)
    count = system.layout.coordinate_count
    for potential in system.open_potentials:
        _, force, stiffness = potential.derivatives(z[:count], system.layout)
        gradient[:count] += force
        hessian[:count, :count] += stiffness
    return bending, axial


def open_energy(system: System, z: Array) -> float:
    """Energy of the potentials in Python [J], which the compiled records do not know."""
    q = z[: system.layout.coordinate_count]
    return float(sum(potential.derivatives(q, system.layout)[0] for potential in system.open_potentials))
