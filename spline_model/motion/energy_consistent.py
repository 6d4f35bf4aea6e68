"""The default integrator: a discrete-gradient scheme that cannot create energy.

    D^T (M (v1 - v0) / h + D V(q0, q1)) = 0,   (v0 + v1) / 2 = (q1 - q0) / h = D dy / h

T + V is the same before and after a step of any size, up to the residual of Newton's method,
and so are the momenta of a free scene. Clamps hold by construction: D moves control points and
bodies by their own coordinates y (``spline_model.motion.strip``). Second order; implicit; a step
whose Newton fails, or that turns an end tangent backwards, is halved; one in which a drive or a
load changes abruptly is cut there.
Source: Gonzalez, Time integration and discrete Hamiltonian systems, J Nonlinear Sci 6 (1996)
449; for constraints, Betsch, The discrete null space method, CMAME 194 (2005) 5159.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from spline_model.motion.mechanism import moving
from spline_model.motion.records import ENERGIES, MOST_GAIN, Records, compact, first_gain
from spline_model.motion.run import MOST_HALVED, MOST_HALVED_A_STEP, run, store
from spline_model.motion.start import SAME, Array, Motion, Start, Steps
from spline_model.motion.step import FACTORISATIONS, FOLDS, HALVED, NEWTON, REFUSED, STEPS, WHOLE
from spline_model.scene import Scene

TOLERANCE = 1e-11
"""Residual of a step, in EI/L^2, EI/L, L and rad; the energy of a step is exact to this."""
SMALLEST_STEP = 2.0**-14
"""Least fraction of a step before the run is given up."""
WATCHED = 4096
"""Steps after which the energy is looked at, at the latest."""


def integrate(start: Start, run: Steps) -> Records:
    """The records of a run.

    Drives begin and end at their times and start from where the body is; a body that is caught
    changes its velocity at once, and what that costs counts as dissipated. A run whose balance
    of energies gains more than ``MOST_GAIN`` is stopped at the last good record.
    """
    return carry(Stepper(start), run, start.z)


def carry(stepper: Moves, run: Steps, z: Array | None = None) -> Records:
    """The records of a stepper that starts from z (N,), or None where its own first record says as much."""
    mover, step, duration = _Mover(stepper, run), run.step, run.steps * run.step
    for begin, end in pairwise((0.0, *stepper.motion.event_times(duration, step), duration)):
        mover.switch(begin, min(end - begin, step))
        if not mover.go_to(end):
            break
    records, counters = mover.records[: mover.kept], _counts(stepper.counters)
    return compact(stepper.motion, stepper, records, z, run.spacing, mover.message, counters)


def turned(scene: Scene, strips: Any, y: Array, s: int) -> str:
    """At how many degrees the bodies stand that a strip joins, in a state y (Y,)."""
    bodies = [i for i in (strips.roots[s], strips.tips[s]) if 0 <= i < len(scene.bodies)]
    angles = [f"{math.degrees(y[3 * i + 2]):.3g} degrees of {scene.bodies[i].name}" for i in bodies]
    return " and ".join(angles) or "its free end"


def why(counters: NDArray[np.int64], scene: Scene, strips: Any, y: Array, s: int) -> str:
    """Why a step from y (Y,) was given up, by what was counted, and what helps; s: the first to fold."""
    strip, where = scene.strips[s], turned(scene, strips, y, s)
    helps = f"take a shorter step, or more control points than {strip.basis.control_points}"
    if counters[HALVED] > MOST_HALVED + MOST_HALVED_A_STEP * counters[WHOLE]:
        return f"steps at {where} are halved too often; {helps}"
    if counters[REFUSED] == FOLDS:
        return f"{strip.name} folds at {where}; {helps}"
    return f"no step, however short, goes on from {where}, where {strip.name} is nearest to fold; {helps}"


class Moves(ABC):
    """A scene in motion, advanced in compiled steps that are halved at need.

    most_gain: of energy over the run's at which it is stopped; width: numbers of a record, the bodies' poses
    first and the energies last; unit (3,) of a pose [m, rad].
    """

    most_gain = MOST_GAIN
    motion: Motion
    counters: NDArray[np.int64]
    width: int
    unit: Array

    def advance(self, time: float, duration: float, smallest: float) -> float:
        """Advance by a step of ``duration``, halved at need down to ``smallest`` of it; the time done."""
        nothing = np.zeros((0, self.width))
        return duration * self.take(time, duration, 0, 1, 2, duration * smallest, nothing)

    def run(self, step: float, begin: int, end: int, every: int, records: Array) -> int:
        """Take the steps ``begin`` ... ``end`` - 1, filling records (R, W); the next step's number."""
        return self.take(0.0, step, begin, end, every, step * SMALLEST_STEP, records)

    @abstractmethod
    def take(
        self, time: float, step: float, begin: int, end: int, every: int, smallest: float, records: Array
    ) -> int:
        """The same after a time [s], of steps that are halved down to ``smallest`` [s]."""

    @abstractmethod
    def record(self) -> Array:
        """The present state's record (W,)."""

    @abstractmethod
    def unknowns(self, records: Array) -> tuple[Array, Array]:
        """Unknowns (R, N) and velocities (R, Q) of records."""

    @abstractmethod
    def switch(self, time: float, span: float) -> None:
        """Let drives begin, change or end at ``time``; they then hold for at least ``span`` [s]."""

    @abstractmethod
    def reason(self) -> str:
        """Why the last step was given up, and what helps."""


class Stepper(Moves):
    """A scene that the scheme advances; active (D,) is 1 for each drive that holds."""

    def __init__(self, start: Start) -> None:
        self.motion = start.motion
        self.motion.require_compiled("energy")
        self._model = moving(self.motion)
        self.width, self.unit = self._model.width, self._model.unit
        self._state, self._work = self._model.arrays(start.z, start.v, start.acceleration)
        self.counters = np.zeros(6, dtype=np.int64)
        self.active = np.zeros(self.motion.drives.row.size, dtype=np.int64)

    def take(
        self, time: float, step: float, begin: int, end: int, every: int, smallest: float, records: Array
    ) -> int:
        """The next step's number."""
        return int(
            run(
                time, step, begin, end, every, smallest, self.active, self._state, self._model.strips,
                self._model.masses, TOLERANCE, self._work, self.counters, records,
            )
        )  # fmt: skip

    def record(self) -> Array:
        """The present state's record (W,)."""
        record = np.zeros(self.width)
        store(self._state, self._model.strips, self._model.masses, self._work, record)
        return record

    def unknowns(self, records: Array) -> tuple[Array, Array]:
        """Unknowns (R, N) and velocities (R, Q) of records."""
        return self._model.unknowns(records)

    def reason(self) -> str:
        """Why the last step was given up, and what helps."""
        model, own = self._model, self._model.strips.own
        slowest = np.nan_to_num(self._work.at[:, :, 4] / model.strips.speed).min(axis=1)
        if model.strips.lead == 2:
            after = (self._state.y + self._work.dy)[len(model.masses.inertia) :]
            ends = after.reshape(len(slowest), -1)[:, own - 2 : own]
            slowest = np.minimum(slowest, np.nan_to_num(ends).min(axis=1))
        return why(self.counters, model.system.scene, model.strips, self._state.y, int(np.argmin(slowest)))

    def look(self) -> tuple[Array, Array, Array]:
        """Unknowns (1, N), velocities (1, Q) and energies (1, 5) [J] of the present state."""
        record = self.record()[None]
        return *self.unknowns(record), record[:, -ENERGIES:] * self.motion.system.scales.energy

    def switch(self, time: float, span: float) -> None:
        """Let drives begin, change or end at ``time``; they then hold for at least ``span`` [s]."""
        before, self.active = self.active, self.motion.drives_at(time + 0.5 * span)
        if not self.active.any():
            return
        (z,), (v,) = self.unknowns(self.record()[None])
        self.motion = self.motion.from_here(z, self.active, before, time)
        self._model = self._model.with_drives(self.motion)
        v, lost = self.motion.catch(z, v, self.active, time, span)
        self._model.set_velocity(self._state, v)
        if (self.active > before).any():
            self._state.totals[1] += lost / self._model.energy
        else:  # a drive that changes its own rate does work
            self._state.totals[0] -= lost / self._model.energy

    def kept(self) -> list[Array]:
        """Copies of the state's arrays, for ``take_back``."""
        return [array.copy() for array in self._state]

    def take_back(self, kept: list[Array]) -> None:
        """Return to a state that was kept."""
        for array, value in zip(self._state, kept, strict=True):
            array[:] = value


class _Mover:
    """A run and its records on a uniform grid."""

    def __init__(self, stepper: Moves, run: Steps) -> None:
        self.stepper, self.step, self.every = stepper, run.step, run.every
        self.records = np.empty((run.records, stepper.width))
        self.time, self.kept, self.message = 0.0, 0, ""

    def switch(self, time: float, span: float) -> None:
        """As of the stepper; the first record has the drives that hold from the start on."""
        self.stepper.switch(time, span)
        if time == 0.0:
            self._keep(0)

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
        places = slice(begin // self.every + 1, end // self.every + 1)
        done = self.stepper.run(self.step, begin, end, self.every, self.records[places])
        self.kept, self.time = done // self.every + 1, done * self.step
        return self._is_good(done == end)

    def _part_of_step(self, target: float, number: int) -> bool:
        """Advance to ``target``, at most to the end of the step before grid point ``number``."""
        span = target - self.time
        done = self.stepper.advance(self.time, span, SMALLEST_STEP)
        if done == span:
            at_grid = abs(target - number * self.step) <= SAME * self.step
            self.time = number * self.step if at_grid else target
            if at_grid and number % self.every == 0:
                self._keep(number // self.every)
        return self._is_good(done == span)

    def _keep(self, place: int) -> None:
        self.records[place], self.kept = self.stepper.record(), place + 1

    def _is_good(self, solved: bool) -> bool:
        """Whether the run may go on: its steps were solved, and its energy did not grow."""
        most = self.stepper.most_gain
        good = first_gain(self.records[: self.kept, -ENERGIES:], 1.0, most)
        if good < self.kept:
            at = good * self.every * self.step
            self.message = f"stopped at {at:.6g} s: the energy grows by more than {most:g} of itself"
            self.kept = good
        elif not solved:
            self.message = f"stopped at {self.time:.6g} s: {self.stepper.reason()}"
        return not self.message


def _counts(counters: NDArray[np.int64]) -> dict[str, int]:
    """Counters of a run by name."""
    return {
        "steps": int(counters[STEPS]),
        "halved_steps": int(counters[HALVED]),
        "newton_iterations": int(counters[NEWTON]),
        "factorisations": int(counters[FACTORISATIONS]),
    }
