"""Simulated time of a released body: how many steps are due in a frame, and what was taken."""

from studies.interactive.pivot.presets import STEP, STEPS_A_FRAME

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
