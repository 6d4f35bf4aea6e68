"""Seconds of a solve by its parts."""

from __future__ import annotations

from time import perf_counter


class Laps:
    """A stopwatch: each lap adds the time since the one before to the part it names.

    Parts of a solve: "compile" (tables and arrays from the design), "solve" (the path or the
    motion alone), "recover" (the answer from its states; what it is along the strips is made when asked for).
    """

    def __init__(self) -> None:
        self._seconds: dict[str, float] = {}
        self._last = perf_counter()

    def lap(self, part: str) -> dict[str, float]:
        """End a lap; returns the seconds by part so far."""
        now = perf_counter()
        self._seconds[part] = self._seconds.get(part, 0.0) + now - self._last
        self._last = now
        return dict(self._seconds)
