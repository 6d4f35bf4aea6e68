"""The explicit integrator of a swing: corrected leapfrog in reduced coordinates, compiled as a whole.

Fourth order in the phase of every oscillation, with two evaluations of the strips' forces a
step; clamps hold because they are solved, not enforced. Stable while omega_max h < sqrt(12),
omega_max being an axial frequency. The energy is not kept to round-off: Table 1 with six
control points changes it by 1.5e-4 of its value over 0.05 s at a step of 5 microseconds. For a
released body on straight Bezier strips with inertia, without damping, loads or drives.
Sources: see ``spline_model.fast.leapfrog``.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from spline_model.compile import System
from spline_model.errors import InvalidParameter
from spline_model.fast.acceleration import accelerate, stored_energy
from spline_model.fast.leapfrog import run
from spline_model.fast.release import coordinates, is_swing, reduced, swing
from spline_model.fast.swing import Swing, SwingSpace, swing_space
from spline_model.integrators.motion import Array, Records
from spline_model.kernels.motion import Motion
from spline_model.kernels.record import KINETIC, STRAIN
from spline_model.mechanism import Mechanism

STABILITY_LIMIT = 12.0**0.5
"""omega h up to which a step does not amplify an undamped oscillation."""
MOST_ENERGY = 1.01
"""Strain energy over the whole energy of the start at which a run is unstable and stops."""


class Flight(NamedTuple):
    """A swing about to start: constants, working arrays, r, its rates and acceleration, and the records."""

    constants: Swing
    space: SwingSpace
    r: Array
    w: Array
    acceleration: Array
    records: tuple[Array, Array, Array]
    most_energy: float

    def fly(self, step: float, every: int) -> int:
        """Fill the records, ``every`` steps apart, in compiled code; returns the rows filled."""
        most = self.most_energy
        start = (self.r, self.w, self.acceleration)
        return int(run(*start, step, every, most, self.constants, self.space, self.records))


def flight(system: System, motion: Motion, z: Array, v: Array, rows: int, mechanism: Mechanism) -> Flight:
    """The swing from (z, v) with space for ``rows`` records, the first one filled."""
    if not is_swing(mechanism, system):
        raise InvalidParameter(
            "integrator", "leapfrog", "energy, for other scenes than a free body on straight mixed strips"
        )
    constants = swing(mechanism, system, motion)
    space, (r, w) = swing_space(constants), reduced(mechanism, system, constants.frame, z, v)
    acceleration, strain = np.zeros_like(r), np.zeros(rows)
    accelerate(r, w, constants, space, acceleration)
    strain[0] = stored_energy(r, constants, space)[0]
    places, rates = (np.zeros((rows, len(r))) for _ in range(2))
    places[0], rates[0] = r, w
    most = MOST_ENERGY * (strain[0] + 0.5 * float(v @ motion.mass @ v))
    return Flight(constants, space, r, w, acceleration, (places, rates, strain), most)


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
    mechanism: Mechanism,
) -> Records:
    """Take ``steps`` steps from (z, v), recording every ``every``-th one; finds its own acceleration."""
    rows = steps // every + 1
    start = flight(system, motion, z, v, rows, mechanism)
    done = start.fly(step, every)
    places, rates, strain = start.records
    q, v = coordinates(mechanism, system, start.constants.frame, places[:done], rates[:done])
    table = np.zeros((done, 7))
    table[:, KINETIC] = 0.5 * np.einsum("ti,ij,tj->t", v, motion.mass, v, optimize=True)
    table[:, STRAIN] = strain[:done]
    states = np.zeros((done, len(z)))
    states[:, : q.shape[1]] = q
    message = "" if done == rows else f"unstable near {done * every * step:.6g} s: take a shorter step"
    return Records(
        time=np.arange(0.0, done) * (step * every),
        states=states,
        velocities=v,
        rows=table,
        message=message,
        counters={"steps": (done - 1) * every, "evaluations": 2 * (done - 1) * every},
    )
