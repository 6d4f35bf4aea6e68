"""Timing of one piece of work: warm-up, repeats, collection off, median and quartiles."""

import gc
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Generic, TypeVar

import numpy as np

Result = TypeVar("Result")


@dataclass(frozen=True, kw_only=True)
class _Timing(Generic[Result]):
    """Seconds of repeated runs and the result of the last one.

    Attributes:
        result: what the work returned.
        seconds: one entry a run, in the order they were made [s].
        parts: the time of each run that `part` told of [s]; empty without it.
    """

    result: Result
    seconds: tuple[float, ...]
    parts: tuple[float, ...] = ()

    @property
    def median(self) -> float:
        """Median time [s]."""
        return float(np.median(self.seconds))

    @property
    def median_part(self) -> float:
        """Median time of the part [s]."""
        return float(np.median(self.parts))

    @property
    def quartiles(self) -> tuple[float, float]:
        """First and third quartile of the times [s]."""
        low, high = np.percentile(self.seconds, (25, 75))
        return float(low), float(high)


def measure(
    work: Callable[[], Result],
    *,
    repeat: int,
    warm_up: int = 1,
    part: Callable[[Result], float] | None = None,
) -> _Timing[Result]:
    """Run `work` `warm_up` times untimed, then `repeat` times timed, with garbage collection off.

    Threads are the caller's affair: they must be set before numpy is imported (the command line and the
    Makefile set one).

    Args:
        work: what is timed.
        repeat, warm_up: timed and untimed runs [1].
        part: the time of a part of the work, from its result [s].

    Raises:
        ValueError: `repeat` below 1.
    """
    if repeat < 1:
        raise ValueError(f"repeat: got {repeat}, expected at least 1")
    for _ in range(warm_up):
        work()
    collecting = gc.isenabled()
    gc.disable()
    try:
        seconds, parts = [], []
        for _ in range(repeat):
            start = time.perf_counter()
            result = work()
            seconds.append(time.perf_counter() - start)
            if part is not None:
                parts.append(part(result))
    finally:
        if collecting:
            gc.enable()
    return _Timing(result=result, seconds=tuple(seconds), parts=tuple(parts))
