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

import numpy as np

from spline_model.integrators.motion import Array, Records
from spline_model.kernels.energy_step import FACTORISATIONS, HALVED, NEWTON, STEPS, run
from spline_model.kernels.motion import Motion

TOLERANCE = 1e-11
"""Residual of a step, in EI/L^2, EI/L, L and rad; the energy of a step is exact to this."""
SMALLEST_STEP = 2.0**-14
"""Least fraction of a step before the run is given up."""


def integrate(
    motion: Motion, z: Array, v: Array, acceleration: Array, *, step: float, steps: int, every: int
) -> Records:
    """Take ``steps`` steps from (z, v), recording every ``every``-th one."""
    count = steps // every + 1
    states, rates, rows = np.zeros((count, z.size)), np.zeros((count, v.size)), np.zeros((count, 4))
    states[0], rates[0] = z, v
    counters = np.zeros(4, dtype=np.int64)
    done = run(
        z.copy(),
        v.copy(),
        acceleration.copy(),
        step,
        steps,
        every,
        step * SMALLEST_STEP,
        motion,
        TOLERANCE,
        counters,
        states,
        rates,
        rows,
    )
    kept = done // every + 1
    message = "" if done == steps else f"stopped at {done * step:.6g} s: Newton fails at any step"
    return Records(
        time=step * every * np.arange(kept),
        states=states[:kept],
        velocities=rates[:kept],
        rows=rows[:kept],
        message=message,
        counters={
            "steps": int(counters[STEPS]),
            "halved_steps": int(counters[HALVED]),
            "newton_iterations": int(counters[NEWTON]),
            "factorisations": int(counters[FACTORISATIONS]),
        },
    )
