"""What comes into a session: fields of events, each checked, the time they stand for, and the hand."""

import math
from collections import deque
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from studies.errors import BadInput
from studies.interactive.pivot.presets import STEP, STEPS_A_FRAME
from studies.kinds import Array


def number(event: Mapping[str, Any], key: str) -> float:
    """Return a finite number."""
    value = event.get(key)
    if not isinstance(value, int | float) or isinstance(value, bool) or not math.isfinite(value):
        raise BadInput(f"{key}: got {value!r}, expected a finite number")
    return float(value)


def three(event: Mapping[str, Any], key: str) -> NDArray[np.float64]:
    """Return three finite numbers."""
    values = event.get(key)
    if not isinstance(values, list | tuple) or len(values) != 3:
        raise BadInput(f"{key}: got {values!r}, expected three finite numbers")
    return np.array([number({key: value}, key) for value in values])


def choice(event: Mapping[str, Any], key: str, choices: tuple[str, ...]) -> str:
    """Return one of the choices."""
    value = event.get(key)
    if value not in choices:
        raise BadInput(f"{key}: got {value!r}, expected one of {', '.join(choices)}")
    return str(value)


def mapping(event: Mapping[str, Any], key: str) -> Mapping[str, Any]:
    """Return names with their values, none where the key is absent."""
    value = event.get(key, {})
    if not isinstance(value, Mapping):
        raise BadInput(f"{key}: got {value!r}, expected values by name")
    return value


def words(event: Mapping[str, Any], key: str) -> list[str]:
    """Return a list of texts, empty where the key is absent."""
    value = event.get(key, [])
    if not isinstance(value, list) or not all(isinstance(word, str) for word in value):
        raise BadInput(f"{key}: got {value!r}, expected a list of texts")
    return value


#: Longest that simulated time is caught up, or waits, in one frame, in steps.
MOST_STEPS = 20


class Clock:
    """Steps and simulated time since the release.

    Args:
        lock_step: every frame is four steps (films, replays), not as many as its time asks for (cameras).

    Attributes:
        steps, simulated: taken since the release, and their time [s], each at the length it had.
        lag: steps that are due and not yet taken; below zero where rounding took one early.
    """

    def __init__(self, *, lock_step: bool) -> None:
        self.lock_step = lock_step
        self.begin(None)

    def begin(self, time: float | None) -> None:
        """Begin anew at `time` [s], or where the next frame is."""
        self.steps, self.simulated, self.lag = 0, 0.0, 0.0
        self._last = time

    def wait(self, time: float) -> None:
        """Nothing moves up to `time` [s]."""
        self._last = time

    def due(self, time: float) -> int:
        """Return the steps of the frame at `time` [s].

        What rounding leaves, of either sign, is owed to the next frame, so that no time is gained or lost.
        """
        before, self._last = self._last, time
        if self.lock_step or before is None:
            return STEPS_A_FRAME
        due = self.lag + (time - before) / STEP
        steps = max(0, min(MOST_STEPS, round(due)))
        self.lag = max(-float(MOST_STEPS), due - steps)
        return steps

    def count(self, steps: int, step: float) -> None:
        """Add steps of `step` seconds that were taken."""
        self.steps += steps
        self.simulated += steps * step


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
