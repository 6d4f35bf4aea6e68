"""How far a motion is resolved, by a companion that has two control points more.

Where the scene is undamped and free the companion is the leapfrog, whose steps resolve all, so that the
difference shows what the motion's own steps and its control points leave out together; else it has the
motion's own integrator and step, and shows the control points alone.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from spline_model.accurate_motion import EXPLICIT, MORE, Task
from spline_model.errors import ConvergenceError, InvalidParameter
from spline_model.mechanism import Mechanism
from spline_model.motion import quasi_static
from spline_model.motion.records import Trajectory
from spline_model.newton import Laps

Array = NDArray[np.float64]

UNRESOLVED, STILL = 0.05, 1e-6
"""Largest difference to the companion that is not remarked on: over the swing, and [rad] of a motion that
hardly is one, as its start differs by that alone."""
PART, MOST_SHORTER = 0.9, 20.0
"""Explicit step of the companion over the critical one; so many cost about as much as a default step."""
COMPARED = 1000
"""Instants at which the two are compared, about: at least so many where the motion has as many records."""


def with_companion(task: Task, motion: Trajectory) -> Trajectory:
    """The motion with its ``rotation_error``, and a remark in ``resolution`` where that is much of the swing.

    task: that of the motion. A companion that fails leaves nothing to compare, and the remark says so.
    """
    laps, count = Laps(), len(motion.time) - 1
    points = task.mechanism.design.discretisation.points + MORE
    # the largest divisor that leaves enough instants
    every = max((each for each in range(1, count // COMPARED + 1) if count % each == 0), default=1)
    instants = motion.time[::every]
    try:
        scheme = _scheme(motion, PART * task.critical(points), float(instants[1]))
        other = task.run(points, *scheme, len(instants) - 1)
        failed = other.message
    except (ConvergenceError, InvalidParameter) as refused:
        failed = str(refused)
    error, remark, seconds = (
        math.nan,
        f"not checked with {points} control points: {failed}",
        laps.lap("check"),
    )
    if not failed:
        apart = np.abs(other.rotation - motion.rotation[::every])
        error, remark = float(apart.max()), _remark(task.mechanism, motion, instants, apart, points)
    return replace(motion, rotation_error=error, checked=remark, seconds=seconds | motion.seconds)


def _scheme(motion: Trajectory, longest: float, spacing: float) -> tuple[str, float]:
    """Integrator and step [s] of the companion, whole steps between two instants ``spacing`` [s] apart.

    longest: step of the leapfrog [s], 0 where it cannot be used.
    """
    own, step = str(motion.settings["integrator"]), float(motion.settings["step_s"])
    if longest > 0.0 and (own == EXPLICIT or step <= MOST_SHORTER * longest):
        return EXPLICIT, spacing / math.ceil(spacing / longest)
    return ("energy" if own == quasi_static.NAME else own), spacing / round(spacing / step)


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
