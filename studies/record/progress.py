"""How long work takes: bars on the error stream for more than two seconds, and times that are measured."""

import sys
import time
import timeit
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Generic, Self, TypeVar

import numpy as np

from studies.kinds import Progress

Item = TypeVar("Item")
Result = TypeVar("Result")

#: Nothing is shown for work shorter than this [s].
DELAY = 2.0


def silent(done: int, total: int) -> None:
    """Show nothing: the default wherever progress can be reported."""


def watched(items: Sequence[Item], progress: Progress) -> Iterator[Item]:
    """Yield each of `items`, and tell how many of them are done."""
    for done, item in enumerate(items):
        progress(done, len(items))
        yield item
    progress(len(items), len(items))


class Bar:
    """A progress callable `bar(done, total)` that draws on a terminal, once work has lasted two seconds."""

    def __init__(self, label: str) -> None:
        self._label, self._begin = label, time.monotonic()
        self._bar: Any = None  # tqdm is generic in its stubs only

    def __call__(self, done: int, total: int) -> None:
        """Show that `done` of `total` parts are done."""
        if self._bar is None:
            if time.monotonic() - self._begin < DELAY:
                return
            from tqdm import tqdm  # short work does not import it

            how: Any = {"leave": False, "dynamic_ncols": True, "disable": None}
            self._bar = tqdm(total=total, initial=done, desc=self._label, **how)
        self._bar.total = total
        self._bar.update(done - self._bar.n)

    def say(self, line: str) -> None:
        """Print a line on the error stream, in place of the bar, which goes on below it."""
        if self._bar is not None:
            self._bar.clear()
        print(line, file=sys.stderr)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        if self._bar is not None:
            self._bar.close()


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
    parts: tuple[float, ...]

    @property
    def median(self) -> float:
        """Median time [s]."""
        return float(np.median(self.seconds))

    @property
    def median_part(self) -> float:
        """Median time of the part [s]."""
        return float(np.median(self.parts))


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
    last: deque[Result] = deque(maxlen=1)
    seconds, parts = [], []
    for _ in range(repeat):
        seconds.append(timeit.timeit(lambda: last.append(work()), number=1))
        if part is not None:
            parts.append(part(last[0]))
    return _Timing(result=last[0], seconds=tuple(seconds), parts=tuple(parts))
