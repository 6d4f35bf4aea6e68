"""How long work takes: bars on the error stream for more than two seconds, and times that are measured."""

import sys
import time
import timeit
from collections.abc import Callable, Iterator, Sequence
from typing import Generic, NamedTuple, Self, TypeVar

import numpy as np

from studies.kinds import Progress

Item = TypeVar("Item")
Result = TypeVar("Result")

#: Nothing is shown for work shorter than this [s].
DELAY = 2.0
#: Begins a line of a terminal again.
CLEAR = "\r\033[K"


def silent(done: int, total: int) -> None:
    """Show nothing: the default wherever progress can be reported."""


def watched(items: Sequence[Item], progress: Progress) -> Iterator[Item]:
    """Yield each of `items`, and tell how many of them are done."""
    for done, item in enumerate(items):
        progress(done, len(items))
        yield item
    progress(len(items), len(items))


class Bar:
    """A progress callable `bar(done, total)` that writes on a terminal, once work has lasted two seconds."""

    def __init__(self, label: str) -> None:
        self._label, self._begin, self._shown = label, time.monotonic(), False

    def __call__(self, done: int, total: int) -> None:
        """Show that `done` of `total` parts are done."""
        if sys.stderr.isatty() and time.monotonic() - self._begin >= DELAY:
            self._shown = True
            print(f"\r{self._label}: {done} of {total}", end=" ", file=sys.stderr, flush=True)

    def say(self, line: str) -> None:
        """Print a line on the error stream, in place of what is shown."""
        self.__exit__()
        print(line, file=sys.stderr)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        if self._shown:
            print(end=CLEAR, file=sys.stderr, flush=True)


class _Timing(NamedTuple, Generic[Result]):
    """What repeated work returned last, and its seconds and those of a part of it, an entry a run [s]."""

    result: Result
    seconds: list[float]
    parts: list[float]

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
    last: list[Result] = []
    seconds: list[float] = []
    parts: list[float] = []
    for _ in range(repeat):
        seconds.append(timeit.timeit(lambda: last.append(work()), number=1))
        result = last.pop()
        if part is not None:
            parts.append(part(result))
    return _Timing(result, seconds, parts)
