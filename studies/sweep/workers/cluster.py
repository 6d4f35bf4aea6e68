"""Workers of a Dask cluster, behind the same interface as those of this machine."""

import asyncio
import logging
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from studies.errors import BadInput
from studies.sweep.parts import suite
from studies.sweep.workers.pool import Pool

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
