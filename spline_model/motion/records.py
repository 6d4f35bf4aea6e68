"""Records of a run: energies, states and how well the clamps hold, and the watch over gains of energy."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from spline_model.motion.start import Motion
from spline_model.tables import YIELDING

Array = NDArray[np.float64]

KINETIC, WEIGHT, STRAIN, WORK, DISSIPATED = range(5)
"""Places of a row: kinetic energy, potential of the weight, strain energy, work of loads and drives so far,
energy dissipated so far [J]."""
ENERGIES = 5
"""Length of a row: the last numbers of a compiled run's record, there in EI/L."""
MOST_GAIN = 1e-6
"""Largest gain of an energy-consistent run over its energy: a million steps stay below."""
MOST_GAIN_OF_OTHERS = 1e-2
"""Largest gain of a run whose scheme keeps energy in the limit of short steps only."""
QUIET = 1e-6
"""Energies below this, in EI/L, are not told from this much: their gain is round-off."""


@dataclass(frozen=True, eq=False)
class Whole:
    """All that R records say, made when it is first asked for.

    make: unknowns z (R, N) and velocities v (R, Q); every: which of them are kept.
    """

    motion: Motion
    make: Callable[[], Sequence[Array]]
    every: int = 1

    def thinned(self, every: int) -> Whole:
        """Every so many of the records, from the first on."""
        return Whole(self.motion, self.make, every * self.every)

    @cached_property
    def both(self) -> tuple[Array, Array]:
        """z (R, N) and v (R, Q)."""
        z, v = self.make()
        return z[:: self.every], v[:: self.every]

    @cached_property
    def gaps(self) -> Array:
        """Largest constraint residual [m] and its rate [m/s] at each record, (R, 2)."""
        z, v = self.both
        largest = np.zeros((len(z), 2))
        for c in range(len(self.motion.system.tables.clamps.end)):
            for k, gap in enumerate(_clamp_gaps(self.motion, c, z, v)):
                largest[:, k] = np.maximum(largest[:, k], np.abs(gap).max(axis=0))
        return largest


@dataclass(frozen=True, kw_only=True, eq=False)
class Records:
    """R records of a run, the start first.

    time (R,) [s]; poses (R, 3 B) of the bodies [m, rad]; rows (R, 5) as named above; message: empty,
    or why the run stopped.
    """

    time: Array
    poses: Array
    rows: Array
    whole: Whole
    message: str
    counters: dict[str, int]


def records_of(
    motion: Motion,
    spacing: float,
    z: Array,
    v: Array,
    energies: Array,
    message: str,
    counters: dict[str, int],
) -> Records:
    """The records ``spacing`` [s] apart of a run that kept its states z (R, N) and v (R, Q); energies as of
    ``rows_of``."""
    return Records(
        time=np.arange(0.0, len(z)) * spacing,
        poses=z[:, motion.system.layout.poses],
        rows=rows_of(motion, z, v, energies),
        whole=Whole(motion, partial(tuple, (z, v))),
        message=message,
        counters=counters,
    )


class _Reader(Protocol):
    """Who knows the numbers of a compiled run's records: the bodies' poses first, the energies last."""

    @property
    def unit(self) -> Array:
        """Of a pose (3,) [m, rad]."""

    def unknowns(self, records: Array) -> tuple[Array, Array]:
        """Unknowns (R, N) and velocities (R, Q) of records (R, W)."""


def compact(
    motion: Motion,
    reader: _Reader,
    records: Array,
    z: Array | None,
    spacing: float,
    message: str,
    counters: dict[str, int],
) -> Records:
    """The records (R, W) of a compiled run, ``spacing`` [s] apart, read as far as every answer needs.

    z (N,): all unknowns of the first one; None where the record says as much.
    """
    bodies = len(motion.turns)
    return Records(
        time=np.arange(0.0, len(records)) * spacing,
        poses=records[:, : 3 * bodies] * np.tile(reader.unit, bodies),
        rows=records[:, -ENERGIES:] * motion.system.scales.energy,
        whole=Whole(motion, partial(_read, reader, records, z)),
        message=message,
        counters=counters,
    )


def _read(reader: _Reader, records: Array, z: Array | None) -> tuple[Array, Array]:
    states, rates = reader.unknowns(records)
    if z is not None:
        states[0] = z
    return states, rates


def rows_of(motion: Motion, z: Array, v: Array, energies: Array) -> Array:
    """Rows (R, 5) of states z (R, N), velocities v (R, Q), and strain energy, work and losses (R, 3) [J]."""
    rows, weight = np.zeros((len(z), ENERGIES)), motion.system.weight
    rows[:, KINETIC] = 0.5 * ((v @ motion.mass) * v).sum(axis=1)
    rows[:, [STRAIN, WORK, DISSIPATED]] = energies
    if weight.size:
        rows[:, WEIGHT] = -z[:, : weight.size] @ weight
    return rows


def _clamp_gaps(motion: Motion, c: int, z: Array, v: Array) -> tuple[Array, Array]:
    """Gaps of a clamp's end and of its direction over the end's chord at rest (3, R) [m], and their rates.

    Of a root that turns those of its end alone (2, R).
    """
    clamps = motion.system.tables.clamps
    end, inner, sign, body = clamps.end[c], clamps.inner[c], clamps.sign[c], clamps.body[c]
    pose, rate = (q[:, body : body + 3].T if body >= 0 else np.zeros((3, len(q))) for q in (z, v))
    (p, d), (u, w) = (
        (q[:, end : end + 2].T, sign * (q[:, inner : inner + 2] - q[:, end : end + 2]).T) for q in (z, v)
    )
    (bx, by), direction = clamps.point[c], clamps.direction[c] + pose[2]
    cos, sin, m = np.cos(pose[2]), np.sin(pose[2]), np.array((np.cos(direction), np.sin(direction)))
    arm = np.array((cos * bx - sin * by, sin * bx + cos * by))
    rest = motion.system.rest
    reach = np.hypot(*(rest[inner : inner + 2] - rest[end : end + 2])) / np.hypot(*d)
    turned = rate[2] * np.array((-arm[1], arm[0]))
    position = (*(p - pose[:2] - arm), reach * (m[0] * d[1] - m[1] * d[0]))
    velocity = (*(u - rate[:2] - turned), m[0] * w[1] - m[1] * w[0] - rate[2] * (m * d).sum(axis=0))
    if clamps.numbers[c, YIELDING] > 0.0:  # a root turns
        position, velocity = position[:2], velocity[:2]
    return np.array(position), np.array(velocity)


def energy_gain(rows: Array, unit: float) -> Array:
    """Gain of the balance T + V - work + dissipated at each record over the run's energy, (R,) [1].

    rows (R, 5) as named above; unit: EI/L in them. The energy is the
    largest of the balance's parts so far, so that the gain of a run that starts at rest, or
    about which the weight's arbitrary zero says nothing, has a scale.
    """
    stored = rows[:, KINETIC] + rows[:, STRAIN]
    fallen = rows[:, WEIGHT] - rows[0, WEIGHT]
    balance = stored + fallen - rows[:, WORK] + rows[:, DISSIPATED]
    largest = np.maximum(np.abs(stored), np.abs(fallen))
    for k in (WORK, DISSIPATED):
        largest = np.maximum(largest, np.abs(rows[:, k]))
    scale = np.maximum(np.maximum.accumulate(largest), QUIET * unit)
    return np.asarray((balance - balance[0]) / scale)


def first_gain(rows: Array, unit: float, most: float) -> int:
    """Number of the first record that has gained more than ``most``, or the number of records."""
    gained = np.flatnonzero(~(energy_gain(rows, unit) <= most))
    return int(gained[0]) if gained.size else len(rows)
