"""The energy monitor: a run that gains energy out of nothing is stopped."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from spline_model.kernels.record import DISSIPATED, KINETIC, STRAIN, WEIGHT, WORK

Array = NDArray[np.float64]

MOST_GAIN = 1e-6
"""Largest gain of an energy-consistent run over its energy: a million steps stay below."""
MOST_GAIN_OF_OTHERS = 1e-2
"""Largest gain of a run whose scheme keeps energy in the limit of short steps only."""


QUIET = 1e-6
"""Energies below this, in EI/L, are not told from this much: their gain is round-off."""


def energy_gain(rows: Array, unit: float) -> Array:
    """Gain of the balance T + V - work + dissipated at each record over the run's energy, (R,) [1].

    rows (R, 7) as named in ``spline_model.kernels.record``; unit EI/L [J]. The energy is the
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
