"""States to start from that others give: corrected, checked and traced back to rest, or refused."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from spline_model.checks import refuse
from spline_model.continuation.resolution import Resolution
from spline_model.errors import InvalidParameter
from spline_model.newton import Newton, Workspace, solve
from spline_model.solution import MechanismSolution, Path, StaticSolution

Array = NDArray[np.float64]


def equilibrium(work: Workspace, resolution: Resolution, load_factor: float, z: Array) -> Newton:
    """The equilibrium that Newton finds from z, if it passes the checks of an accepted state.

    Raises InvalidParameter if z has another size, is not finite, or leads to no such state.
    """
    size = work.system.layout.size
    if np.shape(z) != (size,) or not np.isfinite(z).all():
        raise InvalidParameter("start", np.shape(z), f"finite unknowns of shape ({size},)")
    newton = solve(work, np.asarray(z, dtype=float), load_factor)
    reason = newton.reason or refuse(work.system, newton.z) or resolution.refuse(newton.z)
    if reason:
        raise InvalidParameter("start", reason, "a state from which Newton finds an equilibrium")
    return newton


def last_state(start: Path | StaticSolution | MechanismSolution, angle: float = 1.0) -> tuple[float, Array]:
    """Load factor and unknowns where a result ended; a pivot's load factor is rotation / ``angle``."""
    at = start.rotation / angle if isinstance(start, StaticSolution) else start.load_factor
    return float(at[-1]), start.states[-1]
