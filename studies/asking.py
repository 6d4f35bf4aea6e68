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

#: Place of a study, number of its part and of the point.
Key = tuple[str, int, int]
#: Points of studies by their keys, in the order of their answers.
Points = dict[Key, tuple[Part, Any]]
#: An answer and the seconds that it took.
Timed = tuple[Answer, float]


def whole(
    studies: Mapping[str, Study], progress: Progress, pool: Executor | None = None
) -> Iterator[tuple[str, dict[str, pd.DataFrame], float]]:
    """Compute all points, and yield each study as soon as it is complete: its place, its tables and its time
    [s].

    The time is the sum over all points.

    Args:
        studies: by their places, as of `study_at`, where other processes find them.
        progress: receives the number of completed points and of all points of all studies.
        pool: computes points of all studies in parallel. Points that must be alone follow after the others.
            Without a pool, the studies are computed one after the other.
    """
    points = {key: one for place, study in studies.items() for key, one in _points(place, study).items()}
    found: dict[Key, Timed] = {}
    progress(0, len(points))
    for key, timed in _answers(points, pool):
        found[key] = timed
        progress(len(found), len(points))
        mine = [each for each in points if each[0] == key[0]]
        if all(each in found for each in mine):
            answers, seconds = zip(*(found[each] for each in mine), strict=True)
            yield key[0], studies[key[0]].tables(answers), sum(seconds)


def _answers(points: Points, pool: Executor | None) -> Iterator[tuple[Key, Timed]]:
    """Yield the answer of each point: those of other processes, then those of this one."""
    beside = [key for key, (part, _) in points.items() if pool and not part.alone]
    waiting = {pool.submit(_elsewhere, key): key for key in beside if pool}
    for future in as_completed(waiting):
        yield waiting[future], future.result()
    yield from ((key, _timed(*point)) for key, point in points.items() if key not in beside)


def _points(place: str, study: Study) -> Points:
    """Return part and point by their key."""
    return {
        (place, i, k): (part, point)
        for i, part in enumerate(study.parts)
        for k, point in enumerate(part.at())
    }


def _timed(part: Part, point: Any) -> Timed:
    """Answer one point; return the seconds that it took as well."""
    start = time.perf_counter()
    return part.answer(point), time.perf_counter() - start


def _elsewhere(key: Key) -> Timed:
    """Answer one point in another process, which has the study from its place."""
    return _timed(*_points_at(key[0])[key])


@cache
def _points_at(place: str) -> Points:
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
