"""Records of a run: rows of energies and of how well the clamps hold, and the watch over gains of energy."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from spline_model.motion.start import Motion

Array = NDArray[np.float64]

KINETIC, STRAIN, POSITION, VELOCITY, WEIGHT, WORK, DISSIPATED = range(7)
"""Places of a record: kinetic and strain energy [J], largest constraint residual [m] and its rate
[m/s], potential of the weight, work of loads and drives so far, energy dissipated so far [J]."""
MOST_GAIN = 1e-6
"""Largest gain of an energy-consistent run over its energy: a million steps stay below."""
MOST_GAIN_OF_OTHERS = 1e-2
"""Largest gain of a run whose scheme keeps energy in the limit of short steps only."""
QUIET = 1e-6
"""Energies below this, in EI/L, are not told from this much: their gain is round-off."""


def rows_of(motion: Motion, z: Array, v: Array, energies: Array) -> Array:
    """Rows (R, 7) of states z (R, N), velocities v (R, Q), and strain energy, work and losses (R, 3) [J]."""
    rows, weight = np.zeros((len(z), 7)), motion.tables.weight
    rows[:, KINETIC] = 0.5 * ((v @ motion.mass) * v).sum(axis=1)
    rows[:, [STRAIN, WORK, DISSIPATED]] = energies
    if weight.size:
        rows[:, WEIGHT] = -z[:, : weight.size] @ weight
    for c in range(len(motion.tables.clamps.end)):
        for place, gap in zip((POSITION, VELOCITY), clamp_gaps(motion, c, z, v), strict=True):
            rows[:, place] = np.maximum(rows[:, place], np.abs(gap).max(axis=0))
    return rows


def clamp_gaps(motion: Motion, c: int, z: Array, v: Array) -> tuple[Array, Array]:
    """Gaps of a clamp's end and of its direction over the end's chord at rest (3, R) [m], and their rates."""
    clamps = motion.tables.clamps
    end, inner, sign, body = clamps.end[c], clamps.inner[c], clamps.sign[c], clamps.body[c]
    pose, rate = (q[:, body : body + 3].T if body >= 0 else np.zeros((3, len(q))) for q in (z, v))
    (p, d), (u, w) = (
        (q[:, end : end + 2].T, sign * (q[:, inner : inner + 2] - q[:, end : end + 2]).T) for q in (z, v)
    )
    (bx, by), direction = clamps.point[c], clamps.direction[c] + pose[2]
    cos, sin, m = np.cos(pose[2]), np.sin(pose[2]), np.array((np.cos(direction), np.sin(direction)))
    arm = np.array((cos * bx - sin * by, sin * bx + cos * by))
    reach = motion.chord[c] / np.hypot(*d)
    turned = rate[2] * np.array((-arm[1], arm[0]))
    position = (*(p - pose[:2] - arm), reach * (m[0] * d[1] - m[1] * d[0]))
    velocity = (*(u - rate[:2] - turned), m[0] * w[1] - m[1] * w[0] - rate[2] * (m * d).sum(axis=0))
    return np.array(position), np.array(velocity)


def energy_gain(rows: Array, unit: float) -> Array:
    """Gain of the balance T + V - work + dissipated at each record over the run's energy, (R,) [1].

    rows (R, 7) as named above; unit EI/L [J]. The energy is the
    largest of the balance's parts so far, so that the gain of a run that starts at rest, or
    about which the weight's arbitrary zero says nothing, has a scale.
    """
    stored = rows[:, KINETIC] + rows[:, STRAIN]
    fallen = rows[:, WEIGHT] - rows[0, WEIGHT]
    balance = stored + fallen - rows[:, WORK] + rows[:, DISSIPATED]
    parts = np.abs(np.stack((stored, fallen, rows[:, WORK], rows[:, DISSIPATED])))
    scale = np.maximum(np.maximum.accumulate(parts.max(axis=0)), QUIET * unit)
    return np.asarray((balance - balance[0]) / scale)


def first_gain(rows: Array, unit: float, most: float) -> int:
    """Number of the first record that has gained more than ``most``, or the number of records."""
    gained = np.flatnonzero(~(energy_gain(rows, unit) <= most))
    return int(gained[0]) if gained.size else len(rows)
