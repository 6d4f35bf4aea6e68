"""Where a motion by impulses stands, and what steps led to."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class State:
    """Where a motion is. A step leaves it as it is and returns another.

    z (N,) unknowns: coordinates, axial forces, multipliers; v (Q,) velocities; earlier_q,
    earlier_v (Q,) those of the step before, which count if ``known`` is 1 and not if it is 0;
    time [s]; held: whether a pose was imposed in the step that led here.
    """

    z: Array
    v: Array
    earlier_q: Array
    earlier_v: Array
    known: int
    time: float
    held: bool


@dataclass(frozen=True, kw_only=True, eq=False)
class Outcome:
    """What steps led to.

    state: after the last step that was taken; taken, asked: numbers of steps; kinetic, strain and
    gravity energy [J]; constraint_residual [m], velocity_residual [m/s]; residual: the largest
    that a step left in its equations, or an impulse before the last had to close [1];
    counters: steps (halves count), solves, sweeps, halved_steps, limited_steps.
    """

    state: State
    taken: int
    asked: int
    kinetic_energy: float
    strain_energy: float
    gravity_energy: float
    constraint_residual: float
    velocity_residual: float
    residual: float
    counters: dict[str, int]

    @property
    def complete(self) -> bool:
        """Whether all steps were taken; if not, the state is the last good one."""
        return self.taken == self.asked
