"""The default integrator: a discrete-gradient scheme that cannot create energy.

    M (v1 - v0) / h + D V(q0, q1) - D psi^T lambda = 0,   (v0 + v1) / 2 = (q1 - q0) / h,
    psi(q1) = 0

T + V is the same before and after a step of any size, up to the residual of Newton's method,
and so are the momenta of a free scene. Second order; implicit; a step whose Newton fails, or
that turns an end tangent backwards, is halved; one in which a drive or a load changes abruptly
is cut there.
Source: Gonzalez, Time integration and discrete Hamiltonian systems, J Nonlinear Sci 6 (1996)
449; for constraints, Gonzalez, Mechanical systems subject to holonomic constraints, Physica D
132 (1999) 165.
"""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import System
from spline_model.integrators.events import SAME, catch, drives_at, event_times, from_here
from spline_model.integrators.monitor import MOST_GAIN, first_gain
from spline_model.integrators.motion import Array, Records, require_compiled
from spline_model.kernels.energy_step import (
    FACTORISATIONS,
    FOLDED,
    HALVED,
    MOST_HALVED,
    MOST_HALVED_A_STEP,
    NEWTON,
    STEPS,
    WHOLE,
    advance,
    run,
)
from spline_model.kernels.motion import Motion
from spline_model.kernels.record import record

TOLERANCE = 1e-11
"""Residual of a step, in EI/L^2, EI/L, L and rad; the energy of a step is exact to this."""
SMALLEST_STEP = 2.0**-14
"""Least fraction of a step before the run is given up."""
WATCHED = 4096
"""Steps after which the energy is looked at, at the latest."""


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

    Drives begin and end at their times and start from where the body is; a body that is caught
    changes its velocity at once, and what that costs counts as dissipated. A run whose balance
    of energies gains more than ``MOST_GAIN`` is stopped at the last good record.
    """
    require_compiled(system, "energy")
    mover = _Mover(motion, z, v, acceleration, step, steps, every)
    for begin, end in pairwise((0.0, *event_times(motion, steps * step, step), steps * step)):
        mover.switch(begin, min(end - begin, step))
        if not mover.go_to(end):
            break
    kept = mover.kept
    return Records(
        time=np.arange(0.0, kept) * (step * every),
        states=mover.states[:kept],
        velocities=mover.rates[:kept],
        rows=mover.rows[:kept],
        message=mover.message,
        counters=counts(mover.counters),
    )


class _Mover:
    """The state of a run and its records on a uniform grid."""

    def __init__(
        self, motion: Motion, z: Array, v: Array, acceleration: Array, step: float, steps: int, every: int
    ) -> None:
        count = steps // every + 1
        self.motion, self.step, self.every = motion, step, every
        self.z, self.v, self.acceleration = z.copy(), v.copy(), acceleration.copy()
        self.states, self.rates = np.zeros((count, z.size)), np.zeros((count, v.size))
        self.rows, self.totals = np.zeros((count, 7)), np.zeros(2)
        self.counters = np.zeros(6, dtype=np.int64)
        self.active = np.zeros(motion.tables.drives.row.size, dtype=np.int64)
        self.time, self.kept, self.message = 0.0, 0, ""

    def switch(self, time: float, span: float) -> None:
        """Let drives begin, change or end at ``time``; they then hold for at least ``span`` [s]."""
        before, self.active = self.active, drives_at(self.motion, time + 0.5 * span)
        self.motion = from_here(self.motion, self.z, self.active, before, time)
        self.v, lost = catch(self.motion, self.z, self.v, self.active, time, span)
        if (self.active > before).any():
            self.totals[1] += lost
        else:  # a drive that changes its own rate does work
            self.totals[0] -= lost
        if time == 0.0:
            self._record(0)

    def go_to(self, end: float) -> bool:
        """Move on to the time ``end`` [s]; False, with the reason, where that fails."""
        close = SAME * self.step
        while end - self.time > close:
            number = math.floor((self.time + close) / self.step)
            last = math.floor((end + close) / self.step)
            if abs(self.time - number * self.step) <= close and last > number:
                watched = max(1, WATCHED // self.every) * self.every
                done = self._whole_steps(number, min(last, number + watched - number % self.every))
            else:
                done = self._part_of_step(min(end, (number + 1) * self.step), number + 1)
            if not done:
                return False
        return True

    def _whole_steps(self, begin: int, end: int) -> bool:
        done = run(
            self.z,
            self.v,
            self.acceleration,
            self.step,
            begin,
            end,
            self.every,
            self.step * SMALLEST_STEP,
            self.active,
            self.motion,
            TOLERANCE,
            self.counters,
            self.totals,
            self.states,
            self.rates,
            self.rows,
        )
        self.time, self.kept = done * self.step, done // self.every + 1
        return self._is_good(done == end)

    def _part_of_step(self, target: float, number: int) -> bool:
        """Advance to ``target``, at most to the end of the step before grid point ``number``."""
        span = target - self.time
        done = advance(
            self.z,
            self.v,
            self.acceleration,
            self.time,
            span,
            span,
            span * SMALLEST_STEP,
            self.active,
            self.motion,
            TOLERANCE,
            self.counters,
            self.totals,
        )
        if done == span:
            at_grid = abs(target - number * self.step) <= SAME * self.step
            self.time = number * self.step if at_grid else target
            if at_grid and number % self.every == 0:
                self._record(number // self.every)
        return self._is_good(done == span)

    def _record(self, place: int) -> None:
        self.states[place], self.rates[place] = self.z, self.v
        strains = np.empty(len(self.motion.rigidity))
        record(self.z, self.v, self.motion, strains, self.totals, self.rows[place])
        self.kept = place + 1

    def _is_good(self, solved: bool) -> bool:
        """Whether the run may go on: its steps were solved, and its energy did not grow."""
        good = first_gain(self.rows[: self.kept], self.motion.energy, MOST_GAIN)
        if good < self.kept:
            at = good * self.every * self.step
            self.message = f"stopped at {at:.6g} s: the energy grows by more than {MOST_GAIN:g} of itself"
            self.kept = good
        elif not solved:
            reason = (
                "a strip folds; take a shorter step" if self.counters[FOLDED] else "Newton fails at any step"
            )
            if self.counters[HALVED] > MOST_HALVED + MOST_HALVED_A_STEP * self.counters[WHOLE]:
                reason = "steps are halved too often; take a shorter one"
            self.message = f"stopped at {self.time:.6g} s: {reason}"
        return not self.message


def counts(counters: NDArray[np.int64]) -> dict[str, int]:
    """Counters of a run by name."""
    return {
        "steps": int(counters[STEPS]),
        "halved_steps": int(counters[HALVED]),
        "newton_iterations": int(counters[NEWTON]),
        "factorisations": int(counters[FACTORISATIONS]),
    }
