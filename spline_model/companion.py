"""How far a motion is resolved, by a companion that has two control points more.

Where the scene is undamped and free the companion is the leapfrog, whose steps resolve all, so that the
difference shows what the motion's own steps and its control points leave out together; else it has the
motion's own integrator and step, and shows the control points alone.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from spline_model.accurate_motion import EXPLICIT, MORE, Task, with_points
from spline_model.errors import ConvergenceError, InvalidParameter
from spline_model.mechanism import Mechanism
from spline_model.motion.dispatch import QUASI_STATIC
from spline_model.newton import Laps

if TYPE_CHECKING:
    from spline_model.motion.trajectory import Trajectory

Array = NDArray[np.float64]

UNRESOLVED = 0.05
"""Largest difference to the companion over the swing that is not remarked on."""
PART = 0.9
"""Explicit step of the companion over the critical one."""
MOST_SHORTER = 20.0
"""Leapfrog steps that cost about as much as one step of the default integrator."""
STILL = 1e-6
"""Difference of a motion that hardly is one [rad]: its start differs by that alone."""
INSTANTS = 1000
"""Instants at which the two are compared, about: at least so many where the motion has as many records."""


def with_companion(task: Task, motion: Trajectory) -> Trajectory:
    """The motion with its ``rotation_error``, and a remark in ``resolution`` where that is much of the swing.

    task: that of the motion. A companion that fails leaves nothing to compare, and the
    remark says so.
    """
    laps, mechanism = Laps(), task.mechanism
    points = mechanism.design.discretisation.points + MORE
    every = _thinning(len(motion.time) - 1)
    instants = motion.time[::every]
    try:
        chosen = with_points(mechanism, points)
        other = task.run(chosen, *_scheme(motion, task, chosen, float(instants[1])), len(instants) - 1)
        failed = other.message
    except (ConvergenceError, InvalidParameter) as error:
        failed = str(error)
    seconds = laps.lap("check") | motion.seconds
    if failed:
        remark = f"not checked with {points} control points: {failed}"
        return replace(motion, checked=remark, seconds=seconds)
    apart = np.abs(other.rotation - motion.rotation[::every])
    return replace(
        motion,
        rotation_error=float(apart.max()),
        checked=_remark(mechanism, motion, instants, apart, points),
        seconds=seconds,
    )


def _thinning(records: int) -> int:
    """Every which record is compared: the largest divisor that leaves at least ``INSTANTS``."""
    return max((each for each in range(1, records // INSTANTS + 1) if records % each == 0), default=1)


def _scheme(motion: Trajectory, task: Task, chosen: Mechanism, spacing: float) -> tuple[str, float]:
    """Integrator and step [s] of the companion, whole steps between two instants ``spacing`` [s] apart."""
    own, step = str(motion.settings["integrator"]), float(motion.settings["step_s"])
    critical = PART * task.critical(chosen)
    if critical > 0.0 and (own == EXPLICIT or step <= MOST_SHORTER * critical):
        return EXPLICIT, spacing / math.ceil(spacing / critical)
    return ("energy" if own == QUASI_STATIC else own), spacing / round(spacing / step)


def _remark(mechanism: Mechanism, motion: Trajectory, time: Array, apart: Array, points: int) -> str:
    """What is to be said of the differences (T,) [rad], or nothing.

    They are held against the swing: half the range of the rotation, or of the centre over a strip where
    the body hardly turns.
    """
    length = max(strip.length for strip in mechanism.design.strips)
    swing = 0.5 * max(float(np.ptp(motion.rotation)), float(np.ptp(motion.centre, axis=0).max()) / length)
    much = np.flatnonzero(apart > max(UNRESOLVED * swing, STILL))
    if not much.size:
        return ""
    return (
        f"with {points} control points the rotation differs by up to {np.degrees(apart.max()):.3g} deg, by "
        f"more than {UNRESOLVED:.0%} of the swing from {time[much[0]]:.3g} s on: the motion is not resolved; "
        "take more control points or ask for an accuracy"
    )
