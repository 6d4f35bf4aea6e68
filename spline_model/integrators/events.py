"""Drives that begin and end during a motion."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from spline_model.kernels.assemble import assemble
from spline_model.kernels.drives import factor_at
from spline_model.kernels.motion import Motion

Array = NDArray[np.float64]


def drive_events(motion: Motion, step: float, steps: int) -> list[int]:
    """Steps at which a drive begins or ends, with 0 and ``steps``, in order."""
    drives = motion.tables.drives
    times = np.concatenate((drives.begin, drives.until))
    inside = {round(float(t) / step) for t in times if t < step * steps}
    return sorted({0, steps} | {k for k in inside if 0 < k < steps})


def drives_at(motion: Motion, number: int, step: float) -> NDArray[np.int64]:
    """1 for each drive row that holds in the step of that number, 0 for the others."""
    drives = motion.tables.drives
    middle = (number + 0.5) * step
    return ((drives.begin < middle) & (middle < drives.until)).astype(np.int64)


def from_here(
    motion: Motion, z: Array, active: NDArray[np.int64], before: NDArray[np.int64], time: float
) -> Motion:
    """The motion with the drives that begin now starting from where their bodies are."""
    drives = motion.tables.drives
    origin = drives.origin.copy()
    for d in np.flatnonzero(active & ~before.astype(bool)):
        factor = factor_at(time, drives.first[d], drives.pairs[d], drives.times, drives.factors)
        origin[d] = z[drives.coordinate[d]] - factor * drives.target[d]
    return motion._replace(tables=motion.tables._replace(drives=drives._replace(origin=origin)))


def catch(
    motion: Motion, z: Array, v: Array, active: NDArray[np.int64], time: float, step: float
) -> tuple[Array, float]:
    """Velocity that the active drives allow, and the kinetic energy that the change takes [J].

    v+ is the velocity nearest to v in the kinetic metric that satisfies all constraints and
    the drives' rates: the effect of impulses along the constraints, an inelastic catch.
    """
    drives = motion.tables.drives
    held = np.flatnonzero(active)
    if not held.size:
        return v, 0.0
    size, count = z.size, v.size
    gradient, hessian = np.empty(size), np.empty((size, size))
    assemble(z, motion.tables, 0.0, gradient, hessian)
    clamps = motion.tables.clamps
    rows = np.concatenate([clamps.row + i for i in range(3)] + [drives.row[held]]).astype(int)
    jacobian = -hessian[rows][:, :count]
    rate = np.zeros(len(rows))
    for i, d in enumerate(held):
        history = (drives.first[d], drives.pairs[d], drives.times, drives.factors)
        change = factor_at(time + step, *history) - factor_at(time, *history)
        rate[len(rows) - len(held) + i] = change / step * drives.target[d]
    inverse = np.linalg.pinv(motion.mass)
    impulse = np.linalg.lstsq(jacobian @ inverse @ jacobian.T, rate - jacobian @ v, rcond=1e-12)[0]
    caught = v + inverse @ jacobian.T @ impulse
    return caught, 0.5 * float(v @ motion.mass @ v - caught @ motion.mass @ caught)
