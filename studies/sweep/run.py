"""Run a sweep: the chunks that are missing, on processes or a Dask cluster, then the table."""

import asyncio
import logging
import multiprocessing
import os
import signal
import threading
from collections.abc import Callable, Iterator
from concurrent import futures
from contextlib import AbstractContextManager, ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pyarrow as pa

from studies.errors import BadInput
from studies.kinds import Progress
from studies.record.progress import silent
from studies.sweep.parts import Folder, suite
from studies.sweep.plan import Plan
from studies.sweep.points import solve_chunk

#: Chunks a worker that are under way or waiting, so that none idles and no result piles up.
AHEAD = 2
#: How often an interruption is looked for while nothing comes [s].
PATIENCE = 0.1
#: Longest wait for the scheduler, and for its first worker [s].
TIMEOUT, WORKERS_WITHIN = 5.0, 30.0


class SweepError(BadInput):
    """A chunk that no worker could solve."""


@dataclass(frozen=True, kw_only=True)
class Pool:
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
    folder, solved, total = Folder(out, plan), 0, plan.points
    with ExitStack() as stack:
        workers = None
        if folder.missing():  # asked before anything is written: a scheduler may be out of reach
            workers = stack.enter_context(local_pool() if pool is None else pool)
        stack.enter_context(folder.held())
        missing = folder.missing()
        if missing and workers is not None:
            interrupted = stack.enter_context(_interruptions())
            done = total - sum(stop - start for start, stop in map(plan.span, missing))
            progress(done, total)
            for number, table in _tables(plan, missing, workers, interrupted):
                folder.write(number, table)
                solved += table.num_rows
                progress(done + solved, total)
        folder.finish(csv=csv)
    return solved


@contextmanager
def _interruptions() -> Iterator[Callable[[], None]]:
    """Yield a check that raises KeyboardInterrupt where one came; the second one of a user is not held back.

    Raised in the middle of `wait`, it would leave locks of the futures taken, and the workers at them for
    ever.
    """
    came = threading.Event()
    if threading.current_thread() is not threading.main_thread():
        yield lambda: None  # interruptions reach the main thread alone
        return
    before = signal.getsignal(signal.SIGINT)

    def note(*_: object) -> None:
        came.set()
        signal.signal(signal.SIGINT, before)

    def check() -> None:
        if came.is_set():
            raise KeyboardInterrupt

    signal.signal(signal.SIGINT, note)
    try:
        yield check
    finally:
        signal.signal(signal.SIGINT, before)


def _tables(
    plan: Plan, missing: list[int], pool: Pool, interrupted: Callable[[], None]
) -> Iterator[tuple[int, pa.Table]]:
    """Yield number and rows of the chunks as they are solved, a bounded number of them under way."""
    waiting = iter(missing)
    pending: dict[futures.Future[pa.Table], int] = {}
    try:
        while True:
            while len(pending) < AHEAD * pool.workers and (number := next(waiting, None)) is not None:
                start, stop = plan.span(number)
                rows = plan.rows(start, stop)
                pending[pool.executor.submit(solve_chunk, plan.task, start, rows)] = number
            if not pending:
                return
            done = futures.wait(pending, timeout=PATIENCE, return_when=futures.FIRST_COMPLETED).done
            interrupted()  # it ends processes too: what they leave is no failure of theirs
            for future in sorted(done, key=pending.__getitem__):
                number = pending.pop(future)
                yield number, _result(plan, number, future)
    finally:
        for future in pending:
            future.cancel()


def _result(plan: Plan, number: int, future: futures.Future[pa.Table]) -> pa.Table:
    """Return the rows of a chunk; SweepError if its workers failed."""
    try:
        return future.result()
    except (Exception, futures.CancelledError) as error:
        first, last = plan.span(number)
        reason = (str(error).splitlines() or [""])[0]
        raise SweepError(
            f"points {first} to {last - 1}: no worker could solve them ({type(error).__name__}: {reason}); "
            "the same command goes on with what is missing"
        ) from error


@contextmanager
def local_pool(workers: int | None = None) -> Iterator[Pool]:
    """Yield processes on this machine, one for each core by default; an interruption ends them at once."""
    count, others = workers or os.cpu_count() or 1, set(multiprocessing.active_children())
    spawn = multiprocessing.get_context("spawn")
    executor = futures.ProcessPoolExecutor(count, mp_context=spawn, initializer=_end_quietly)
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
    _require_scheduler(address, timeout)
    with Client(address, timeout=timeout, set_as_default=False) as client:
        try:
            client.wait_for_workers(workers, timeout=workers_within)
        except TimeoutError:
            raise BadInput(
                f"--scheduler: got {address}, which lacks workers after {workers_within:g} s, "
                f"expected one: dask worker {address}"
            ) from None
        _require_suite(client, address)
        yield Pool(executor=client.get_executor(pure=False), workers=sum(client.nthreads().values()))


def _require_suite(client: Any, address: str) -> None:
    """Raise BadInput unless the workers have this suite in this version."""
    try:
        found = client.run(suite)
    except Exception as error:  # whatever is wrong over there
        reason = f"{type(error).__name__}: {(str(error).splitlines() or [''])[0]}"
        raise BadInput(
            f"--scheduler: got {address}, whose workers cannot use the suite ({reason}), "
            "expected it to be installed there"
        ) from None
    for worker, other in found.items():
        if other != suite():
            raise BadInput(
                f"--scheduler: got {address}, whose worker {worker} has another version of the suite, "
                "expected the same everywhere"
            )


def _require_scheduler(address: str, timeout: float) -> None:
    """Raise BadInput unless a scheduler answers there; a client that waits in vain takes long to give up."""
    from distributed.core import rpc

    async def asked() -> str:
        async with rpc(address, timeout=timeout) as scheduler:
            return str((await scheduler.identity())["type"])

    async def within() -> str:
        return await asyncio.wait_for(asked(), timeout)

    try:
        found = asyncio.run(within())
        reason = "" if found == "Scheduler" else f"there is a {found}"
    except Exception as error:  # of the network, of names, of whatever else may listen there
        reason = (str(error).splitlines() or [type(error).__name__])[0] or type(error).__name__
    if reason:
        raise BadInput(
            f"--scheduler: got {address}, where no scheduler answers within {timeout:g} s ({reason}), "
            "expected an address as tcp://HOST:PORT"
        )
