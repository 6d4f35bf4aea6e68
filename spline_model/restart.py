"""Going on with a motion where another one ended."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import System
from spline_model.errors import InvalidParameter
from spline_model.kernels.motion import Motion

if TYPE_CHECKING:
    from spline_model.motion.trajectory import Trajectory

Array = NDArray[np.float64]


def last_state(before: Trajectory, system: System) -> tuple[Array, Array]:
    """Unknowns (N,) and velocities (Q,) of the last record, for a system that may have other drives."""
    layout = system.layout
    known, count = layout.multiplier_start, layout.coordinate_count
    if before.velocities.shape[1] != count or before.states.shape[1] < known:
        raise InvalidParameter("after", "a motion of another mechanism", f"one of {count} coordinates")
    z = np.zeros(layout.size)
    z[:known] = before.states[-1, :known]
    return z, before.velocities[-1].copy()


def later(motion: Motion, time: float) -> Motion:
    """The motion with its clock set to ``time`` [s]: histories and drives are that far on."""
    drives, loads = motion.tables.drives, motion.tables.loads
    drives = drives._replace(times=drives.times - time, begin=drives.begin - time, until=drives.until - time)
    loads = loads._replace(times=loads.times - time)
    return motion._replace(tables=motion.tables._replace(drives=drives, loads=loads))


def counted_on(trajectory: Trajectory, before: Trajectory) -> Trajectory:
    """The trajectory with time, work and losses counted on from the end of the one before."""
    return replace(
        trajectory,
        time=trajectory.time + before.time[-1],
        work=trajectory.work + before.work[-1],
        dissipated=trajectory.dissipated + before.dissipated[-1],
    )
