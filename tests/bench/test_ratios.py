"""Ratios of times in one run, memory that does not grow, and the start."""

import math
import os
import subprocess
import sys
import tracemalloc
from time import perf_counter

import numpy as np

from spline_model.batch import solve_many
from spline_model.fast.solve import fast_path
from spline_model.laps import Laps
from spline_model.pivot import cross_axis_pivot
from spline_model.statics import solve_statics
from studies.record.source import ROOT
from tests.bench.test_speed import DESIGNS, INCREMENTS, QUARTER_TURN, designs
from tests.table_one import TABLE_ONE

LIBRARIES = "import numpy, numba, scipy.interpolate, scipy.linalg, scipy.sparse.linalg"
FIRST_SOLVE = """
from spline_model.pivot import cross_axis_pivot
from spline_model.statics import solve_statics
from tests.table_one import TABLE_ONE
solve_statics(cross_axis_pivot(**TABLE_ONE), rotation=1.5)
"""


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
    pivot = cross_axis_pivot(**TABLE_ONE)
    single = best(lambda: solve_statics(pivot, rotation=QUARTER_TURN, increments=INCREMENTS))
    batch = best(lambda: solve_many(designs(), rotation=QUARTER_TURN, increments=INCREMENTS, threads=1))
    assert batch / DESIGNS < single / 3.0


def test_time_by_part_adds_up():
    """Requirement: tables, path and recovery are all of a solve, and the compiled path the smaller part."""
    pivot = cross_axis_pivot(**TABLE_ONE)
    solve_statics(pivot, rotation=QUARTER_TURN)
    begin = perf_counter()
    seconds = solve_statics(pivot, rotation=QUARTER_TURN).seconds
    passed = perf_counter() - begin
    assert set(seconds) == {"compile", "solve", "recover"}
    assert all(part > 0.0 for part in seconds.values())
    assert 0.5 * passed < sum(seconds.values()) <= passed


def test_memory_does_not_grow_with_the_increments():
    """Requirement: apart from its answer a path of 2000 increments needs what one of 20 does."""
    mechanism = cross_axis_pivot(**TABLE_ONE).mechanism

    def beyond_the_answer(increments):
        rotations = list(np.linspace(0.0, math.pi / 2, increments + 1)[1:])
        fast_path(mechanism, rotations, Laps())
        tracemalloc.start()
        _, answer = fast_path(mechanism, rotations, Laps())
        peak = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        return peak - sum(part.nbytes for part in answer) - 8 * increments

    # less than a byte an increment; compiled code cannot allocate at all, see `spline_model.strip.compiled`
    assert abs(beyond_the_answer(2000) - beyond_the_answer(20)) < 2000 - 20


def test_import_and_first_solve_with_a_warm_cache():
    """Requirement: nothing is compiled anew: import and first solve take less than four times the libraries'
    import, which takes about half a second on a free machine.
    """
    libraries = best(lambda: run(LIBRARIES), repeats=2)
    assert best(lambda: run(FIRST_SOLVE), repeats=2) < 4.0 * libraries
