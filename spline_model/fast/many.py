"""Many frames of the same size, one path each, in one compiled loop."""

from __future__ import annotations

from numba import njit

from spline_model.fast.body import Frame
from spline_model.fast.path import ITERATIONS, follow


@njit(cache=True, nogil=True)
def frame_at(frames, i):
    """The i-th of D frames, whose fields have one axis more."""
    return Frame(
        frames.root[i],
        frames.axis[i],
        frames.length[i],
        frames.rigidity[i],
        frames.arm[i],
        frames.compliance[i],
        frames.centre[i],
    )


@njit(cache=True, nogil=True)
def follow_share(begin, stride, frames, start, targets, grid, locals_, space, tolerance, answer, results):
    """Follow every ``stride``-th path from ``begin`` on and fill their rows of the results.

    start (Y,) is the state at rest, its first two entries being the body's place; results are
    the arrays of ``Batch``: states, centre, torque, stiffness, energy, inertia, moment_defect,
    iterations.
    """
    states, centre, torque, stiffness, energy, inertia, defect, iterations = results
    y = start.copy()
    for i in range(begin, states.size, stride):
        frame = frame_at(frames, i)
        y[0], y[1] = frame.centre[0] / frame.length[0], frame.centre[1] / frame.length[0]
        answer.counters[:] = 0
        done = follow(y, targets, frame, grid, locals_, space, tolerance, answer)
        states[i] = done
        iterations[i] = answer.counters[ITERATIONS]
        for k in range(done):
            centre[i, k, 0] = answer.y[k, 0] * frame.length[0]
            centre[i, k, 1] = answer.y[k, 1] * frame.length[0]
            torque[i, k], stiffness[i, k] = answer.torque[k], answer.stiffness[k]
            inertia[i, k], defect[i, k] = answer.inertia[k], answer.defect[k]
            energy[i, k] = answer.energies[k, 0] + answer.energies[k, 1]
