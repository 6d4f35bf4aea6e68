"""A motion by impulses, carried through a run as the others are, and what steps led to."""

from __future__ import annotations

import math
import sys
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from spline_model.impulses.arrays import COUNTS, ENERGY, RESIDUAL, Moving, Problem, Space
from spline_model.impulses.steps import printed_advance, stable_advance
from spline_model.impulses.system import strain_energy
from spline_model.motion.moves import Moves, Steps
from spline_model.motion.records import DISSIPATED, KINETIC, STRAIN, WEIGHT, Whole, rows_of
from spline_model.motion.start import Motion
from spline_model.strip.compiled import copy, kernel

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

COUNTERS = ("steps", "solves", "sweeps", "halved_steps", "limited_steps")
REASONS = {
    "published": "the step is above the stability limit",
    "stable": "no part of the step can be solved, or a strip folds; take a shorter one",
}
"""Why a motion of a form stops."""


@dataclass(frozen=True, kw_only=True, eq=False)
class State:
    """Where a motion is. A step leaves it as it is and returns another.

    z (N,) unknowns: coordinates, axial forces, multipliers; v (Q,) velocities; earlier (2, Q) coordinates
    and velocities of the step before, which count if ``known`` is 1 and not if it is 0;
    time [s]; held: whether a pose was imposed in the step that led here.
    """

    z: Array
    v: Array
    earlier: Array
    known: int
    time: float
    held: bool


@dataclass(frozen=True, kw_only=True, eq=False)
class Outcome:
    """What steps led to.

    state: after the last step that was taken; taken, asked: numbers of steps; kinetic, strain and
    gravity energy, and what these steps dissipated [J]; constraint_residual [m];
    residual: the largest that a step left in its equations, or an impulse before the last
    had to close [1];
    counters: steps (halves count), solves, sweeps, halved_steps, limited_steps.
    """

    state: State
    taken: int
    asked: int
    kinetic_energy: float
    strain_energy: float
    gravity_energy: float
    dissipated: float
    constraint_residual: float
    residual: float
    counters: dict[str, int]

    @property
    def complete(self) -> bool:
        """Whether all steps were taken; if not, the state is the last good one."""
        return self.taken == self.asked


class Stepper(Moves):
    """A motion from a state, its steps between two events in one call; they see to the energy themselves.

    A record is unknowns (N,), velocities (Q,), strain energy, work done and energy dissipated [J]. problem:
    the motion's, without drives; form: "published" or "stable"; space: work space, which steppers may share.
    """

    most_gain = math.inf
    watched = sys.maxsize
    smallest = 1.0

    def __init__(self, motion: Motion, problem: Problem, space: Space, form: str, state: State) -> None:
        self._undriven, self._space, self._form = problem, space, form
        self.counters = np.zeros(6, dtype=np.int64)
        self.moving = Moving(
            z=state.z.copy(),
            v=state.v.copy(),
            earlier=state.earlier.copy(),
            status=np.array([state.known, 0.0, 0.0]),
            counters=self.counters,
            totals=np.zeros(2),
        )
        self.width = len(state.z) + len(state.v) + 3
        self.drive(motion, np.zeros_like(problem.active))
        self._begin()

    def _begin(self) -> None:
        (z, v), problem = self.moving[:2], self._undriven
        strain = strain_energy(z, v, problem, self._space)
        self.moving.status[ENERGY] = 0.5 * v @ problem.mass @ v + strain - problem.weight @ z[: v.size]

    def drive(self, motion: Motion, active: Indices) -> None:
        """Go on with the drives of a motion, of which those hold whose ``active`` (D,) is 1."""
        self.motion, self.active = motion, active
        self._problem = self._undriven._replace(drives=motion.drives, active=active)

    def instants(self, run: Steps) -> list[float]:
        """When drives begin, change or end: at the ends of the nearest steps [s]."""
        nearest = {round(time / run.step) for time in super().instants(run)} - {0, run.steps}
        return [number * run.step for number in sorted(nearest)]

    def switch(self, time: float, span: float) -> None:
        """Let drives begin, change or end at ``time``, over at least ``span`` [s]: the run starts again."""
        active, (z, v) = self.motion.drives_at(time + 0.5 * span), self.moving[:2]
        self.drive(self.motion.from_here(z, active, self.active, time), active)
        v[:], lost = self.motion.catch(z, v, active, time, span)
        self.moving.totals[1] += lost
        self.moving.status[COUNTS] = 0.0
        self._begin()

    def steps(self, time: float, step: float, begin: int, end: int, every: int, records: Array) -> int:
        """Take the steps ``begin`` ... ``end`` - 1; the number of the first that cannot be, or end."""
        stable = self._form == "stable"
        given = stable, self._problem, self._space, records
        return int(_advance(self.moving, time, step, begin, end, every, *given))

    def record(self) -> Array:
        """The present state's record (W,)."""
        record = np.empty(self.width)
        _store(self.moving, self._problem, self._space, record)
        return record

    def unknowns(self, records: Array) -> tuple[Array, Array]:
        """Unknowns (R, N) and velocities (R, Q) of records."""
        size = self.motion.system.layout.size
        return records[:, :size], records[:, size:-3]

    def shown(self, records: Array) -> tuple[Array, Array]:
        """Poses (R, 3 B) of the bodies [m, rad] and rows (R, 5) of energies [J] of records."""
        z, v = self.unknowns(records)
        return z[:, self.motion.system.layout.poses], rows_of(self.motion, z, v, records[:, -3:])

    def counted(self, steps: int) -> dict[str, int]:
        """What was counted, by name."""
        return dict(zip(COUNTERS, self.counters[: len(COUNTERS)].tolist(), strict=True))

    def reason(self) -> str:
        """Why the last step was given up, and what helps."""
        return REASONS[self._form]

    def outcome(self, taken: int, asked: int, time: float, held: bool) -> Outcome:
        """Where the motion stands, for who asked for steps."""
        moving, system = self.moving, self.motion.system
        z, v, (row,) = self.look()
        (gap,) = Whole(self.motion, partial(tuple, (z, v))).gaps
        known, rest = int(moving.status[COUNTS]), system.rest[: system.weight.size]
        return Outcome(
            state=State(z=moving.z, v=moving.v, earlier=moving.earlier, known=known, time=time, held=held),
            taken=taken,
            asked=asked,
            kinetic_energy=float(row[KINETIC]),
            strain_energy=float(row[STRAIN]),
            gravity_energy=float(row[WEIGHT] + system.weight @ rest),
            dissipated=float(row[DISSIPATED]),
            constraint_residual=float(gap),
            residual=float(moving.status[RESIDUAL]),
            counters=self.counted(taken),
        )


@kernel()
def _store(moving, problem, space, record):
    """Fill a record (W,) of the present state."""
    size, count = moving.z.size, moving.v.size
    copy(moving.z, record[:size])
    copy(moving.v, record[size : size + count])
    record[size + count] = strain_energy(moving.z, moving.v, problem, space)
    copy(moving.totals, record[size + count + 1 :])


@kernel()
def _advance(moving, time, h, begin, end, every, stable, problem, space, records):
    """Take the steps ``begin`` ... ``end`` - 1 of length h, step 0 being at ``time`` [s].

    Returns the number of the first step that was not taken; ``moving`` stands at its begin. records: filled
    at the ends of steps whose number ``every`` divides.
    """
    for k in range(begin, end):
        now = time + k * h
        if stable:
            done = stable_advance(moving, now, h, problem, space)
        else:
            done = printed_advance(moving, now, h, problem, space)
        if not done:
            return k
        if (k + 1) % every == 0:
            _store(moving, problem, space, records[(k + 1) // every - begin // every - 1])
    return end
