"""The frequency of a swing about its rest: of its passages, ripples not counted."""

import math
from dataclasses import dataclass

import numpy as np

from studies.kinds import Array

#: A passage leads from so far beyond the rest on one side to as far on the other, as a part of the swing's
#: mean amplitude: a ripple of less does not count.
BAND = 0.4
#: Half swings to both sides that last alike within this are those of a symmetric swing.
ALIKE = 2e-3
#: Turning points to both sides that are as far from zero within this part of their distance are those of a
#: symmetric swing, where a half swing is all there is.
AS_FAR = 2e-2
#: Rounds in which the rest is looked for, and the change of it, over the amplitude, that ends them.
ROUNDS, SETTLED = 30, 1e-9
#: Largest amplitude that is none [rad or m]: motions are solved to 1e-11.
STILL = 1e-10


@dataclass(frozen=True, kw_only=True)
class Frequency:
    """Frequency of a swing [Hz], or NaN with the reason; rest: that it swings about, in its own unit."""

    value: float
    reason: str = ""
    rest: float = math.nan


def swing_frequency(time: Array, value: Array) -> Frequency:
    """Return the mean frequency of the swing of `value` (T,) over the instants `time` (T,) [s].

    A swing that is symmetric about zero is counted by its half swings from the first to the last passage
    through zero, f = (N - 1) / (2 (t_N - t_1)) with N passages. Any other has its mean over whole swings as
    its rest, and is counted by whole swings between passages through it in either direction. A passage on
    which ripples cross the rest several times is at the mean of their instants. Interpolation between records
    is linear, exact to third order in their distance.

    NaN, with the reason, with fewer than three passages, which are not a whole swing; two are enough for a
    swing that turns as far to both sides of zero.
    """
    if not len(time) or float(np.ptp(value)) <= STILL:
        return Frequency(value=math.nan, reason="nothing swings")
    instants = passages(time, value, 0.0)
    if len(instants) >= 2 and _symmetric(value, instants):
        return Frequency(value=(len(instants) - 1) / (2.0 * float(instants[-1] - instants[0])), rest=0.0)
    rest = _rest(time, value)
    instants = passages(time, value, rest)
    if len(instants) < 3:
        count = f"{len(instants)} passage{'s' if len(instants) != 1 else ''}"
        lasted = f"{float(time[-1] - time[0]):.3g} s"
        return Frequency(value=math.nan, reason=f"{count} through the rest in {lasted}: not a whole swing")
    last = len(instants) - 1
    whole = [(first, first + (last - first) // 2 * 2) for first in (0, 1) if last - first >= 2]
    swings = sum(b - a for a, b in whole) // 2
    return Frequency(value=swings / sum(float(instants[b] - instants[a]) for a, b in whole), rest=rest)


def passages(time: Array, value: Array, rest: float) -> Array:
    """Return the instants (N,) at which `value` passes the rest from one side of the band to the other."""
    apart = value - rest
    band = BAND * math.sqrt(2.0) * float(np.std(value))
    outside = np.flatnonzero(np.abs(apart) > band)
    changes = np.flatnonzero(np.diff(np.sign(apart[outside])))
    crossings = np.flatnonzero(np.signbit(apart[:-1]) != np.signbit(apart[1:]))
    exact = time[crossings] - apart[crossings] * np.diff(time)[crossings] / np.diff(apart)[crossings]
    begin = np.searchsorted(crossings, outside[changes])
    end = np.searchsorted(crossings, outside[changes + 1])
    return np.array([exact[a:b].mean() for a, b in zip(begin, end, strict=True)])


def _symmetric(value: Array, instants: Array) -> bool:
    """Whether half swings to one side of zero last as long as those to the other, or reach as far."""
    if len(instants) == 2:
        return bool(abs(value.max() + value.min()) <= AS_FAR * np.ptp(value))
    halves = np.diff(instants)
    return bool(abs(halves[::2].mean() - halves[1::2].mean()) <= ALIKE * halves.mean())


def _rest(time: Array, value: Array) -> float:
    """Return the mean of the whole swings about itself; that of the record where there is none."""
    rest = float(np.mean(value))
    for _ in range(ROUNDS):
        instants = passages(time, value, rest)
        last = (len(instants) - 1) // 2 * 2
        if last < 2:
            return rest
        inside = (time > instants[0]) & (time < instants[last])
        at = np.concatenate(([instants[0]], time[inside], [instants[last]]))
        mean = float(np.trapezoid(np.interp(at, time, value), at) / (at[-1] - at[0]))
        if abs(mean - rest) <= SETTLED * float(np.ptp(value)):
            return mean
        rest = mean
    return rest
