"""What answers a declared study: point by point, on several processes, again from where it stopped."""

import os
import pickle
from collections.abc import Iterator
from concurrent.futures import Executor, ProcessPoolExecutor, as_completed
from contextlib import contextmanager
from functools import cache
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import pandas as pd

from studies.engine.study import Answer, Part, Study
from studies.kinds import Progress
from studies.record.progress import silent
from studies.registry import study_at

#: Part and place of a point in a study.
Key = tuple[int, int]


class Kept:
    """Answers kept in a file as they come, so that an interrupted study goes on from there."""

    def __init__(self, path: Path) -> None:
        self._path = path
        path.parent.mkdir(parents=True, exist_ok=True)

    def read(self) -> dict[Key, Answer]:
        """Return what is there; a last answer that was cut off is left out."""
        found: dict[Key, Answer] = {}
        if self._path.is_file():
            with self._path.open("rb") as stream:
                try:
                    while True:
                        key, answer = pickle.load(stream)
                        found[key] = answer
                except (EOFError, pickle.UnpicklingError):
                    pass
        return found

    def add(self, key: Key, answer: Answer) -> None:
        """Keep one more answer."""
        with self._path.open("ab") as stream:
            stream.write(pickle.dumps((key, answer)))

    def forget(self) -> None:
        """Remove all, once they are stored as tables."""
        self._path.unlink(missing_ok=True)


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


def answered(
    study: Study,
    progress: Progress = silent,
    *,
    kept: Kept | None = None,
    pool: Executor | None = None,
    module: str = "",
) -> dict[str, pd.DataFrame]:
    """Return the tables of `study`.

    Args:
        progress: is told how many points of how many are done.
        kept: where answers are kept until the study is whole, and taken from if it was begun.
        pool: runs the points beside each other, but those of parts that must be alone; with it `module` is
            the place, of `study_at`, where the other processes find the study.
    """
    points = [list(part.at()) for part in study.parts]
    keys = [(i, k) for i, some in enumerate(points) for k in range(len(some))]
    found = kept.read() if kept else {}
    open_keys = [key for key in keys if key not in found]
    beside = [key for key in open_keys if pool and not study.parts[key[0]].alone]

    def note(key: Key, answer: Answer) -> None:
        found[key] = {name: _held(rows) for name, rows in answer.items()}
        if kept:
            kept.add(key, found[key])
        progress(len(found), len(keys))

    progress(len(found), len(keys))
    if pool:
        waiting = {pool.submit(_elsewhere, module, *key): key for key in beside}
        for future in as_completed(waiting):
            note(waiting[future], future.result())
    for key in open_keys:
        if key not in found:
            note(key, study.parts[key[0]].answer(points[key[0]][key[1]]))
    return study.tables(found[key] for key in keys)


def _elsewhere(module: str, part: int, place: int) -> Answer:
    """Answer one point in another process, which has the study from its module."""
    chosen: Part = study_at(module).parts[part]
    return {name: _held(rows) for name, rows in chosen.answer(_points(module, part)[place]).items()}


@cache
def _points(module: str, part: int) -> list[Any]:
    return list(study_at(module).parts[part].at())


def _held(rows: Any) -> Any:
    """Return rows as what can be kept and sent: what yields them is asked for all."""
    return rows if isinstance(rows, dict | pd.DataFrame) else list(rows)
