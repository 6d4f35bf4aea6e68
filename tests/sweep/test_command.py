"""The command as a user calls it: processes of their own, interruptions, memory, a Dask cluster."""

import contextlib
import importlib.util
import logging
import os
import re
import signal
import subprocess
import sys
import tempfile
import time
from contextlib import contextmanager
from pathlib import Path

import pandas as pd
import pytest

from studies.errors import BadInput
from studies.record.source import ROOT
from studies.sweep.plan import read_plan
from studies.sweep.run import cluster, sweep
from tests.sweep.sweeps import RANDOM

EXAMPLES = sorted((ROOT / "studies" / "sweep" / "examples").glob("*.toml"))

RELEASES = """
case = "cross_axis_pivot"
analysis = { kind = "release", duration_s = 0.05 }
sample.chunk = 2
vary.body.mass_kg = { from = 0.1, to = 0.3, points = 24 }
"""


def command(*words):
    """Return the words that run a sweep."""
    return [sys.executable, "-m", "studies", "sweep", *map(str, words)]


def started(*words):
    """Start a sweep in a group of its own, where Ctrl-C does what it does in a terminal.

    What runs in the background of a script has it ignored, and hands that on.
    """
    own = {"start_new_session": True, "preexec_fn": lambda: signal.signal(signal.SIGINT, signal.SIG_DFL)}
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    return subprocess.Popen(command(*words), cwd=ROOT, **pipes, **own)


def ended(process):
    """Return exit code and last line of the errors, once a process has ended by itself."""
    try:
        _, errors = process.communicate(timeout=120)
    finally:
        process.kill()
    return process.returncode, re.split(r"[\r\n]+", errors.strip())[-1].strip()


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_examples_are_sweeps(path):
    """Requirement: the example files can be used as they stand."""
    assert read_plan(path).points > 1


def test_the_help_shows_a_file_that_works(tmp_path, capsys):
    """Requirement: the file in the command's help, as it stands there, is a sweep."""
    from studies.commands import sweep

    lines = [line[4:] for line in sweep.__doc__.splitlines() if line.startswith("    ") or not line]
    text = "\n".join(line for line in lines if not line.startswith("python -m"))
    path = tmp_path / "designs.toml"
    path.write_text(text)
    asked = read_plan(path)
    assert asked.points == 4096
    assert len(asked.columns) == 4


def left_of(group: int, within: float = 60.0) -> list[str]:
    """Return the processes of a group that are still at work after a while."""
    end = time.monotonic() + within
    while True:
        found = []
        for place in Path("/proc").glob("[0-9]*/stat"):
            with contextlib.suppress(OSError):
                state, _, number = place.read_text().rpartition(")")[2].split()[:3]
                if int(number) == group and state != "Z":
                    found.append(place.parent.name)
        if not found or time.monotonic() > end:
            return found
        time.sleep(0.05)


def parts_in(out: Path, least: int, within: float = 300.0) -> int:
    """Return the number of parts once there are so many."""
    end = time.monotonic() + within
    while time.monotonic() < end:
        found = len(list((out / "parts").glob("part-*"))) if out.exists() else 0
        if found >= least:
            return found
        time.sleep(0.02)
    raise AssertionError(f"{least} parts did not come within {within} s")


@pytest.mark.slow
def test_interrupted_command_says_how_to_go_on(tmp_path):
    """Requirement: Ctrl-C ends the command and all its processes with one line and code 130; called again it
    gives the table that an uninterrupted run gives."""
    path, out = tmp_path / "designs.toml", tmp_path / "out"
    path.write_text(RELEASES)
    process = started(path, "--out", out)
    kept = parts_in(out, 2)
    os.killpg(process.pid, signal.SIGINT)
    code, line = ended(process)
    assert code == 130
    assert line == "studies: interrupted: the same command goes on with what is missing"
    assert left_of(process.pid) == []
    assert len(list((out / "parts").glob("part-*"))) >= kept
    assert not (out / "designs.parquet").exists()
    again = subprocess.run(command(path, "--out", out), cwd=ROOT, capture_output=True, text=True, check=True)
    assert "were there" in again.stdout
    subprocess.run(command(path, "--out", tmp_path / "one", "--workers", "1"), cwd=ROOT, check=True)
    assert (out / "designs.parquet").read_bytes() == (tmp_path / "one" / "designs.parquet").read_bytes()


@pytest.mark.slow
def test_memory_does_not_grow_with_the_points(tmp_path):
    """Requirement: eight times the points, in chunks of one size, take the same memory at the peak, to a
    twentieth."""
    peaks = []
    for points in (200, 1_600):
        path = tmp_path / f"{points}.toml"
        path.write_text(
            RANDOM.replace("points = 104", f"points = {points}").replace("chunk = 32", "chunk = 40")
        )
        # one worker: with several the peak depends on which chunks meet
        words = ["sweep", str(path), "--out", str(tmp_path / str(points)), "--csv", "--workers", "1"]
        script = (
            "import resource, sys\nfrom studies.__main__ import main\n"
            f"assert main({words!r}) == 0\n"
            "print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)"
        )
        done = subprocess.run(
            [sys.executable, "-c", script], cwd=ROOT, capture_output=True, text=True, check=True
        )
        peaks.append(int(done.stdout.splitlines()[-1]))
    assert peaks[1] < 1.05 * peaks[0]


with_dask = pytest.mark.skipif(not importlib.util.find_spec("distributed"), reason="needs the extra cluster")

MANY = RANDOM.replace("points = 104", "points = 800").replace("chunk = 32", "chunk = 20")


@contextmanager
def loopback(workers):
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


def turned_away(address, tmp_path, refused, says):
    """Hold that a sweep that asks for a scheduler there is one line and writes nothing."""
    path, out = tmp_path / "designs.toml", tmp_path / "out"
    path.write_text(RANDOM)
    refused("sweep", path, "--out", out, "--scheduler", address, says=says)
    assert not out.exists()


def test_without_the_package_one_line_says_what_to_install(tmp_path, refused, monkeypatch):
    """Requirement: a suite without the extra says how to get it."""
    monkeypatch.setitem(sys.modules, "distributed", None)
    turned_away("tcp://127.0.0.1:1", tmp_path, refused, says='pip install ".[cluster]"')


@with_dask
@pytest.mark.slow
def test_workers_of_another_version_are_refused(monkeypatch):
    """Requirement: workers that would solve by other code than this are refused before they start."""
    with loopback(1) as other:
        with cluster(other.scheduler_address) as pool:
            assert pool.workers == 1
        monkeypatch.setattr("studies.sweep.run.source_hash", lambda module: "other")
        with pytest.raises(BadInput, match="another version of the suite"), cluster(other.scheduler_address):
            pass


@with_dask
@pytest.mark.slow
def test_cluster_gives_the_local_table_though_a_worker_is_killed(tmp_path):
    """Requirement: two workers, one killed in mid-run: every point arrives once, in the table that the
    command gives on this machine alone, and no process is left.

    The command has a process of its own: kernels share functions with those that were loaded before them, by
    other tests for instance, and these may differ in round-off.
    """
    path = tmp_path / "designs.toml"
    path.write_text(MANY)
    words = [sys.executable, "-m", "studies", "sweep", str(path), "--out", str(tmp_path / "local")]
    subprocess.run(words, cwd=ROOT, capture_output=True, check=True)
    with loopback(2) as both:
        first, second = (worker.process for worker in both.workers.values())
        arrived = []

        def kill_one(done, total):
            arrived.append(done)
            if done == 200:
                first.kill()

        pool = cluster(both.scheduler_address)
        assert sweep(read_plan(path), tmp_path / "cluster", pool=pool, progress=kill_one) == 800
        assert first.returncode < 0
        assert second.returncode is None
    assert second.returncode is not None
    assert arrived == list(range(0, 801, 20))
    table = pd.read_parquet(tmp_path / "cluster" / "designs.parquet")
    assert list(table["point"]) == list(range(800))
    for name in ("designs.parquet", "sweep.json"):
        local, remote = (tmp_path / place / name for place in ("local", "cluster"))
        assert local.read_bytes() == remote.read_bytes()
