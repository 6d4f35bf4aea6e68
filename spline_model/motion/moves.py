"""How a motion is carried through a run: whole steps, parts of those that fail, events, and its records."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from functools import partial
from itertools import pairwise
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from spline_model.errors import InvalidParameter, require_count
from spline_model.motion.records import (
    DISSIPATED,
    ENERGIES,
    KINETIC,
    MOST_GAIN,
    STRAIN,
    WEIGHT,
    WORK,
    Trajectory,
    first_gain,
)
from spline_model.motion.start import SAME, Array, Motion
from spline_model.motion.step import HALVED, WHOLE
from spline_model.newton import Laps
from spline_model.solution import Status

STEP = 5e-5
"""Default step [s]: some 240 steps a swing of Table 1."""
SMALLEST_STEP = 2.0**-14
"""Least fraction of a step before the run is given up."""
MOST_HALVED, MOST_HALVED_A_STEP = 500, 150
"""A run is given up when it has been halved more often than this, and this for every step done: the
swing of Table 1 at steps of its own period takes 120 a step; without a bound a step may take minutes."""
MOST_MEMORY = 2e9
"""Bytes that the records of one run may take."""


class Steps(NamedTuple):
    """Steps of a run: their length [s] and number, and every which is recorded, which divides the number."""

    step: float
    steps: int
    every: int

    @classmethod
    def of(cls, duration: float, step: float, records: int | None, width: int) -> Steps:
        """Return the steps of a duration [s], for at most so many records of ``width`` numbers each.

        step [s]: the longest one. Raises InvalidParameter for a step longer than the duration, and for
        records that do not fit into MOST_MEMORY.
        """
        if step > duration:
            raise InvalidParameter("step", step, f"at most the duration, {duration:g} s")
        if records is not None:
            require_count("records", records, 1)
        steps = max(1, math.ceil(duration / step * (1 - 1e-12)))  # a whole number but for round-off
        every = 1 if records is None else max(1, math.ceil(steps / records))
        memory = 8.0 * width * (steps // every + 1)
        if memory > MOST_MEMORY:
            raise InvalidParameter(
                "duration",
                duration,
                f"records within {MOST_MEMORY / 1e9:g} GB; {steps} steps of {step:g} s take "
                f"{memory / 1e9:.3g} GB: keep fewer of them with records, or take a longer step",
            )
        steps = math.ceil(steps / every) * every
        return cls(duration / steps, steps, every)


class Moves:
    """A scene in motion, advanced in steps that are halved at need.

    name: of the scheme, settings: others that a trajectory has; state: arrays that a step changes.
    most_gain: of energy; smallest: part of a step that is taken at least where it fails, 1 if none is;
    counts: names of the leading counters; width: numbers of a record, of which the first are the poses in L
    and the last the energies in EI/L.
    """

    most_gain = MOST_GAIN
    smallest = SMALLEST_STEP
    counts: tuple[str, ...] = ("steps", "halved_steps", "newton_iterations", "factorisations")
    name: str
    settings: Mapping[str, Any] = MappingProxyType({})
    state: Any
    motion: Motion
    counters: NDArray[np.int64]
    width: int

    def default_step(self) -> float:
        """Return the step [s] where none is given."""
        return STEP

    def kept(self) -> list[Array]:
        """Return copies of the state's arrays, in their units and shapes, for ``take_back``."""
        return [array.copy() for array in self.state]

    def take_back(self, kept: list[Array]) -> None:
        """Return to a state that was kept: arrays in the order, units and shapes of ``kept``."""
        for array, value in zip(self.state, kept, strict=True):
            array[:] = value

    def take(self, time: float, step: float, begin: int, end: int, every: int, records: Array) -> int:
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
                if not self._take_parts(time + number * step, step, mine):
                    break
                self.counters[WHOLE] += 1
                number += 1
        return number

    def _take_parts(self, time: float, step: float, record: Array) -> bool:
        """Take a step that failed: halved, down to its smallest part, and doubled again after each success.

        record (1, W), or (0, W) where none is wanted: filled at its end.
        """
        if self.smallest == 1.0:
            return False
        done, h, counters = 0.0, 0.5 * step, self.counters
        counters[HALVED] += 1
        while step - done > SAME * step:
            most = MOST_HALVED + MOST_HALVED_A_STEP * counters[WHOLE]
            if h < self.smallest * step or counters[HALVED] > most:
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
        """Take whole steps of length ``step`` [s] from the instant ``time`` [s] on.

        begin, end: numbers of the steps; every: which of them are written to ``records`` (R, W). Returns the
        number of the first step that fails, at whose begin all is left, or end.
        """
        raise NotImplementedError

    def record(self) -> Array:
        """Return the present state's record (W,), in the units of the scheme."""
        raise NotImplementedError

    def unknowns(self, records: Array) -> tuple[Array, Array]:
        """Return unknowns (R, N) [m, rad, N] and velocities (R, Q) [m/s, rad/s] of records (R, W)."""
        raise NotImplementedError

    def shown(self, records: Array) -> tuple[Array, Array]:
        """Return poses (R, 3 B) of the bodies [m, rad] and rows (R, 5) of energies [J] of records (R, W)."""
        scales, bodies = self.motion.system.scales, len(self.motion.system.layout.bodies)
        poses = records[:, : 3 * bodies] * np.tile(scales.pose, bodies)
        return poses, records[:, -ENERGIES:] * scales.energy

    def counted(self, steps: int) -> dict[str, int]:
        """Return the counted iterations by name; steps: of the good records."""
        return dict(zip(self.counts, self.counters.tolist(), strict=False))

    def look(self) -> tuple[Array, Array, Array]:
        """Return unknowns (1, N), velocities (1, Q) and energies (1, 5) [J] of the present state."""
        record = self.record()[None]
        return *self.unknowns(record), self.shown(record)[1]

    def switch(self, time: float, span: float) -> None:
        """Let drives begin, change or end at ``time``; they then hold for at least ``span`` [s]."""

    def stopped(self, record: float, reached: float, *, grows: bool) -> str:
        """Return why the run stopped.

        record: when the first one is due that is not good [s]; reached: instant reached [s]; grows: whether
        its energy grows.
        """
        if grows:
            return f"stopped at {record:.6g} s: the energy grows by more than {self.most_gain:g} of itself"
        return f"stopped at {reached:.6g} s: {self.reason()}"

    def reason(self) -> str:
        """Why the last step was given up, and what helps."""
        raise NotImplementedError


def carry(stepper: Moves, run: Steps, *, laps: Laps, settings: dict[str, Any], **known: Any) -> Trajectory:
    """Return the trajectory of a run; one whose balance of energies gains too much ends with the last good
    record.

    A run that says why it stopped has not converged. laps: a stopwatch; known: other fields.
    """
    records = np.empty((run.steps // run.every + 1, stepper.width))
    kept, message = _fill(stepper, run, records)
    laps.lap("solve")
    poses, rows = stepper.shown(records[:kept])
    system = stepper.motion.system
    points = max((strip.basis.control_points for strip in system.scene.strips), default=0)
    segments = max((len(pieces) for pieces in system.scene.whole.values()), default=1)
    return Trajectory(
        status=Status.NOT_CONVERGED if message else Status.CONVERGED,
        message=message,
        time=np.arange(0.0, kept) * run.step * run.every,
        bodies={b.name: poses[:, 3 * i : 3 * i + 3] for i, b in enumerate(system.scene.own_bodies)},
        kinetic_energy=rows[:, KINETIC],
        strain_energy=rows[:, STRAIN],
        gravity_energy=rows[:, WEIGHT] + float(system.weight @ system.rest[: system.weight.size]),
        work=rows[:, WORK],
        dissipated=rows[:, DISSIPATED],
        motion=stepper.motion,
        make=partial(stepper.unknowns, records[:kept]),
        counters=stepper.counted((kept - 1) * run.every),
        settings={"segments": segments, "control_points": points} | settings,
        seconds=laps.lap("recover"),
        **known,
    )


def _fill(stepper: Moves, run: Steps, records: Array) -> tuple[int, str]:
    """Fill the records (R, W) of a run; returns how many are good, and why it stopped, if it did."""
    duration, kept = run.steps * run.step, 1
    energy = stepper.motion.system.scales.energy
    for begin, end in pairwise((0.0, *stepper.motion.event_times(duration, run.step), duration)):
        stepper.switch(begin, min(end - begin, run.step))
        if begin == 0.0:  # with the drives that hold from the start on
            records[0] = stepper.record()
        for time, step, first, last, every in _pieces(begin, end, run):
            done = stepper.take(
                time, step, first, last, every, records[first // every + 1 : last // every + 1]
            )
            kept = max(kept, done // every + 1)
            good = first_gain(stepper.shown(records[:kept])[1], energy, stepper.most_gain)
            if good < kept or done < last:
                due, reached = good * run.every * run.step, time + done * step
                return good, stepper.stopped(due, reached, grows=good < kept)
    return kept, ""


def _pieces(begin: float, end: float, run: Steps) -> Iterator[tuple[float, float, int, int, int]]:
    """The way from one instant to another [s], as arguments of ``Moves.take``.

    It is whole steps, and parts of steps before and behind them, which are none of the records where they end
    inside a step.
    """
    time, close = begin, SAME * run.step
    while end - time > close:
        number, last = (math.floor((instant + close) / run.step) for instant in (time, end))
        if last > number and abs(time - number * run.step) <= close:
            yield 0.0, run.step, number, last, run.every
            time = last * run.step
        else:
            grid = (number + 1) * run.step
            to, every = (grid, run.every) if end > grid - close else (end, run.steps + 1)
            yield time - number * (to - time), to - time, number, number + 1, every
            time = to
