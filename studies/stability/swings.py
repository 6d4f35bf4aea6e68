"""Motions of hard cases: the swing of each model against a refined and an independent one."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline

from studies.answers.adapters import answer_release
from studies.answers.motion import Motion
from studies.answers.settings import FeSettings, Settings, SplineSettings
from studies.cases.design import Design
from studies.stability import family

#: Largest error of the rotation that counts as right, over the rotation at the start [1]. A step of a
#: twentieth of the swing's period errs by 0.03 after one swing; an answer off by more shows another motion.
TOLERANCE = 0.05
#: Largest gain of energy over that at the start: of the energy-consistent scheme, and of those that keep
#: energy in the limit of short steps only.
MOST_GAIN, MOST_GAIN_OF_OTHERS = 1e-8, 1e-2

#: The refined spline, the step of its motion [s] for the time scale of Table 1, and finite elements.
REFINED, REFINED_STEP = SplineSettings(control_points=9), 2.5e-6
INDEPENDENT = FeSettings(elements=30)
RECORDS = 400


@dataclass(frozen=True, kw_only=True)
class _Swinging:
    """A column of a family of motions: settings, integrator; none for the one that keeps energy exactly."""

    settings: Settings
    integrator: str | None = None

    @property
    def most_gain(self) -> float:
        """Largest gain of energy that is none [1]."""
        return MOST_GAIN_OF_OTHERS if self.integrator else MOST_GAIN


def _swinging(column: str, integrator: str | None = None) -> _Swinging:
    return _Swinging(settings=family.COLUMNS[column], integrator=integrator)


#: Column -> how it is let go. The paper's printed forces have no energy that a motion could keep.
SWINGING: dict[str, _Swinging] = {
    **{name: _swinging(name) for name in (family.DEFAULT, family.LOCKING_FREE, family.PAPER)},
    family.GENERALISED_ALPHA: _swinging(family.DEFAULT, "generalised-alpha"),
    family.EXPLICIT: _swinging(family.DEFAULT, "explicit"),
    family.FE: _swinging(family.FE, "generalised-alpha"),
}


def refined_swing(design: Design, *, start: float, duration: float, step: float = REFINED_STEP) -> Motion:
    """Return the swing that others are held against."""
    return answer_release(design, REFINED, start=start, duration=duration, step=step, records=RECORDS)


def rotation_error(motion: Motion, reference: Motion) -> float:
    """Return the largest difference of rotation at the motion's records, as far as the reference goes [1].

    Over the rotation at the start. Infinite for a motion without a record or with one that is no number.
    """
    if not len(motion.time) or len(reference.time) < 2 or not np.isfinite(motion.rotation).all():
        return math.inf
    known = motion.time <= reference.time[-1] * (1.0 + 1e-9)
    expected = CubicSpline(reference.time, reference.rotation)(motion.time[known])
    return float(np.abs(motion.rotation[known] - expected).max() / abs(reference.rotation[0]))


def _energy_gain(motion: Motion) -> float:
    """Return the largest gain of the balance of energies over the stored one at the start [1]; NaN without
    a record."""
    stored = motion.kinetic_energy + motion.strain_energy
    balance = stored + motion.gravity_energy - motion.work + motion.dissipated
    return float((balance / balance[0] - 1.0).max()) if len(balance) else math.nan


def _compared(motion: Motion, reference: Motion, *, most_gain: float, checked: bool) -> family.Found:
    """Return a motion against the reference; without `checked`, as if it said nothing of itself."""
    if not len(motion.time):  # statics does not reach the start
        return family.Found(error=0.0, reached=False, reason=motion.message, counters=motion.counters)
    gain = _energy_gain(motion)
    fault = f"the energy grows by {gain:.2g} of itself" if gain > most_gain else ""
    return family.said(motion, rotation_error(motion, reference), checked=checked, fault=fault)


def judged_swing(
    name: str, design: Design, reference: Motion, *, start: float, duration: float, step: float
) -> dict[str, Any]:
    """Return the verdict on the column `name` for one design and step, with its energy_gain [1]."""
    column, gains = SWINGING[name], [math.nan]

    def attempt() -> family.Found:
        motion = answer_release(
            design, column.settings, start=start, duration=duration, step=step, records=RECORDS,
            integrator=column.integrator,
        )  # fmt: skip
        gains.append(_energy_gain(motion))
        return _compared(motion, reference, most_gain=column.most_gain, checked=name not in family.UNCHECKED)

    return {**family.judged(attempt, TOLERANCE), "energy_gain": gains[-1]}
