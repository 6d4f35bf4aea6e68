"""What a solve costs beside its iterations, counted: compiled kernels, parts of its time, memory."""

import os
import subprocess
import sys

from studies.record.source import ROOT

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
