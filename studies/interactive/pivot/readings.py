"""What holds the body, as it is read off: averaged while it stands still, with its spread."""

from collections import deque

import numpy as np

from studies.interactive.pivot.mechanics import Mechanics, Snapshot
from studies.kinds import Array

#: Readings that are averaged while they agree, within so many standard deviations.
MOST, AGREE = 10, 3.0


class Readings:
    """Force, moment and stiffness (4,), averaged over the last frames that agree.

    sd (3,): standard deviation of the pose; force_sd (4,): of one reading; None where none is said.
    """

    def __init__(self) -> None:
        self.sd: Array | None = None
        self.force_sd: Array | None = None
        self._last: deque[Array] = deque(maxlen=MOST)

    def take(self, mechanics: Mechanics, pose: Array | None) -> None:
        """Take the reading of this instant, and its spread to first order, the sum of the independent columns
        of `pose` (3, k); None where nothing is said of it."""
        now = mechanics.snapshot
        if pose is None or now.tangent is None:
            self.sd = self.force_sd = None
            self._last.clear()
            return
        self.sd = np.linalg.norm(pose, axis=1)
        force = np.linalg.norm(now.tangent @ pose, axis=1)
        self.force_sd = np.append(force, mechanics.stiffness_spread(pose))
        self._last.append(reading(now))

    def mean(self, now: Snapshot) -> Array:
        """Return the reading, the mean of those up to this one that agree with it."""
        if self.force_sd is None:
            return reading(now)
        last = np.array(self._last)
        odd = np.flatnonzero((np.abs(last - last[-1]) > AGREE * self.force_sd).any(axis=1))
        return np.asarray(last[odd[-1] + 1 if len(odd) else 0 :].mean(axis=0))


def reading(now: Snapshot) -> Array:
    """Return force, moment and stiffness (4,) of an instant."""
    return np.append(now.force, np.nan if now.stiffness is None else now.stiffness)
