"""Where a path begins: at rest, weight and pre-strain grown from nothing, or at a state that is given."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from spline_model.continuation.followed import Followed
from spline_model.continuation.follower import Follower
from spline_model.continuation.point import Point, stand
from spline_model.continuation.remark import Place
from spline_model.continuation.watch import Watch
from spline_model.errors import InvalidParameter
from spline_model.newton import Newton, solve

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
    newton = _settle(watch) if start is None else equilibrium(work, *start)
    try:
        point = stand(work, newton.z, 0.0 if start is None else start[0], newton.energies)
    except np.linalg.LinAlgError as error:
        raise InvalidParameter("scene", str(error), "strips that can move, but not freely") from error
    return point, newton.norms


def _settle(watch: Watch) -> Newton:
    """Equilibrium at load factor 0: weight and pre-strain grow from nothing, watched like any path.

    Raises InvalidParameter where they cannot grow to their full size.
    """
    work = watch.work
    z = _grown(watch) if work.system.is_preloaded else work.state(work.system.rest)
    newton = solve(work, z, 0.0)
    if newton.reason:
        raise InvalidParameter("scene", newton.reason, "an equilibrium at load factor 0, near rest")
    return newton


def _grown(watch: Watch) -> Array:
    """The unknowns (N,) under full weight and pre-strain; what was met on the way is told to ``watch``."""
    growing = watch.work.growing()
    own = Watch(growing, leaves=watch.leaves, by_load=True, place=Place(system=None))
    newton = solve(growing, growing.state(growing.system.rest), 0.0)
    try:
        begin = stand(growing, newton.z, 0.0, newton.energies)
    except np.linalg.LinAlgError as error:
        raise InvalidParameter("scene", str(error), "strips that can move, but not freely") from error
    follower = Follower(own, begin, newton.norms)
    own.first = (0.0, begin.z)
    message = follower.advance(1.0)
    if message:
        raise InvalidParameter("scene", message, "an equilibrium under all of its weight and pre-strain")
    watch.leaves, watch.before = own.leaves, own.remark()
    return follower.here.z
