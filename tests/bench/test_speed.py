"""Time and operation counts of a solve: `make bench` reports seconds, tests judge counters only."""

import math
import os
import subprocess
import sys

import numpy as np
import pytest

from fe_reference import cross_axis_pivot as element_pivot
from fe_reference import solve_statics as solve_element_statics
from spline_model import cross_axis_pivot, solve_many, solve_motion, solve_statics
from studies.record.source import ROOT
from tests.table_one import SIX, TABLE_ONE

QUARTER_TURN = math.pi / 2
INCREMENTS = 20
#: Newton iterations of the 20-increment path that no change may exceed.
MOST_ITERATIONS = 25
DESIGNS = 200


def designs():
    """Table 1 with strips of many second moments."""
    return cross_axis_pivot(**SIX), {"second_moment_of_area": np.linspace(0.5e-10, 2e-10, DESIGNS)}


@pytest.mark.parametrize("n", [4, 6, 8, 12])
def test_static_path(benchmark, n):
    """Requirement: the path to 90 degrees in 20 increments takes 25 Newton iterations or fewer, and one
    evaluation more a state; few states form more than one tangent, as a good prediction needs none."""
    pivot = cross_axis_pivot(**TABLE_ONE, control_points=n)
    solution = benchmark(solve_statics, pivot, rotation=QUARTER_TURN, increments=INCREMENTS)
    counters = solution.counters
    benchmark.extra_info.update(counters | {"solve_s": solution.seconds["solve"]})
    assert 0 < counters["newton_iterations"] <= MOST_ITERATIONS
    assert counters["residual_evaluations"] <= counters["newton_iterations"] + INCREMENTS + 2
    assert counters["factorisations"] <= MOST_ITERATIONS + 1
    assert (counters["increments"], counters["halved_increments"]) == (INCREMENTS, 0)


def test_multiplier_path(benchmark):
    """Requirement: the bordered system needs no more iterations than the condensed one may."""
    pivot = cross_axis_pivot(**SIX)
    solution = benchmark(
        solve_statics, pivot, rotation=QUARTER_TURN, increments=INCREMENTS, method="multipliers"
    )
    benchmark.extra_info.update(solution.counters)
    assert 0 < solution.counters["newton_iterations"] <= MOST_ITERATIONS


def test_release(benchmark):
    """Requirement: five milliseconds of motion take no more than four iterations a step."""
    pivot = cross_axis_pivot(**SIX)
    motion = benchmark(solve_motion, pivot, start=QUARTER_TURN, duration=5e-3)
    benchmark.extra_info.update(motion.counters | {"solve_s": motion.seconds["solve"]})
    assert motion.counters["steps"] == 100
    assert motion.counters["newton_iterations"] <= 4 * motion.counters["steps"]


@pytest.mark.parametrize("threads", [1, 2])
def test_batch(benchmark, threads):
    """Requirement: a batch of designs reaches every end, each with 25 iterations or fewer."""
    batch = benchmark(solve_many, *designs(), rotation=QUARTER_TURN, increments=INCREMENTS, threads=threads)
    benchmark.extra_info.update(designs=DESIGNS, newton_iterations=int(batch.iterations.sum()))
    assert batch.converged.all()
    assert batch.iterations.max() <= MOST_ITERATIONS


def test_element_path(benchmark):
    """Requirement: the path on 20 elements takes no halving and one factorisation an iteration."""
    pivot = element_pivot(**TABLE_ONE, elements=20)
    solution = benchmark(solve_element_statics, pivot, rotation=QUARTER_TURN, increments=INCREMENTS)
    benchmark.extra_info.update(dict(solution.counters) | {"solve_s": solution.seconds["solve"]})
    counters = solution.counters
    assert counters["halvings"] == 0
    assert counters["factorisations"] == counters["newton_iterations"] + INCREMENTS


FIRST_SOLVE = """
from spline_model import cross_axis_pivot, solve_statics
from tests.table_one import SIX
solve_statics(cross_axis_pivot(**SIX), rotation=1.5)
"""


def of_the_cache(script):
    """What numba says of its cache while a script runs in a fresh interpreter."""
    environment = os.environ | {"PYTHONPATH": str(ROOT), "NUMBA_DEBUG_CACHE": "1"}
    words = [sys.executable, "-c", script]
    return subprocess.run(words, cwd=ROOT, env=environment, check=True, capture_output=True, text=True).stdout


def test_the_first_solve_compiles_nothing():
    """Requirement: once kernels are kept, import and first solve load them all and compile none."""
    said = of_the_cache(FIRST_SOLVE)
    if "data saved to" in said:  # they were not kept before
        said = of_the_cache(FIRST_SOLVE)
    assert said.count("data loaded from") > 0
    assert said.count("data saved to") == 0
