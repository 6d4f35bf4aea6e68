"""Who solves the chunks: threads and processes of this machine, or the workers of a Dask cluster.

Threads are for the compiled batch, which needs no lock, processes for the rest.
"""

import asyncio
import logging
import multiprocessing
import os
import signal
import tempfile
from collections.abc import Iterator
from concurrent.futures import Executor, ProcessPoolExecutor, ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

from studies.errors import BadInput
from studies.sweep.parts import suite


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


#: Longest wait for the scheduler, and for its first worker [s].
TIMEOUT, WORKERS_WITHIN = 5.0, 30.0


@contextmanager
def cluster(
    address: str, *, workers: int = 1, timeout: float = TIMEOUT, workers_within: float = WORKERS_WITHIN
) -> Iterator[Pool]:
    """Yield the workers of the scheduler at `address` (tcp://HOST:PORT), once there are so many.

    The suite, in the same version, must be installed on each. The chunks of a worker that is lost go to
    others; rows come back to this process, which alone writes.

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


@contextmanager
def loopback(workers: int) -> Iterator[Any]:
    """Yield a cluster on this machine, Dask's own, of that many workers with one thread each, which has a
    `scheduler_address`; all processes end with the context."""
    from distributed.deploy.subprocess import SubprocessCluster

    with (
        tempfile.TemporaryDirectory() as folder,
        SubprocessCluster(
            scheduler_kwargs={"dashboard": False, "scheduler_file": f"{folder}/scheduler.json"},
            worker_class="distributed.Worker",
            n_workers=workers,
            threads_per_worker=1,
            worker_kwargs={"dashboard": False, "local_directory": folder},
            silence_logs=logging.CRITICAL,
        ) as own,
    ):
        yield own
