"""Timing of one piece of work: warm-up, repeats, collection off, median and quartiles."""

import gc
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Generic, TypeVar

import numpy as np

Result = TypeVar("Result")


@dataclass(frozen=True, kw_only=True)
class Timing(Generic[Result]):
    """Seconds of repeated runs and the result of the last one.

    Attributes:
        result: what the work returned.
        seconds: one entry a run, in the order they were made [s].
    """

    result: Result
    seconds: tuple[float, ...]

    @property
    def median(self) -> float:
        """Median time [s]."""
        return float(np.median(self.seconds))

    @property
    def quartiles(self) -> tuple[float, float]:
        """First and third quartile of the times [s]."""
        low, high = np.percentile(self.seconds, (25, 75))
        return float(low), float(high)


def measure(work: Callable[[], Result], *, repeat: int, warm_up: int = 1) -> Timing[Result]:
    """Run `work` `warm_up` times untimed, then `repeat` times timed, with garbage collection off.

    Threads are the caller's affair: they must be set before numpy is imported (the command line and the
    Makefile set one).

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
        seconds = []
        for _ in range(repeat):
            start = time.perf_counter()
            result = work()
            seconds.append(time.perf_counter() - start)
    finally:
        if collecting:
            gc.enable()
    return Timing(result=result, seconds=tuple(seconds))
