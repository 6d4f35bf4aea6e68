"""Run a sweep: the chunks that are missing, on processes or a Dask cluster, then the table.

Its folder holds what it was made from, a part for each chunk, and in the end one table:

    sweep.json          inputs, versions, columns with units' names and meanings
    parts/              one Parquet file a chunk, until all are there
    designs.parquet     the table, a row group a chunk, in the order of the points
    designs.csv         the same, where asked for

Every file is written under another name and renamed when it is complete.
"""

import asyncio
import hashlib
import json
import logging
import multiprocessing
import os
import signal
import sys
from collections import deque
from collections.abc import Iterator
from concurrent import futures
from contextlib import AbstractContextManager, contextmanager, nullcontext
from importlib.metadata import version
from itertools import chain
from pathlib import Path
from typing import Any, NamedTuple

import pyarrow as pa
import pyarrow.csv as pa_csv
import pyarrow.parquet as pq

from studies.errors import BadInput
from studies.kinds import Progress
from studies.record import files
from studies.record.files import OutputError, temporary_prefix, whole_file
from studies.record.progress import silent
from studies.record.source import source_hash
from studies.sweep.plan import Plan
from studies.sweep.points import POINT, REASON, STATUS, solve_chunk, stored

#: Chunks a worker that are under way or waiting, so that none idles and no result piles up.
AHEAD = 2
#: Longest wait for the scheduler, and for its first worker [s].
TIMEOUT, WORKERS_WITHIN = 5.0, 30.0
MANIFEST, TABLE, CSV = "sweep.json", "designs.parquet", "designs.csv"
SUITE = "cross-axis-pivot-validation"
#: Libraries whose version can change a number or a byte of the table.
LIBRARIES = ("numpy", "scipy", "numba", "scikit-fem", "pyarrow")


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
    folder, solved = _Folder(out, plan), 0
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
    """Yield number and rows of the chunks in their order, a bounded number of them under way."""
    under_way: deque[tuple[int, futures.Future[pa.Table]]] = deque()
    for number in missing:
        start, stop = plan.span(number)
        future = pool.executor.submit(solve_chunk, plan.task, start, plan.rows(start, stop))
        under_way.append((number, future))
        if len(under_way) > AHEAD * pool.workers:
            yield _result(plan, *under_way.popleft())
    for each in under_way:
        yield _result(plan, *each)


def _result(plan: Plan, number: int, future: futures.Future[pa.Table]) -> tuple[int, pa.Table]:
    """Return number and rows of a chunk; SweepError if its workers failed."""
    try:
        return number, future.result()
    except (Exception, futures.CancelledError) as error:
        first, last = plan.span(number)
        raise SweepError(
            f"points {first} to {last - 1}: no worker could solve them ({_said(error)}); "
            "the same command goes on with what is missing"
        ) from error


def _said(error: BaseException) -> str:
    """Return kind and first line of an error."""
    return f"{type(error).__name__}: {error}".splitlines()[0].removesuffix(": ")


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
def cluster(address: str) -> Iterator[Pool]:
    """Yield the workers of the scheduler at `address` (tcp://HOST:PORT), once there are any.

    Every worker needs the suite in the same version. The chunks of a lost worker go to others. The rows
    return to this process, which alone writes.

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
    within = f"where no scheduler answers within {TIMEOUT:g} s"
    with _refusing(address, within, "an address as tcp://HOST:PORT"):
        asyncio.run(_require_scheduler(address))
    with Client(address, timeout=TIMEOUT, set_as_default=False) as client:
        within = f"which lacks workers after {WORKERS_WITHIN:g} s"
        with _refusing(address, within, f"one: dask worker {address}"):
            client.wait_for_workers(1, timeout=WORKERS_WITHIN)
        with _refusing(address, "whose workers cannot use the suite", "it to be installed there"):
            versions = client.run(suite)
        for worker, found in versions.items():
            if found != suite():
                raise BadInput(
                    f"--scheduler: got {address}, whose worker {worker} has another version of the suite, "
                    "expected the same everywhere"
                )
        yield Pool(client.get_executor(pure=False), sum(client.nthreads().values()))


async def _require_scheduler(address: str) -> None:
    """Raise an error unless a scheduler answers there; a client that waits in vain takes long to give up."""
    from distributed.core import rpc

    async with rpc(address, timeout=TIMEOUT) as server:
        kind = (await asyncio.wait_for(server.identity(), TIMEOUT))["type"]
    if kind != "Scheduler":
        raise ValueError(f"there is a {kind}")


@contextmanager
def _refusing(address: str, got: str, expected: str) -> Iterator[None]:
    """Raise BadInput, in one line, for any error in the context: of the network or of other machines."""
    try:
        yield
    except Exception as error:
        raise BadInput(f"--scheduler: got {address}, {got} ({_said(error)}), expected {expected}") from None


class _Folder:
    """The folder of one sweep: made if it is not there, gone on with if it holds the same one.

    Raises:
        OutputError: it holds something else; nothing is written yet.
    """

    def __init__(self, root: Path, plan: Plan) -> None:
        self.root, self._plan, self._parts = root, plan, root / "parts"
        self._table, self._manifest = root / TABLE, _manifest_of(plan)
        _require_usable(root, self._manifest)

    @contextmanager
    def held(self) -> Iterator[None]:
        """Hold the folder for one run, within which it may be written to.

        Raises:
            OutputError: it cannot be written to, or another run is at work in it.
        """
        files.require_writable_folder(self.root)
        with _locked(self.root):
            self._clean()
            if _require_usable(self.root, self._manifest):
                content = json.dumps(self._manifest, indent=2) + "\n"
                files.write_whole(self.root / MANIFEST, content.encode())
            yield

    def missing(self) -> list[int]:
        """Return the numbers of the chunks that are not there yet."""
        if self._table.is_file():
            return []
        return [number for number in range(self._plan.chunks) if not self._part(number).is_file()]

    def write(self, number: int, table: pa.Table) -> None:
        """Keep the rows of one chunk; OutputError where they cannot be written."""
        self._parts.mkdir(exist_ok=True)
        with whole_file(self._part(number)) as stream:
            pq.write_table(table, stream)

    def finish(self, *, csv: bool) -> None:
        """Make the table of the parts, one after the other, and remove them; OutputError if it cannot be."""
        parts = [self._part(number) for number in range(self._plan.chunks)]
        if not self._table.is_file():
            with whole_file(self._table) as stream:
                _stream(map(pq.read_table, parts), lambda schema: pq.ParquetWriter(stream, schema))
        if csv and not (self.root / CSV).is_file():
            with whole_file(self.root / CSV) as stream, pq.ParquetFile(self._table) as source:
                groups = (_flat(source.read_row_group(i)) for i in range(source.num_row_groups))
                _stream(groups, lambda schema: pa_csv.CSVWriter(stream, schema))
        for part in parts:
            part.unlink(missing_ok=True)
        if self._parts.is_dir():
            self._parts.rmdir()

    def _clean(self) -> None:
        """Remove what a run that was killed has left half-written."""
        left = [path for name in (MANIFEST, TABLE, CSV) for path in self.root.glob(f".{name}.*")]
        for path in (*left, *self._parts.glob(".part-*")):
            path.unlink()

    def _part(self, number: int) -> Path:
        return self._parts / f"part-{number:08d}.parquet"


@contextmanager
def _locked(folder: Path) -> Iterator[None]:
    """Lock a folder for one run; OutputError if another run has it. Windows cannot lock folders."""
    if sys.platform == "win32":
        yield
        return
    import fcntl

    handle = os.open(folder, os.O_RDONLY)
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        yield
    except BlockingIOError:
        reason = "got a folder where another run is at work, expected it to end first"
        raise OutputError(f"{folder}: {reason}") from None
    finally:
        os.close(handle)


def _manifest_of(plan: Plan) -> dict[str, Any]:
    """Return what the table follows from, and what its columns are; without date or place."""
    content = json.loads(json.dumps(plan.content))
    columns = {POINT: "number of the point, from 0"}
    columns |= dict.fromkeys(plan.columns, "varied; unit as in the name of the key")
    columns |= {STATUS: "converged, not_converged, refused or failed", REASON: "why, or a remark; else empty"}
    columns |= {name: quantity.meaning for name, quantity in stored(plan.task).items()}
    return {
        "inputs_sha256": hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest(),
        "inputs": content,
        "suite": suite(),
        "versions": {name: version(name) for name in LIBRARIES},
        "columns": columns,
    }


def suite() -> dict[str, str]:
    """Return which version of the suite this is: its number, and a hash of what the numbers follow from."""
    return {"version": version(SUITE), "source_sha256": source_hash("studies.sweep.plan")}


def _require_usable(root: Path, manifest: dict[str, Any]) -> bool:
    """Return whether the folder is new; OutputError unless it is that, empty, or of the same sweep."""
    if root.exists() and not root.is_dir():
        raise OutputError(f"{root}: got a file, expected a folder")
    path, prefix = root / MANIFEST, temporary_prefix(root / MANIFEST)
    if not root.exists() or all(each.name.startswith(prefix) for each in root.iterdir()):
        return True
    if not path.is_file():
        raise OutputError(f"{root}: got a folder with other files, expected an empty one or that of a sweep")
    try:
        former = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        raise OutputError(f"{path}: cannot be read, expected what a sweep has written there") from None
    for part in ("inputs", "versions", "suite"):
        if former.get(part) != manifest[part]:
            changed = _difference(former.get(part) or {}, manifest[part])
            what = f"another {changed}" if part == "inputs" else f"{part} that differ ({changed})"
            raise OutputError(
                f"{root}: got a sweep with {what}, expected the same as before, or another folder"
            )
    return False


def _difference(former: dict[str, Any], now: dict[str, Any]) -> str:
    """Return the first key, with dots, under which two documents differ."""
    for key in [*now, *former]:
        one, other = former.get(key), now.get(key)
        if one != other and isinstance(one, dict) and isinstance(other, dict):
            return f"{key}.{_difference(one, other)}"
        if one != other:
            return key
    return "order of keys"


def _flat(table: pa.Table) -> pa.Table:
    """Return a table with its lists as texts, as CSV has none."""
    for place, column in enumerate(table.schema):
        if pa.types.is_list(column.type):
            texts = pa.array([json.dumps(each) for each in table[place].to_pylist()])
            table = table.set_column(place, column.name, texts)
    return table


def _stream(tables: Iterator[pa.Table], writer_of: Any) -> None:
    """Write tables one after the other by the writer that is made for their schema."""
    first = next(tables)
    with writer_of(first.schema) as writer:
        for table in chain((first,), tables):
            writer.write_table(table)
