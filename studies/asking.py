"""Ask studies: points beside each other in other processes, and on from where it was interrupted."""

import os
import pickle
import time
from collections.abc import Iterator, Mapping
from concurrent.futures import Executor, ProcessPoolExecutor, as_completed
from contextlib import contextmanager
from functools import cache
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import pandas as pd

from studies.engine import Answer, Part, Study
from studies.kinds import Progress
from studies.record.progress import silent
from studies.registry import study_at

#: Part and place of a point in a study.
Key = tuple[int, int]
#: An answer and the seconds that it took.
Timed = tuple[Answer, float]


class Kept:
    """Answers kept in a file as they come, so that an interrupted study goes on from there."""

    def __init__(self, path: Path) -> None:
        self._path = path
        path.parent.mkdir(parents=True, exist_ok=True)

    def read(self) -> dict[Key, Timed]:
        """Return what is there; a last answer that was cut off is left out."""
        found: dict[Key, Timed] = {}
        if self._path.is_file():
            with self._path.open("rb") as stream:
                try:
                    while True:
                        key, answer = pickle.load(stream)
                        found[key] = answer
                except (EOFError, pickle.UnpicklingError):
                    pass
        return found

    def add(self, key: Key, answer: Timed) -> None:
        """Keep one more answer."""
        with self._path.open("ab") as stream:
            stream.write(pickle.dumps((key, answer)))

    def forget(self) -> None:
        """Remove all, once they are stored as tables."""
        self._path.unlink(missing_ok=True)


class Asking:
    """A study that is asked point by point.

    Attributes:
        study: the declaration.
        points: part and point, by their key, in the order of the answers.
        found: the answers by now, those that were kept among them.
    """

    def __init__(self, study: Study, kept: Kept | None = None) -> None:
        self.study = study
        self.points = _points(study)
        self.found = kept.read() if kept else {}
        self._kept = kept

    @property
    def seconds(self) -> float:
        """What all answers took, one after the other [s]."""
        return sum(seconds for _, seconds in self.found.values())

    def open(self) -> dict[Key, bool]:
        """Return the points without an answer, and whether nothing may run beside them."""
        return {key: part.alone for key, (part, _) in self.points.items() if key not in self.found}

    def note(self, key: Key, answer: Timed) -> None:
        """Take and keep the answer of one point."""
        self.found[key] = answer
        if self._kept:
            self._kept.add(key, answer)

    def tables(self) -> dict[str, pd.DataFrame]:
        """Return the tables of the study, all points of which are answered."""
        return self.study.tables(self.found[key][0] for key in self.points)

    def forget(self) -> None:
        """Keep the answers no longer, once they are stored as tables."""
        if self._kept:
            self._kept.forget()


def answered(study: Study, progress: Progress = silent, kept: Kept | None = None) -> dict[str, pd.DataFrame]:
    """Return the tables of one study, its points asked here, one after the other."""
    asking = Asking(study, kept)
    for _ in whole({"": asking}, progress):
        pass
    return asking.tables()


def whole(
    askings: Mapping[str, Asking], progress: Progress = silent, pool: Executor | None = None
) -> Iterator[str]:
    """Ask all points that are open, and yield each study as soon as it is whole.

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
    for place in [place for place, asking in rest.items() if not asking.open()]:
        del rest[place]
        yield place
    for future in as_completed(waiting):
        place, key = waiting[future]
        askings[place].note(key, future.result())
        tell()
        if not askings[place].open():
            del rest[place]
            yield place
    for place, asking in rest.items():
        for key in asking.open():
            asking.note(key, _timed(*asking.points[key]))
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
