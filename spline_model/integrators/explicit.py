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
from spline_model.integrators.motion import Array, Motion, Records
from spline_model.kernels.energy_step import record
from spline_model.kernels.reduced import expand, runge_kutta

STABILITY_LIMIT = 8.0**0.5
"""omega h up to which Runge-Kutta 4 does not amplify an undamped oscillation."""
MOST_ENERGY = 1.1
"""A run whose energy exceeds this times the initial one is unstable and stops."""


def reduce(system: System, z: Array, v: Array) -> tuple[Array, Array, NDArray[np.int64], Array]:
    """Reduced coordinates r, rates w, the free indices in q and the chords at rest, from a state."""
    clamps, layout = system.tables.clamps, system.layout
    held = {int(i) + j for i in (*clamps.end, *clamps.inner) for j in range(2)}
    free = np.array([i for i in range(layout.coordinate_count) if i not in held], dtype=np.int64)
    rest = [
        system.rest[i : i + 2] - system.rest[e : e + 2] for e, i in zip(clamps.end, clamps.inner, strict=True)
    ]
    chord = np.array([np.hypot(*c) for c in rest])
    now = [z[i : i + 2] - z[e : e + 2] for e, i in zip(clamps.end, clamps.inner, strict=True)]
    r = np.concatenate((z[free], [np.hypot(*c) for c in now] / chord))
    jacobian, drift = np.zeros((layout.coordinate_count, len(r))), np.zeros(layout.coordinate_count)
    expand(r, np.zeros(len(r)), free, clamps, chord, z.copy(), jacobian, drift)
    return r, np.linalg.lstsq(jacobian, v, rcond=None)[0], free, chord


def integrate(
    motion: Motion, z: Array, v: Array, acceleration: Array, *, step: float, steps: int, every: int
) -> Records:
    """Take ``steps`` steps from (z, v), recording every ``every``-th one; ``acceleration`` is not needed."""
    if (np.diag(motion.rigidity) == 0).any():
        raise InvalidParameter(
            "integrator", "explicit", "energy or generalised-alpha for inextensible strips"
        )
    system, count = motion.system, len(v)
    r, w, free, chord = reduce(system, z, v)
    size, strains = system.layout.size, np.empty(len(motion.rigidity))
    state = z.copy()
    arrays = (
        np.empty(size),
        np.empty((size, size)),
        np.empty((count, len(r))),
        np.empty(count),
        strains,
    )
    states, rates, rows, message = [z], [v], [np.empty(4)], ""
    start = system.layout.coordinate_count
    record(z, v, system.tables, motion.mass, motion.rigidity, start, chord, strains, rows[0])
    most = MOST_ENERGY * (rows[0][0] + rows[0][1])
    for k in range(steps // every):
        fine = runge_kutta(
            r, w, step, every, free, system.tables, chord, motion.mass, motion.rigidity, state, *arrays
        )
        if fine:
            expand(r, w, free, system.tables.clamps, chord, state, arrays[2], arrays[3])
            speed = arrays[2] @ w
            row = np.empty(4)
            record(state, speed, system.tables, motion.mass, motion.rigidity, start, chord, strains, row)
            fine = row[0] + row[1] <= most
        if not fine:
            message = f"unstable near {k * every * step:.6g} s: the step is above the critical one"
            break
        states.append(state.copy())
        rates.append(speed)
        rows.append(row)
    return Records(
        time=step * every * np.arange(len(states)),
        states=np.array(states),
        velocities=np.array(rates),
        rows=np.array(rows),
        message=message,
        counters={"steps": (len(states) - 1) * every, "evaluations": 4 * (len(states) - 1) * every},
    )
