"""What happens at an instant of a motion: drives that begin, end or change, loads that jump."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from spline_model.bordered import assemble
from spline_model.effects.history import factor_at
from spline_model.motion.start import Motion
from spline_model.tables import YIELDING

Array = NDArray[np.float64]

SAME = 1e-9
"""Instants nearer than this share of a step are the same."""


def event_times(motion: Motion, duration: float, step: float) -> list[float]:
    """Instants inside the motion at which a drive begins or ends or a history has a corner [s].

    A step that ends there keeps its order, and a corner of an active drive, which is a jump of
    its rate, does not ring on as it would in a step across it.
    """
    tables = motion.tables
    times = np.concatenate(
        (tables.drives.begin, tables.drives.until, tables.drives.times, tables.loads.times)
    )
    inside = np.sort(times[(times > SAME * step) & (times < duration - SAME * step)])
    apart = np.diff(inside, prepend=-np.inf) > SAME * step
    return [float(time) for time in inside[apart]]


def drives_at(motion: Motion, time: float) -> NDArray[np.int64]:
    """1 for each drive row that holds at that time [s], 0 for the others."""
    drives = motion.tables.drives
    return ((drives.begin < time) & (time < drives.until)).astype(np.int64)


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
    motion: Motion, z: Array, v: Array, active: NDArray[np.int64], time: float, span: float
) -> tuple[Array, float]:
    """Velocity that the active drives allow, and the kinetic energy that the change takes [J].

    v+ is the velocity nearest to v in the kinetic metric that satisfies all constraints and
    the drives' rates over the next ``span`` [s]: the effect of impulses along the constraints,
    an inelastic catch.
    """
    drives = motion.tables.drives
    held = np.flatnonzero(active)
    if not held.size:
        return v, 0.0
    size, count = z.size, v.size
    gradient, hessian = np.empty(size), np.empty((size, size))
    points, clamps = motion.tables.points, motion.tables.clamps
    assemble(z, points, clamps, gradient, hessian, np.empty((5, 4)))
    holding = clamps.row[clamps.numbers[:, YIELDING] == 0.0]
    rows = np.concatenate((clamps.row, clamps.row + 1, holding + 2, drives.row[held])).astype(int)
    hessian[drives.row, drives.coordinate] = -1.0
    jacobian = -hessian[rows][:, :count]
    rate = np.zeros(len(rows))
    for i, d in enumerate(held):
        history = (drives.first[d], drives.pairs[d], drives.times, drives.factors)
        change = factor_at(time + span, *history) - factor_at(time, *history)
        rate[len(rows) - len(held) + i] = change / span * drives.target[d]
    inverse = np.linalg.pinv(motion.mass)
    impulse = np.linalg.lstsq(jacobian @ inverse @ jacobian.T, rate - jacobian @ v, rcond=1e-12)[0]
    caught = v + inverse @ jacobian.T @ impulse
    return caught, 0.5 * float(v @ motion.mass @ v - caught @ motion.mass @ caught)
