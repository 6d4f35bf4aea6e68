"""A Dask cluster on this machine alone: a scheduler and workers as processes of their own, on 127.0.0.1."""

import json
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from studies.errors import BadInput
from studies.record.source import ROOT

#: Longest wait for the scheduler to say where it listens [s].
START = 30.0
_QUIET = ("--no-dashboard", "--protocol", "tcp", "--host", "127.0.0.1")


@dataclass(frozen=True, kw_only=True)
class Loopback:
    """Address of the scheduler, tcp://127.0.0.1:PORT, its process and those of the workers."""

    address: str
    scheduler: "subprocess.Popen[bytes]"
    workers: tuple["subprocess.Popen[bytes]", ...]


@contextmanager
def loopback(workers: int) -> Iterator[Loopback]:
    """Yield a cluster of that many workers with one thread each; all processes end with the context.

    Raises:
        BadInput: the scheduler does not come up.
    """
    running: list[subprocess.Popen[bytes]] = []
    with tempfile.TemporaryDirectory() as folder:
        found = Path(folder) / "scheduler.json"
        try:
            running.append(_started("scheduler", "--port", "0", "--scheduler-file", str(found)))
            address = _address(found, running[0])
            for number in range(workers):
                options = ("--nthreads", "1", "--no-nanny", "--local-directory", f"{folder}/{number}")
                running.append(_started("worker", address, *options))
            yield Loopback(address=address, scheduler=running[0], workers=tuple(running[1:]))
        finally:
            for process in running:  # they keep nothing, and take seconds to end when asked to
                process.kill()
            for process in running:
                process.wait()


def _started(*words: str) -> "subprocess.Popen[bytes]":
    return subprocess.Popen(
        [sys.executable, "-m", "dask", *words, *_QUIET],
        cwd=ROOT,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )


def _address(found: Path, scheduler: "subprocess.Popen[bytes]") -> str:
    """Return where the scheduler listens, once it has written it."""
    end = time.monotonic() + START
    while time.monotonic() < end and scheduler.poll() is None:
        try:
            return str(json.loads(found.read_text(encoding="utf-8"))["address"])
        except (OSError, ValueError):
            time.sleep(0.05)
    raise BadInput(f"scheduler: got no address within {START:g} s, expected one on 127.0.0.1")
