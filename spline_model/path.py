"""An equilibrium path through given load factors."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import System
from spline_model.continuation.branch import BRANCHES
from spline_model.continuation.follower import Follower
from spline_model.continuation.start import first_point
from spline_model.continuation.watch import Watch
from spline_model.errors import require_choice
from spline_model.newton import Workspace
from spline_model.preload import is_preloaded
from spline_model.reduced.model import reduced
from spline_model.reduced.solve import follow_reduced
from spline_model.solution import Path

Array = NDArray[np.float64]

Progress = Callable[[int, int], None]
"""What is called with the increments done and the increments in all."""


def follow(
    system: System,
    load_factors: Sequence[float],
    progress: Progress | None = None,
    *,
    start: tuple[float, Array] | None = None,
    branch: str = "primary",
    method: str = "condensed",
) -> Path:
    """Solve the scene at each load factor in turn, from rest at load factor 0.

    method: "condensed" runs compiled on the strips' elements, where they know the scene, and by the
    bordered system with multipliers where that path stops or becomes unstable; "multipliers" by that
    system alone. Both agree to 1e-10.
    An increment whose Newton fails, or whose solution does not pass the checks, is taken
    in halves; when a part below SMALLEST_STEP still fails, the path ends with its last
    good state and the reason. start: load factor and unknowns (N,) of an equilibrium to go
    on from instead of rest. branch: "primary" stays on the branch it is on where another one
    crosses; "follow" leaves it there, along the critical mode.
    """
    require_choice("branch", branch, BRANCHES)
    model = reduced(system) if (branch, method) == ("primary", "condensed") else None
    watch, first = None, None
    if model is not None and start is None and not is_preloaded(system):
        path = follow_reduced(model, load_factors, (0.0, system.rest))
    else:
        watch = Watch(Workspace.of(system), leaves=branch == "follow", by_load=True)
        first = first_point(watch, start)
        path = None
        if model is not None and not watch.before:
            path = follow_reduced(model, load_factors, (first[0].load_factor, first[0].z))
    if path is not None:
        for i in range(len(load_factors) if progress is not None else 0):
            progress(i + 1, len(load_factors))
        return path
    if watch is None or first is None:
        watch = Watch(Workspace.of(system), leaves=branch == "follow", by_load=True)
        first = first_point(watch, start)
    return _bordered(Follower(watch, *first), load_factors, progress)


def _bordered(follower: Follower, load_factors: Sequence[float], progress: Progress | None) -> Path:
    """The path by the bordered system, told what it is watched for."""
    message = ""
    for i, target in enumerate(load_factors):
        message = follower.advance(float(target))
        if message:
            break
        follower.work.counters.increments += 1
        if progress is not None:
            progress(i + 1, len(load_factors))
    return follower.watch.path(follower.points, follower.done, message, follower.history)
