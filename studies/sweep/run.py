"""Run a sweep: the chunks that are missing, on processes or a Dask cluster, then the table."""

import logging
import multiprocessing
import os
import signal
from collections.abc import Iterator
from concurrent import futures
from contextlib import AbstractContextManager, contextmanager, nullcontext
from itertools import islice
from pathlib import Path
from queue import SimpleQueue
from typing import NamedTuple

import pyarrow as pa

from studies.errors import BadInput
from studies.kinds import Progress
from studies.record.progress import silent
from studies.sweep.folder import Folder, suite
from studies.sweep.plan import Plan
from studies.sweep.points import solve_chunk

#: Chunks a worker that are under way or waiting, so that none idles and no result piles up.
AHEAD = 2
#: Longest wait for the scheduler, and for its first worker [s].
TIMEOUT, WORKERS_WITHIN = 5.0, 30.0


class SweepError(BadInput):
    """A chunk that no worker could solve."""


class Pool(NamedTuple):
    """Workers behind the interface of `concurrent.futures`, and how many they are."""

    executor: futures.Executor
    workers: int


def sweep(
    plan: Plan,
    out: Path,
    *,
    pool: AbstractContextManager[Pool] | None = None,
    csv: bool = False,
    progress: Progress = silent,
) -> int:
    """Solve what is missing of a sweep in the folder `out` and make its table; returns the points solved.

    Whatever solves the chunks, in whichever order, the table is the same: also after any interruption, from
    which the same call goes on.

    Args:
        plan: of the sweep. out: its folder.
        pool: of workers; None for all cores of this machine.
        csv: whether to write the table as CSV as well.
        progress: called with points done and points in all.

    Raises:
        OutputError: the folder cannot be used or written. SweepError: a chunk that no worker could solve.
    """
    folder, solved = Folder(out, plan), 0
    asked = (pool or local_pool()) if folder.missing() else nullcontext()
    with asked as workers, folder.held():  # in this order: a scheduler may be out of reach
        missing = folder.missing()
        if missing and workers:
            done = plan.points - sum(stop - start for start, stop in map(plan.span, missing))
            progress(done, plan.points)
            for number, table in _tables(plan, missing, workers):
                folder.write(number, table)
                solved += table.num_rows
                progress(done + solved, plan.points)
        folder.finish(csv=csv)
    return solved


def _tables(plan: Plan, missing: list[int], pool: Pool) -> Iterator[tuple[int, pa.Table]]:
    """Yield number and rows of the chunks as they are solved, a bounded number of them under way.

    An interruption may come while the queue is waited for: unlike `futures.wait`, it then leaves no locks.
    """
    ended: SimpleQueue[futures.Future[pa.Table]] = SimpleQueue()
    pending: dict[futures.Future[pa.Table], int] = {}
    waiting = iter(missing)
    while True:
        for number in islice(waiting, AHEAD * pool.workers - len(pending)):
            start, stop = plan.span(number)
            future = pool.executor.submit(solve_chunk, plan.task, start, plan.rows(start, stop))
            pending[future] = number
            future.add_done_callback(ended.put)
        if not pending:
            return
        future = ended.get()
        number = pending.pop(future)
        yield number, _result(plan, number, future)


def _result(plan: Plan, number: int, future: futures.Future[pa.Table]) -> pa.Table:
    """Return the rows of a chunk; SweepError if its workers failed."""
    try:
        return future.result()
    except (Exception, futures.CancelledError) as error:
        first, last = plan.span(number)
        raise SweepError(
            f"points {first} to {last - 1}: no worker could solve them ({_said(error)}); "
            "the same command goes on with what is missing"
        ) from error


def _said(error: BaseException) -> str:
    """Return kind and first line of an error."""
    return f"{type(error).__name__}: {error}".splitlines()[0]


@contextmanager
def local_pool(workers: int | None = None) -> Iterator[Pool]:
    """Yield processes on this machine, one for each core by default; an interruption ends them at once."""
    count, others = workers or os.cpu_count() or 1, set(multiprocessing.active_children())
    executor = futures.ProcessPoolExecutor(
        count,
        mp_context=multiprocessing.get_context("spawn"),
        initializer=signal.signal,  # an interruption from the keyboard reaches every process
        initargs=(signal.SIGINT, signal.SIG_IGN),
    )
    try:
        yield Pool(executor, count)
    except BaseException:
        for child in set(multiprocessing.active_children()) - others:
            child.terminate()
        raise
    finally:
        executor.shutdown(wait=True, cancel_futures=True)


@contextmanager
def cluster(
    address: str, *, workers: int = 1, timeout: float = TIMEOUT, workers_within: float = WORKERS_WITHIN
) -> Iterator[Pool]:
    """Yield the workers of the scheduler at `address` (tcp://HOST:PORT), once there are so many.

    Every worker needs the suite in the same version. The chunks of a lost worker go to others. The rows
    return to this process, which alone writes.

    Args:
        workers: least number [1]. timeout: for the scheduler [s]. workers_within: for the workers [s].

    Raises:
        BadInput: distributed is not installed, no scheduler answers, lacks workers or the suite; one line.
    """
    try:
        from distributed import Client
    except ModuleNotFoundError:
        raise BadInput(
            '--scheduler: the package distributed is not installed, expected it: pip install ".[cluster]"'
        ) from None
    for name in [name for name in logging.root.manager.loggerDict if name.startswith("distributed")]:
        logging.getLogger(name).setLevel(logging.CRITICAL)  # what matters is said by what is raised
    with _refusing(address, "where no scheduler answers", "an address as tcp://HOST:PORT"):
        client = Client(address, timeout=timeout, set_as_default=False)
    with client:
        with _refusing(address, "which lacks workers", f"one: dask worker {address}"):
            client.wait_for_workers(workers, timeout=workers_within)
        with _refusing(address, "whose workers cannot use the suite", "it to be installed there"):
            versions = client.run(suite)
        for worker, found in versions.items():
            if found != suite():
                raise BadInput(
                    f"--scheduler: got {address}, whose worker {worker} has another version of the suite, "
                    "expected the same everywhere"
                )
        yield Pool(client.get_executor(pure=False), sum(client.nthreads().values()))


@contextmanager
def _refusing(address: str, got: str, expected: str) -> Iterator[None]:
    """Raise BadInput, in one line, for any error in the context: of the network or of other machines."""
    try:
        yield
    except Exception as error:
        raise BadInput(f"--scheduler: got {address}, {got} ({_said(error)}), expected {expected}") from None
