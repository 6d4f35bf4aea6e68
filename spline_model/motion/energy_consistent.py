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
from collections.abc import Iterator
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from spline_model.motion.mechanism import Moving
from spline_model.motion.records import ENERGIES, MOST_GAIN, Records, compact, first_gain
from spline_model.motion.run import run, store
from spline_model.motion.start import SAME, Array, Motion, Start, Steps
from spline_model.motion.step import FACTORISATIONS, FOLDS, HALVED, NEWTON, REFUSED, STEPS, WHOLE
from spline_model.scene import Scene

TOLERANCE = 1e-11
"""Residual of a step, in EI/L^2, EI/L, L and rad; the energy of a step is exact to this."""
SMALLEST_STEP = 2.0**-14
"""Least fraction of a step before the run is given up."""
MOST_HALVED, MOST_HALVED_A_STEP = 500, 150
"""A run is given up when it has been halved more often than this, and this for every step done: the
swing of Table 1 at steps of its own period takes 120 a step; without a bound a step may take minutes."""
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
    records = np.empty((run.records, stepper.width))
    kept, message = _fill(stepper, run, records)
    places = {"steps": STEPS, "halved_steps": HALVED, "newton_iterations": NEWTON}
    places["factorisations"] = FACTORISATIONS
    counters = {name: int(stepper.counters[place]) for name, place in places.items()}
    return compact(stepper.motion, stepper.unknowns, records[:kept], z, run.spacing, message, counters)


def _fill(stepper: Moves, run: Steps, records: Array) -> tuple[int, str]:
    """Fill the records (R, W) of a run; returns how many are good, and why it stopped, if it did."""
    step, every, duration, kept = run.step, run.every, run.steps * run.step, 0
    for begin, end in pairwise((0.0, *stepper.motion.event_times(duration, step), duration)):
        stepper.switch(begin, min(end - begin, step))
        if begin == 0.0:  # with the drives that hold from the start on
            records[0], kept = stepper.record(), 1
        for time, to, number, last in _pieces(begin, end, run):
            if last > number:
                places = slice(number // every + 1, last // every + 1)
                done = stepper.take(0.0, step, number, last, every, step * SMALLEST_STEP, records[places])
                solved, reached, kept = done == last, done * step, done // every + 1
            else:
                solved, reached = stepper.advance(time, to - time, SMALLEST_STEP) == to - time, time
                if solved and to == last * step and last % every == 0:
                    records[last // every], kept = stepper.record(), last // every + 1
            good = first_gain(records[:kept, -ENERGIES:], 1.0, stepper.most_gain)
            if good < kept:
                most = f"more than {stepper.most_gain:g} of itself"
                return good, f"stopped at {good * every * step:.6g} s: the energy grows by {most}"
            if not solved:
                return kept, f"stopped at {reached:.6g} s: {stepper.reason()}"
    return kept, ""


def _pieces(begin: float, end: float, run: Steps) -> Iterator[tuple[float, float, int, int]]:
    """The way from one instant to another [s]: from, to, and the first and last step's end of whole steps.

    These are as many as are run before the energy is looked at; of a part of a step, which ends in the last
    one or before it, both are the same.
    """
    time, step, watched = begin, run.step, max(1, WATCHED // run.every) * run.every
    close = SAME * step
    while end - time > close:
        number, last = (math.floor((instant + close) / step) for instant in (time, end))
        if last > number and abs(time - number * step) <= close:
            last = min(last, number + watched - number % run.every)
            to = last * step
        else:
            number = last = number + 1
            to = last * step if end > last * step - close else end
        yield time, to, number, last
        time = to


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


class Moves:
    """A scene in motion, advanced in steps that are halved at need.

    width: numbers of a record.
    """

    most_gain = MOST_GAIN
    motion: Motion
    counters: NDArray[np.int64]
    width: int

    def advance(self, time: float, duration: float, smallest: float) -> float:
        """Advance by a step of ``duration``, halved at need down to ``smallest`` of it; the time done."""
        nothing = np.zeros((0, self.width))
        return duration * self.take(time, duration, 0, 1, 2, duration * smallest, nothing)

    def take(
        self, time: float, step: float, begin: int, end: int, every: int, smallest: float, records: Array
    ) -> int:
        """Take the steps ``begin`` ... ``end`` - 1 after a time [s], filling records (R, W).

        One that fails is taken in parts. Returns the number of the first that cannot be, or end.
        """
        number, first = begin, begin // every
        while number < end:
            done = self.steps(time, step, number, end, every, records[number // every - first :])
            self.counters[WHOLE] += done - number
            number = done
            if number < end:
                last = (number + 1) // every - first
                mine = records[last - 1 : last] if (number + 1) % every == 0 else records[:0]
                if not self._take_parts(time + number * step, step, smallest, mine):
                    break
                self.counters[WHOLE] += 1
                number += 1
        return number

    def _take_parts(self, time: float, step: float, smallest: float, record: Array) -> bool:
        """Take a step that failed: halved, down to ``smallest`` [s], and doubled again after each success.

        record (1, W), or (0, W) where none is wanted: filled at its end.
        """
        done, h, counters = 0.0, 0.5 * step, self.counters
        counters[HALVED] += 1
        while step - done > SAME * step:
            if h < smallest or counters[HALVED] > MOST_HALVED + MOST_HALVED_A_STEP * counters[WHOLE]:
                return False
            h = min(h, step - done)
            wanted = len(record) > 0 and not step - (done + h) > SAME * step
            if self.steps(time + done, h, 0, 1, 1 if wanted else 2, record) == 1:
                done, h = done + h, min(2.0 * h, step)
            else:
                counters[HALVED] += 1
                h *= 0.5
        return True

    def steps(self, time: float, step: float, begin: int, end: int, every: int, records: Array) -> int:
        """Take whole steps; the number of the first that fails, at whose begin all is left, or end."""
        raise NotImplementedError

    def record(self) -> Array:
        """The present state's record (W,)."""
        raise NotImplementedError

    def unknowns(self, records: Array) -> tuple[Array, Array]:
        """Unknowns (R, N) and velocities (R, Q) of records."""
        raise NotImplementedError

    def switch(self, time: float, span: float) -> None:
        """Let drives begin, change or end at ``time``; they then hold for at least ``span`` [s]."""

    def reason(self) -> str:
        """Why the last step was given up, and what helps."""
        raise NotImplementedError


class Stepper(Moves):
    """A scene that the scheme advances; active (D,) is 1 for each drive that holds."""

    def __init__(self, start: Start) -> None:
        self.motion = start.motion
        self.motion.require_compiled("energy")
        self._model = Moving.of(self.motion)
        self.width = self._model.width
        self._state, self._work = self._model.arrays(start.z, start.v, start.acceleration)
        self.counters = np.zeros(6, dtype=np.int64)
        self.active = np.zeros(self.motion.drives.row.size, dtype=np.int64)

    def steps(self, time: float, step: float, begin: int, end: int, every: int, records: Array) -> int:
        """The number of the first step that fails."""
        model, asked = self._model, (time, step, begin, end, every, self.active)
        given = self._state, model.strips, model.masses, TOLERANCE, self._work, self.counters
        return int(run(*asked, *given, records))

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
        lost /= self.motion.system.scales.energy
        if (self.active > before).any():
            self._state.totals[1] += lost
        else:  # a drive that changes its own rate does work
            self._state.totals[0] -= lost

    def kept(self) -> list[Array]:
        """Copies of the state's arrays, for ``take_back``."""
        return [array.copy() for array in self._state]

    def take_back(self, kept: list[Array]) -> None:
        """Return to a state that was kept."""
        for array, value in zip(self._state, kept, strict=True):
            array[:] = value
