"""Ask studies: points beside each other in other processes."""

import os
import time
from collections.abc import Iterator, Mapping
from concurrent.futures import Executor, ProcessPoolExecutor, as_completed
from contextlib import contextmanager
from functools import cache
from multiprocessing import get_context
from typing import Any

from studies.engine import Answer, Part, Study, Tables
from studies.kinds import Progress
from studies.registry import study_at

#: A point: the place of its study, as of `study_at`, its part and its number in that.
Key = tuple[str, int, int]


def answered(
    studies: Mapping[str, Study], progress: Progress, pool: Executor | None = None
) -> Iterator[tuple[str, Tables, float]]:
    """Ask all points; yield each study's place, tables and seconds of all answers [s] as soon as it is whole.

    Args:
        studies: by their place, where other processes find them.
        progress: is told how many points of how many of all studies are done.
        pool: has points of all studies beside each other, but for those that must be alone, which come when
            it has done the others. Without it one study comes after the other.
    """
    points = {key: each for place, study in studies.items() for key, each in _points(place, study).items()}
    found: dict[Key, tuple[Answer, float]] = {}

    def keep(key: Key, answer: tuple[Answer, float]) -> Iterator[tuple[str, Tables, float]]:
        found[key] = answer
        progress(len(found), len(points))
        own = [found.get(each) for each in points if each[0] == key[0]]
        if None not in own:
            answers, seconds = zip(*filter(None, own), strict=True)
            yield key[0], studies[key[0]].tables(answers), sum(seconds)

    progress(0, len(points))
    beside = {key for key, (part, _) in points.items() if pool and not part.alone}
    waiting = {pool.submit(_elsewhere, key): key for key in points if key in beside} if pool else {}
    for future in as_completed(waiting):
        yield from keep(waiting[future], future.result())
    for key, point in points.items():
        if key not in beside:
            yield from keep(key, _timed(*point))


def _points(place: str, study: Study) -> dict[Key, tuple[Part, Any]]:
    """Return part and point of a study by their key."""
    parts = enumerate(study.parts)
    return {(place, i, k): (part, point) for i, part in parts for k, point in enumerate(part.at())}


def _timed(part: Part, point: Any) -> tuple[Answer, float]:
    """Answer one point; return the seconds that it took as well."""
    start = time.perf_counter()
    return part.answer(point), time.perf_counter() - start


def _elsewhere(key: Key) -> tuple[Answer, float]:
    """Answer one point in another process, which has the study from its place."""
    return _timed(*_found_at(key[0])[key])


@cache
def _found_at(place: str) -> dict[Key, tuple[Part, Any]]:
    return _points(place, study_at(place))


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
