"""Ratios of times in one run; `make bench` alone runs them, on a machine without other work."""

import os
import subprocess
import sys
from time import perf_counter

from spline_model import cross_axis_pivot, solve_many, solve_statics
from studies.record.source import ROOT
from tests.bench.test_speed import DESIGNS, FIRST_SOLVE, INCREMENTS, QUARTER_TURN, designs
from tests.table_one import SIX

LIBRARIES = "import numpy, numba, scipy.interpolate, scipy.linalg, scipy.sparse.linalg"


def best(work, repeats=5):
    """Least time of some runs [s]: what else runs only adds to it."""
    seconds = []
    for _ in range(repeats):
        begin = perf_counter()
        work()
        seconds.append(perf_counter() - begin)
    return min(seconds)


def run(script):
    """Run a script in a fresh interpreter."""
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    subprocess.run([sys.executable, "-c", script], cwd=ROOT, env=environment, check=True)


def test_a_batch_costs_a_fraction_of_single_solves():
    """Requirement: in a batch a path takes less than a third of a single solve, set-up included."""
    pivot = cross_axis_pivot(**SIX)
    single = best(lambda: solve_statics(pivot, rotation=QUARTER_TURN, increments=INCREMENTS))
    batch = best(lambda: solve_many(*designs(), rotation=QUARTER_TURN, increments=INCREMENTS, threads=1))
    assert batch / DESIGNS < single / 3.0


def test_parts_are_most_of_a_solve():
    """Requirement: what tables, path and recovery take is more than half of the whole solve."""
    pivot = cross_axis_pivot(**SIX)
    solve_statics(pivot, rotation=QUARTER_TURN)
    begin = perf_counter()
    seconds = solve_statics(pivot, rotation=QUARTER_TURN).seconds
    assert sum(seconds.values()) > 0.5 * (perf_counter() - begin)


def test_import_and_first_solve_with_a_warm_cache():
    """Requirement: import and first solve take less than four times the libraries' import, which takes about
    half a second on a free machine.
    """
    libraries = best(lambda: run(LIBRARIES), repeats=2)
    assert best(lambda: run(FIRST_SOLVE), repeats=2) < 4.0 * libraries
