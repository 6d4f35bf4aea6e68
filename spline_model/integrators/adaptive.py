"""Step control for the energy-consistent scheme by its local error."""

from __future__ import annotations

import numpy as np

from spline_model.compile import System
from spline_model.integrators import energy_consistent
from spline_model.integrators.energy_consistent import counts
from spline_model.integrators.monitor import MOST_GAIN, first_gain
from spline_model.integrators.motion import Array, Records, require_compiled, require_conservative
from spline_model.kernels.energy_step import advance
from spline_model.kernels.motion import Motion
from spline_model.kernels.record import record

FIRST_STEP = 1e-4
"""First trial step over the duration."""
MOST_RECORDS = 1_000_000
"""Steps that one run keeps: some gigabytes at six control points."""
SMALLEST_STEP = 1e-9
"""Least step over the duration before the run is given up."""


def integrate(
    system: System,
    motion: Motion,
    z: Array,
    v: Array,
    acceleration: Array,
    *,
    duration: float,
    accuracy: float,
) -> Records:
    """Advance by ``duration`` with steps whose error in the rotations stays within its share.

    The explicit prediction from position, velocity and the last step's mean acceleration errs
    by 5/12 h^3 q''' and the step itself by -1/12 h^3 q''': a sixth of their difference
    estimates the step's error (Milne's device; Hairer, Norsett and Wanner, III.7). A step is
    accepted if it is below accuracy * h / duration. Every accepted step is a record.
    """
    counters, strains = np.zeros(6, dtype=np.int64), np.empty(len(motion.rigidity))
    totals, active = np.zeros(2), np.zeros(motion.tables.drives.row.size, dtype=np.int64)
    time, states, rates, rows = [0.0], [z.copy()], [v.copy()], [np.empty(7)]

    require_compiled(system, "accuracy control")
    require_conservative(motion, "accuracy control")
    record(z, v, motion, strains, totals, rows[0])
    rejected, message, h = 0, "", FIRST_STEP * duration
    while duration - time[-1] > 1e-9 * duration:
        if len(time) > MOST_RECORDS:
            message = f"stopped at {time[-1]:.6g} s: {MOST_RECORDS} steps are kept at most"
            break
        h = min(h, duration - time[-1])
        new_z, new_v, new_a = states[-1].copy(), rates[-1].copy(), acceleration.copy()
        turns = motion.turns
        predicted = new_z[turns] + h * (new_v[turns] + 0.5 * h * new_a[turns])
        new_totals = totals.copy()
        done = advance(
            new_z,
            new_v,
            new_a,
            time[-1],
            h,
            h,
            h,
            active,
            motion,
            energy_consistent.TOLERANCE,
            counters,
            new_totals,
        )
        error = np.abs(new_z[turns] - predicted).max() / 6 if done == h else np.inf
        share = accuracy * h / duration
        if error <= share:
            time.append(time[-1] + h)
            states.append(new_z)
            rates.append(new_v)
            acceleration, totals = new_a, new_totals
            rows.append(np.empty(7))
            record(new_z, new_v, motion, strains, totals, rows[-1])
            if first_gain(np.array((rows[0], rows[-1])), motion.energy, MOST_GAIN) < 2:
                message = f"stopped at {time[-1]:.6g} s: the energy grows"
                break
        else:
            rejected += 1
        # the error over its share goes with h^2
        h *= float(np.clip(0.9 * np.sqrt(share / error), 0.2, 2.0)) if error > 0 else 2.0
        if h < SMALLEST_STEP * duration:
            message = f"stopped at {time[-1]:.6g} s: no step is short enough for the accuracy"
            break
    return Records(
        time=np.array(time),
        states=np.array(states),
        velocities=np.array(rates),
        rows=np.array(rows),
        message=message,
        counters=counts(counters) | {"rejected_steps": rejected},
    )
