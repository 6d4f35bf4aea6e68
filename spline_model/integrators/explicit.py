"""The explicit integrator: classical Runge-Kutta on the reduced coordinates.

Fourth order, no equations to solve but the constant-size reduced mass matrix; constraints
hold exactly because they are solved, not enforced. Stable while omega_max h < sqrt(8), where
omega_max is an axial frequency (``critical_step``); not for inextensible strips, which have
none. Source: Hairer, Norsett and Wanner, Solving Ordinary Differential Equations I (1993), II.1.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import System
from spline_model.errors import InvalidParameter
from spline_model.integrators.monitor import MOST_GAIN_OF_OTHERS, first_gain
from spline_model.integrators.motion import Array, Records, require_compiled, require_conservative
from spline_model.kernels.motion import Motion
from spline_model.kernels.record import record
from spline_model.kernels.reduced import Workspace, expand, runge_kutta

STABILITY_LIMIT = 8.0**0.5
"""omega h up to which Runge-Kutta 4 does not amplify an undamped oscillation."""


def reduce(motion: Motion, z: Array, v: Array) -> tuple[Array, Array, NDArray[np.int64]]:
    """Reduced coordinates r (R,), their rates w (R,) and the free indices in q, from a state."""
    clamps, count = motion.tables.clamps, len(v)
    held = {int(i) + j for i in (*clamps.end, *clamps.inner) for j in range(2)}
    free = np.array([i for i in range(count) if i not in held], dtype=np.int64)
    chords = [z[i : i + 2] - z[e : e + 2] for e, i in zip(clamps.end, clamps.inner, strict=True)]
    r = np.concatenate((z[free], [np.hypot(*c) for c in chords] / motion.chord))
    jacobian, drift = np.zeros((count, len(r))), np.zeros(count)
    expand(r, np.zeros(len(r)), free, clamps, motion.chord, z.copy(), jacobian, drift)
    return r, np.asarray(np.linalg.lstsq(jacobian, v, rcond=None)[0]), free


def require_explicit(system: System, motion: Motion) -> None:
    """Refuse a scene whose accelerations do not follow from its state alone."""
    if (np.diag(motion.rigidity) == 0).any():
        raise InvalidParameter("integrator", "explicit", "an implicit one for inextensible strips")
    require_compiled(system, "explicit")
    require_conservative(motion, "explicit")
    if np.linalg.eigvalsh(motion.mass)[0] <= 0:
        raise InvalidParameter("integrator", "explicit", "an implicit one for strips without mass")


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
    """Take ``steps`` steps from (z, v), recording every ``every``-th one; ``acceleration`` is not needed."""
    require_explicit(system, motion)
    r, w, free = reduce(motion, z, v)
    size, count = len(z), len(v)
    work = Workspace(
        z=z.copy(),
        gradient=np.empty(size),
        hessian=np.empty((size, size)),
        jacobian=np.empty((count, len(r))),
        drift=np.empty(count),
        strains=np.empty(len(motion.rigidity)),
    )
    totals = np.zeros(2)
    states, rates, rows, message = [z], [v], [np.empty(7)], ""
    record(z, v, motion, work.strains, totals, rows[0])
    for k in range(steps // every):
        fine = runge_kutta(r, w, step, every, free, motion, work)
        if fine:
            expand(r, w, free, motion.tables.clamps, motion.chord, work.z, work.jacobian, work.drift)
            states.append(work.z.copy())
            rates.append(work.jacobian @ w)
            rows.append(np.empty(7))
            record(states[-1], rates[-1], motion, work.strains, totals, rows[-1])
            fine = first_gain(np.array((rows[0], rows[-1])), motion.energy, MOST_GAIN_OF_OTHERS) == 2
        if not fine:
            kept = k + 1
            states, rates, rows = states[:kept], rates[:kept], rows[:kept]
            message = f"unstable near {k * every * step:.6g} s: the step is above the critical one"
            break
    return Records(
        time=np.arange(0.0, len(states)) * (step * every),
        states=np.array(states),
        velocities=np.array(rates),
        rows=np.array(rows),
        message=message,
        counters={"steps": (len(states) - 1) * every, "evaluations": 4 * (len(states) - 1) * every},
    )
