"""Where a path begins: at rest, or at a state that is given, corrected and checked."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from spline_model.continuation.followed import Followed
from spline_model.continuation.point import Point, stand
from spline_model.continuation.watch import Watch
from spline_model.errors import InvalidParameter
from spline_model.newton import Newton, solve
from spline_model.preload import settle
from spline_model.solution import Path, StaticSolution

Array = NDArray[np.float64]


def equilibrium(work: Followed, load_factor: float, unknowns: Array) -> Newton:
    """The equilibrium that Newton finds from the scene's unknowns, if an accepted state's checks pass.

    Raises InvalidParameter if these have another size, are not finite, or lead to no such state.
    """
    size = work.system.layout.size
    if np.shape(unknowns) != (size,) or not np.isfinite(unknowns).all():
        raise InvalidParameter("start", np.shape(unknowns), f"finite unknowns of shape ({size},)")
    newton = solve(work, work.state(np.asarray(unknowns, dtype=float)), load_factor)
    reason = newton.reason or work.refuse(newton.z) or work.unresolved(newton.z, load_factor)
    if reason:
        raise InvalidParameter("start", reason, "a state from which Newton finds an equilibrium")
    return newton


def first_point(watch: Watch, start: tuple[float, Array] | None) -> tuple[Point, tuple[float, ...]]:
    """The point where a path begins, and the residual norms: rest, or load factor and unknowns given.

    Raises InvalidParameter where there is none, or where nothing holds the scene.
    """
    work = watch.work
    newton = settle(watch) if start is None else equilibrium(work, *start)
    try:
        point = stand(work, newton.z, 0.0 if start is None else start[0], newton.energies)
    except np.linalg.LinAlgError as error:
        raise InvalidParameter("scene", str(error), "strips that can move, but not freely") from error
    return point, newton.norms


def last_state(start: Path | StaticSolution, angle: float = 0.0) -> tuple[float, Array]:
    """Load factor and unknowns where a result ended; of a body turned by ``angle`` at most, signed."""
    if isinstance(start, StaticSolution) and angle != 0.0:
        return float(start.rotation[-1]) / angle, start.states[-1]
    at = start.load_factor
    return float(at[-1]), start.states[-1]
