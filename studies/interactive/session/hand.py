"""The hand that holds the body: its last poses, its velocity, and jumps that no hand makes."""

import math
from collections import deque

import numpy as np

from studies.kinds import Array

#: A camera's pose that lies farther from the last one, for each frame's time since, waits for a second one
#: that agrees [m, rad, s].
JUMP_SHIFT, JUMP_TURN, FRAME = 0.025, math.radians(15), 0.04
#: Poses that the velocity is taken from.
POSES = 5


class Hand:
    """Poses (3,) with their times [s], the newest last."""

    def __init__(self) -> None:
        self._poses: deque[tuple[float, Array]] = deque(maxlen=POSES)
        self._odd: Array | None = None

    def add(self, time: float, pose: Array) -> None:
        """The hand is at `pose`."""
        self._poses.append((time, pose))

    def forget(self) -> None:
        """The hand begins anew: its next pose is no jump."""
        self._poses.clear()
        self._odd = None

    def believes(self, time: float, pose: Array) -> bool:
        """Whether a pose may be taken: as near the last one as a hand moves in that time, or seen twice."""
        known, self._odd = self._odd, None
        if not self._poses or (known is not None and _close(pose, known, 1.0)):
            return True
        last, before = self._poses[-1]
        if _close(pose, before, max(1.0, (time - last) / FRAME)):
            return True
        self._odd = pose
        return False

    @property
    def velocity(self) -> Array:
        """Slope (3,) of the last poses [m/s, rad/s], zero where there are none at different times."""
        times = np.array([time for time, _ in self._poses])
        if len(times) < 2 or np.ptp(times) == 0.0:
            return np.zeros(3)
        poses = np.array([pose for _, pose in self._poses])
        return np.asarray(np.polyfit(times - times.mean(), poses, 1)[0])


def _close(pose: Array, other: Array, frames: float) -> bool:
    shift, turn = math.hypot(*(pose[:2] - other[:2])), abs(pose[2] - other[2])
    return shift <= frames * JUMP_SHIFT and turn <= frames * JUMP_TURN
