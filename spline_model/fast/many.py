"""Many frames of the same size, one path each, in one compiled loop."""

from __future__ import annotations

from numba import njit

from spline_model.fast.body import Frame
from spline_model.fast.path import ITERATIONS, follow
from spline_model.fast.strain import largest_strain


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
def follow_share(
    begin, stride, frames, start, targets, grid, locals_, space, tolerance, answer, depth, stations, results
):
    """Follow every ``stride``-th path from ``begin`` on and fill their rows of the results.

    start (Y,) is the state at rest, its first two entries being the body's place; targets
    (D, S - 1) or, the same for all, (1, S - 1); depth (D,) of the sections, or (0,): no
    strain is asked for; results are the arrays of ``Batch``: states, centre, torque, stiffness,
    energy, strain, inertia, moment_defect, iterations.
    """
    states, centre, torque, stiffness, energy, strain, inertia, defect, iterations = results
    y = start.copy()
    for i in range(begin, states.size, stride):
        frame = frame_at(frames, i)
        y[0], y[1] = frame.centre[0] / frame.length[0], frame.centre[1] / frame.length[0]
        answer.counters[:] = 0
        own = targets[min(i, targets.shape[0] - 1)]
        done = follow(y, own, frame, grid, locals_, space, tolerance, answer)
        states[i] = done
        iterations[i] = answer.counters[ITERATIONS]
        for k in range(done):
            centre[i, k, 0] = answer.y[k, 0] * frame.length[0]
            centre[i, k, 1] = answer.y[k, 1] * frame.length[0]
            torque[i, k], stiffness[i, k] = answer.torque[k], answer.stiffness[k]
            inertia[i, k], defect[i, k] = answer.inertia[k], answer.defect[k]
            energy[i, k] = answer.energies[k, 0] + answer.energies[k, 1]
            if depth.size > 0:
                theta = own[k - 1] if k > 0 else 0.0
                strain[i, k] = largest_strain(answer.y[k], theta, frame, depth[i], locals_, stations)
