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
    begun, begin = None, (0.0, system.rest)
    if start is not None or is_preloaded(system):
        begun = _begin(system, start, branch)
        begin = (begun.here.load_factor, begun.here.z)
    path = None
    if model is not None and (begun is None or not begun.watch.before):
        path = follow_reduced(model, load_factors, begin)
    if path is None:
        return _bordered(begun or _begin(system, start, branch), load_factors, progress)
    if progress is not None:
        for i in range(len(load_factors)):
            progress(i + 1, len(load_factors))
    return path


def _begin(system: System, start: tuple[float, Array] | None, branch: str) -> Follower:
    """A follower at the first state of a path by the bordered system."""
    watch = Watch(Workspace.of(system), leaves=branch == "follow", by_load=True)
    return Follower(watch, *first_point(watch, start))


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
