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
) -> Path:
    """Solve the scene at each load factor in turn, from rest at load factor 0.

    An increment whose Newton fails, or whose solution does not pass the checks, is taken
    in halves; when a part below SMALLEST_STEP still fails, the path ends with its last
    good state and the reason. start: load factor and unknowns (N,) of an equilibrium to go
    on from instead of rest. branch: "primary" stays on the branch it is on where another one
    crosses; "follow" leaves it there, along the critical mode.
    """
    require_choice("branch", branch, BRANCHES)
    watch = Watch(Workspace.of(system), leaves=branch == "follow", by_load=True)
    follower = Follower(watch, *first_point(watch, start))
    message = ""
    for i, target in enumerate(load_factors):
        message = follower.advance(float(target))
        if message:
            break
        watch.work.counters.increments += 1
        if progress is not None:
            progress(i + 1, len(load_factors))
    return watch.path(follower.points, follower.done, message, follower.history)
