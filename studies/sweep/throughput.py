"""How many designs a second: threads of the batch kernel, processes and Dask workers, and what a chunk costs.

Measured on the machine of the provenance; beyond its cores more workers cannot help, and nothing is said of
larger machines.
"""

import logging
import os
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pyarrow.parquet as pq
from matplotlib.figure import Figure

from studies.engine import Answer, Claim, Part, Study, Tables, absent, lacking
from studies.record.panels import Axis, Curves, Panel, sheet
from studies.record.style import BLUE, GREEN, ORANGE, Look
from studies.sweep.design_space import SPACE
from studies.sweep.read import plan_of
from studies.sweep.run import Pool, cluster, processes, sweep, threads

KINDS = {"threads": "threads", "processes": "processes", "dask": "Dask workers on loopback"}
ONE_WORKER = "Dask worker on loopback"
WORKERS = (1, 2)
#: Designs of a sweep that is timed twice by all, and of the one by two threads alone.
SIZES, LARGEST = (1_000, 10_000), 100_000
#: Chunks that the same designs are cut into, by one worker: few designs, so that the chunks are what counts.
CUT, CHUNKS = 1024, (2, 32, 128)
#: How often a sweep is timed.
REPEAT = 2
#: The wanted time of a hundred thousand designs [s].
WANTED = 40.0
#: What a chunk may cost beside its designs, a twentieth of those of the usual size [s].
CHUNK_COST = 0.01


def missing() -> str:
    """Return what this machine lacks."""
    return lacking("cluster", absent(["distributed"]))


def _timed(kind: str, count: int) -> Answer:
    """Return the times of so many workers of a kind, from drawing to the written table.

    Tables: timings (a row a size: the least time of repeated sweeps, without starting the workers);
    timings_of_chunks (the same designs in more and more chunks, by one worker).
    """
    row = {"workers": kind, "count": count, "cores": os.cpu_count()}
    timings, cuts = [], []
    with _pool_of(kind, count) as pool:
        _seconds_of(pool, 64 * count, chunk=32)  # loads the kernels in every worker
        for size in SIZES:
            timings.append(
                row | {"designs": size, "wall_s": min(_seconds_of(pool, size) for _ in range(REPEAT))}
            )
        if (kind, count) == ("threads", max(WORKERS)):
            timings.append(row | {"designs": LARGEST, "wall_s": _seconds_of(pool, LARGEST)})
        for chunks in CHUNKS if count == 1 else ():
            seconds = min(_seconds_of(pool, CUT, chunk=CUT // chunks) for _ in range(REPEAT))
            cuts.append(row | {"chunks": chunks, "wall_s": seconds})
    return {"timings": timings, "timings_of_chunks": cuts}


def _figure(tables: Tables) -> Figure:
    """Draw designs a second against the size of the sweep, and the time against the number of chunks."""
    colours = dict(zip(KINDS, (BLUE, ORANGE, GREEN), strict=True))
    timings, cuts = tables["timings"], tables["timings_of_chunks"]
    workers = {
        (kind, count): Look(
            label=f"{count} {_named(kind, count)}", colour=colours[kind], line="--" if count == 1 else "-",
            marker="o"
        )
        for kind in KINDS
        for count in WORKERS
    }  # fmt: skip
    costs = {kind: f"1 {_named(kind, 1)}: {1e3 * chunk_cost(cuts, kind):.1f} ms a chunk" for kind in KINDS}
    rates = timings.assign(rate=timings["designs"] / timings["wall_s"])
    rate = Panel(
        Axis("designs", "designs of the sweep [1]", log=True),
        Axis("rate", "designs a second [1/s]", limits=(0.0, None)),
        (Curves(rates, workers, by=("workers", "count")),),
        title=f"Paths of 20 increments, n = 6, {timings['cores'].iloc[0]} cores",
    )
    looks = {kind: Look(label=label, colour=colours[kind], marker="o") for kind, label in costs.items()}
    cost = Panel(
        Axis("chunks", "chunks [1]", log=True),
        Axis("wall_s", "time [s]", limits=(0.0, None)),
        (Curves(cuts, looks, by="workers"),),
        title=f"{CUT} designs in more chunks",
    )
    return sheet(9.5, 4.4, [[rate, cost]], legend=3)


def chunk_cost(cuts: pd.DataFrame, kind: str) -> float:
    """Return what one chunk more costs a worker of that kind [s]: the slope of the time over the chunks."""
    mine = cuts[cuts["workers"] == kind]
    return float(np.polyfit(mine["chunks"], mine["wall_s"], 1)[0])


@contextmanager
def _pool_of(kind: str, count: int) -> Iterator[Pool]:
    """Yield workers of a kind, those of Dask with a cluster of their own."""
    if kind == "dask":
        with loopback(count) as own, cluster(own.scheduler_address, workers=count) as pool:
            yield pool
    else:
        with (threads if kind == "threads" else processes)(count) as pool:
            yield pool


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


def _content(designs: int, chunk: int | None = None) -> dict[str, Any]:
    """Return the sweep of so many designs of the design space, by six control points."""
    sample: dict[str, Any] = {"method": "sobol", "points": designs}
    if chunk is not None:
        sample["chunk"] = chunk
    return SPACE | {"settings": {}, "analysis": {"kind": "static"}, "sample": sample}


def _seconds_of(pool: Pool, designs: int, *, chunk: int | None = None) -> float:
    """Return the time of one sweep, from drawing to the written table [s]."""
    plan = plan_of("throughput", _content(designs, chunk), Path())
    with tempfile.TemporaryDirectory() as folder:
        start = time.perf_counter()
        sweep(plan, Path(folder) / "sweep", pool=nullcontext(pool))
        return time.perf_counter() - start


def _work(designs: int) -> dict[str, Any]:
    """Return what a sweep of that size is made of, which no machine changes."""
    plan = plan_of("throughput", _content(designs), Path())
    with tempfile.TemporaryDirectory() as folder:
        sweep(plan, Path(folder) / "sweep")
        found = pq.read_table(Path(folder) / "sweep" / "designs.parquet", columns=["status", "iterations"])
    return {
        "designs": designs,
        "chunks": plan.chunks,
        "converged": found["status"].to_pylist().count("converged"),
        "iterations_a_design": sum(found["iterations"].to_pylist()) / designs,
    }


def _gains(tables: Tables) -> list[dict[str, Any]]:
    """Return how many times as many designs a second two workers solve as one, and what a chunk costs."""
    times = tables["timings"].set_index(["workers", "count", "designs"])["wall_s"].to_dict()
    middle = max(SIZES)
    return [
        {
            "label": label,
            "designs": middle,
            "cores": tables["timings"]["cores"].iloc[0],
            "gain": times[kind, 1, middle] / times[kind, 2, middle],
            "chunk_s": chunk_cost(tables["timings_of_chunks"], kind),
        }
        for kind, label in KINDS.items()
    ]


def _named(kind: str, count: int) -> str:
    label = KINDS[kind]
    return label if count > 1 else {"threads": "thread", "processes": "process"}.get(kind, ONE_WORKER)


STUDY = Study(
    cases=("cross_axis_pivot",),
    parts=(
        Part(at=lambda: product(KINDS, WORKERS), ask=_timed, alone=True),
        Part(at=lambda: SIZES, ask=lambda size: {"work": _work(size)}, alone=True),
    ),
    claims_of_time=(
        Claim(
            claim="Two workers solve at least 1.6 times as many designs a second as one",
            formulation="{label}, {designs} designs, {cores} cores",
            quantity="the gain",
            rows=_gains,
            value="gain",
            least=1.6,
        ),
        Claim(
            claim=f"A chunk costs less than {CHUNK_COST:g} s beside its designs",
            formulation="{label}, {cores} cores",
            quantity=f"the cost over {CHUNK_COST:g} s",
            rows=_gains,
            value=lambda row: row["chunk_s"] / CHUNK_COST,
            holds=lambda row: row["chunk_s"] < CHUNK_COST,
        ),
        Claim(
            claim=f"{LARGEST} static designs take less than {WANTED:g} s",
            formulation="2 threads, {cores} cores",
            quantity=f"the time over {WANTED:g} s",
            rows=lambda tables: tables["timings"].query(
                "workers == 'threads' and count == 2 and designs == @LARGEST"
            ),
            value=lambda row: row["wall_s"] / WANTED,
            holds=lambda row: row["wall_s"] < WANTED,
        ),
    ),
    figures={"sweep_throughput": _figure},
    missing=missing,
)
