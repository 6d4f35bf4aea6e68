"""Run a sweep: the chunks that are missing, on threads, processes or a cluster, then the table."""

import os
import signal
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import FIRST_COMPLETED, CancelledError, Future, wait
from contextlib import AbstractContextManager, ExitStack, contextmanager
from pathlib import Path

import pyarrow as pa

from studies.errors import BadInput
from studies.kinds import Progress
from studies.record.progress import silent
from studies.sweep.batch import solve_chunk
from studies.sweep.parts import Folder
from studies.sweep.plan import Plan
from studies.sweep.sample import Drawer
from studies.sweep.workers import Pool, processes, threads

#: Chunks a worker that are under way or waiting, so that none idles and no result piles up.
AHEAD = 2
#: How often an interruption is looked for while nothing comes [s].
PATIENCE = 0.1


class SweepError(BadInput):
    """A chunk that no worker could solve."""


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
    folder = Folder(out, plan)
    solved = 0
    with ExitStack() as stack:
        workers = None
        if folder.missing():  # asked before anything is written: a scheduler may be out of reach
            workers = stack.enter_context(local_pool(plan) if pool is None else pool)
        stack.enter_context(folder.held())
        missing = folder.missing()
        if missing and workers is not None:
            interrupted = stack.enter_context(_interruptions())
            solved = _solve(plan, folder, missing, workers, progress, interrupted)
        folder.finish(csv=csv)
    return solved


def local_pool(plan: Plan, workers: int | None = None) -> AbstractContextManager[Pool]:
    """Return workers on this machine, all cores by default: threads for the batch kernel, else processes."""
    count = workers or os.cpu_count() or 1
    return threads(count) if plan.task.batch else processes(count)


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


def _solve(
    plan: Plan,
    folder: Folder,
    missing: list[int],
    pool: Pool,
    progress: Progress,
    interrupted: Callable[[], None],
) -> int:
    """Solve and keep the missing chunks; returns the number of their points."""
    total = plan.sample.points
    left = sum(stop - start for start, stop in map(plan.span, missing))
    done = total - left
    progress(done, total)
    for number, table in _tables(plan, missing, pool, interrupted):
        folder.write(number, table)
        done += table.num_rows
        progress(done, total)
    return left


def _tables(
    plan: Plan, missing: list[int], pool: Pool, interrupted: Callable[[], None]
) -> Iterator[tuple[int, pa.Table]]:
    """Yield number and rows of the chunks as they are solved, a bounded number of them under way."""
    drawer, waiting = Drawer(plan.sample), iter(missing)
    pending: dict[Future[pa.Table], int] = {}
    try:
        while True:
            while len(pending) < AHEAD * pool.workers and (number := next(waiting, None)) is not None:
                start, stop = plan.span(number)
                rows = drawer.rows(start, stop)
                pending[pool.executor.submit(solve_chunk, plan.task, start, rows)] = number
            if not pending:
                return
            done = wait(pending, timeout=PATIENCE, return_when=FIRST_COMPLETED).done
            interrupted()  # it ends processes too: what they leave is no failure of theirs
            for future in sorted(done, key=pending.__getitem__):
                number = pending.pop(future)
                yield number, _result(plan, number, future)
    finally:
        for future in pending:
            future.cancel()


def _result(plan: Plan, number: int, future: Future[pa.Table]) -> pa.Table:
    """Return the rows of a chunk; SweepError if its workers failed."""
    try:
        return future.result()
    except (Exception, CancelledError) as error:
        first, last = plan.span(number)
        reason = (str(error).splitlines() or [""])[0]
        raise SweepError(
            f"points {first} to {last - 1}: no worker could solve them ({type(error).__name__}: {reason}); "
            "the same command goes on with what is missing"
        ) from error
