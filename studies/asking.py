"""Ask studies: points beside each other in other processes."""

import os
import time
from collections.abc import Iterator, Mapping
from concurrent.futures import Executor, ProcessPoolExecutor, as_completed
from contextlib import contextmanager
from functools import cache
from multiprocessing import get_context
from typing import Any

import pandas as pd

from studies.engine import Answer, Part, Study
from studies.kinds import Progress
from studies.registry import study_at

#: Part and place of a point in a study.
Key = tuple[int, int]
#: An answer and the seconds that it took.
Timed = tuple[Answer, float]


class Asking:
    """A study that is asked point by point.

    Attributes:
        study: the declaration.
        points: part and point, by their key, in the order of the answers.
        found: the answers by now.
    """

    def __init__(self, study: Study) -> None:
        self.study = study
        self.points = _points(study)
        self.found: dict[Key, Timed] = {}

    @property
    def seconds(self) -> float:
        """What all answers took, one after the other [s]."""
        return sum(seconds for _, seconds in self.found.values())

    def open(self) -> dict[Key, bool]:
        """Return the points without an answer, and whether nothing may run beside them."""
        return {key: part.alone for key, (part, _) in self.points.items() if key not in self.found}

    def tables(self) -> dict[str, pd.DataFrame]:
        """Return the tables of the study, all points of which are answered."""
        return self.study.tables(self.found[key][0] for key in self.points)


def whole(askings: Mapping[str, Asking], progress: Progress, pool: Executor | None = None) -> Iterator[str]:
    """Ask all points, and yield each study as soon as it is whole.

    Args:
        askings: by the place of their study, as of `study_at`, where other processes find it.
        progress: is told how many points of how many of all studies are done.
        pool: has points of all studies beside each other, but for those that must be alone, which come when
            it has done the others. Without it one study comes after the other.
    """

    def tell() -> None:
        progress(sum(len(each.found) for each in askings.values()), count)

    count = sum(len(each.points) for each in askings.values())
    tell()
    waiting = {
        pool.submit(_elsewhere, place, key): (place, key)
        for place, asking in askings.items()
        for key, alone in asking.open().items()
        if pool and not alone
    }
    rest = dict(askings)
    for future in as_completed(waiting):
        place, key = waiting[future]
        askings[place].found[key] = future.result()
        tell()
        if not askings[place].open():
            del rest[place]
            yield place
    for place, asking in rest.items():
        for key in asking.open():
            asking.found[key] = _timed(*asking.points[key])
            tell()
        yield place


def _points(study: Study) -> dict[Key, tuple[Part, Any]]:
    """Return part and point by their key."""
    return {(i, k): (part, point) for i, part in enumerate(study.parts) for k, point in enumerate(part.at())}


def _timed(part: Part, point: Any) -> Timed:
    """Answer one point; return the seconds that it took as well."""
    start = time.perf_counter()
    return part.answer(point), time.perf_counter() - start


def _elsewhere(place: str, key: Key) -> Timed:
    """Answer one point in another process, which has the study from its place."""
    return _timed(*_found_at(place)[key])


@cache
def _found_at(place: str) -> dict[Key, tuple[Part, Any]]:
    return _points(study_at(place))


@contextmanager
def processes(count: int) -> Iterator[Executor | None]:
    """Yield what runs points on `count` processes, one thread each; nothing for a single one."""
    if count < 2:
        yield None
        return
    pool = ProcessPoolExecutor(count, mp_context=get_context("spawn"))
    try:
        yield pool
    finally:
        pool.shutdown(cancel_futures=True)


def cores() -> int:
    """Return how many processes this one may run beside each other."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
