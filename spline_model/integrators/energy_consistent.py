"""The default integrator: a discrete-gradient scheme that cannot create energy.

    M (v1 - v0) / h + D V(q0, q1) - D psi^T lambda = 0,   (v0 + v1) / 2 = (q1 - q0) / h,
    psi(q1) = 0

T + V is the same before and after a step of any size, up to the residual of Newton's method,
and so are the momenta of a free scene. Second order; implicit; a step whose Newton fails, or
that turns an end tangent backwards, is halved.
Source: Gonzalez, Time integration and discrete Hamiltonian systems, J Nonlinear Sci 6 (1996)
449; for constraints, Gonzalez, Mechanical systems subject to holonomic constraints, Physica D
132 (1999) 165.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import System
from spline_model.integrators.events import catch, drive_events, drives_at, from_here
from spline_model.integrators.motion import Array, Records, require_compiled
from spline_model.kernels.energy_step import FACTORISATIONS, FOLDED, HALVED, NEWTON, STEPS, run
from spline_model.kernels.motion import Motion
from spline_model.kernels.record import record

TOLERANCE = 1e-11
"""Residual of a step, in EI/L^2, EI/L, L and rad; the energy of a step is exact to this."""
SMALLEST_STEP = 2.0**-14
"""Least fraction of a step before the run is given up."""


def integrate(
    system: System,
    motion: Motion,
    z: Array,
    v: Array,
    acceleration: Array,
    *,
    step: float,
    steps: int,
    every: int,
) -> Records:
    """Take ``steps`` steps from (z, v), recording every ``every``-th one.

    Drives begin and end at the step nearest to their times and start from where the body is;
    a body that is caught changes its velocity at once, and what that costs counts as dissipated.
    """
    require_compiled(system, "energy")
    count = steps // every + 1
    states, rates = np.zeros((count, z.size)), np.zeros((count, v.size))
    rows, totals = np.zeros((count, 7)), np.zeros(2)
    counters = np.zeros(5, dtype=np.int64)
    z, v, acceleration = z.copy(), v.copy(), acceleration.copy()
    events = drive_events(motion, step, steps)
    active = drives_at(motion, 0, step)
    motion = from_here(motion, z, active, np.zeros_like(active), 0.0)
    v, totals[1] = catch(motion, z, v, active, 0.0, step)
    states[0], rates[0] = z, v
    record(z, v, motion, np.empty(len(motion.rigidity)), totals, rows[0])
    done = 0
    for begin, end in pairwise(events):
        if begin > 0:
            before, active = active, drives_at(motion, begin, step)
            motion = from_here(motion, z, active, before, begin * step)
            v, lost = catch(motion, z, v, active, begin * step, step)
            totals[1] += lost
        done = run(
            z,
            v,
            acceleration,
            step,
            begin,
            end,
            every,
            step * SMALLEST_STEP,
            active,
            motion,
            TOLERANCE,
            counters,
            totals,
            states,
            rates,
            rows,
        )
        if done < end:
            break
    kept = done // every + 1
    reason = "a strip folds; take a shorter step" if counters[FOLDED] else "Newton fails at any step"
    message = "" if done == steps else f"stopped at {done * step:.6g} s: {reason}"
    return Records(
        time=np.arange(0.0, kept) * (step * every),
        states=states[:kept],
        velocities=rates[:kept],
        rows=rows[:kept],
        message=message,
        counters=counts(counters),
    )


def counts(counters: NDArray[np.int64]) -> dict[str, int]:
    """Counters of a run by name."""
    return {
        "steps": int(counters[STEPS]),
        "halved_steps": int(counters[HALVED]),
        "newton_iterations": int(counters[NEWTON]),
        "factorisations": int(counters[FACTORISATIONS]),
    }
