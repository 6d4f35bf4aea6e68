"""Workers on this machine: threads for the compiled batch, which needs no lock, processes for the rest."""

import multiprocessing
import os
import signal
from collections.abc import Iterator
from concurrent.futures import Executor, ProcessPoolExecutor, ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class Pool:
    """Workers behind the interface of `concurrent.futures`, and how many they are."""

    executor: Executor
    workers: int


@contextmanager
def threads(count: int) -> Iterator[Pool]:
    """Yield that many threads of this process; an interruption waits for the chunks that are under way."""
    executor = ThreadPoolExecutor(count)
    try:
        yield Pool(executor=executor, workers=count)
    finally:
        executor.shutdown(wait=True, cancel_futures=True)


@contextmanager
def processes(count: int) -> Iterator[Pool]:
    """Yield that many processes; they end with the context, in the middle of a chunk if need be."""
    others = set(multiprocessing.active_children())
    executor = ProcessPoolExecutor(
        count, mp_context=multiprocessing.get_context("spawn"), initializer=_end_quietly
    )
    try:
        yield Pool(executor=executor, workers=count)
    except BaseException:
        for child in set(multiprocessing.active_children()) - others:
            child.terminate()
        raise
    finally:
        executor.shutdown(wait=True, cancel_futures=True)


def _end_quietly() -> None:
    """Let an interruption from the keyboard, which reaches every process, end this one without a trace."""
    signal.signal(signal.SIGINT, lambda *_: os._exit(130))
