"""Sweeps on a Dask cluster: scheduler and workers of their own on loopback, and what there is without."""

import importlib.util
import logging
import subprocess
import sys
import tempfile
from contextlib import contextmanager

import pandas as pd
import pytest

from studies.errors import BadInput
from studies.record.source import ROOT
from studies.sweep.plan import read_plan
from studies.sweep.run import cluster, sweep
from tests.sweep.sweeps import RANDOM

with_dask = pytest.mark.skipif(not importlib.util.find_spec("distributed"), reason="needs the extra cluster")

MANY = RANDOM.replace("points = 200", "points = 800").replace("chunk = 32", "chunk = 20")


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
