"""What a solve costs beside its iterations, counted: compiled kernels, parts of its time, memory."""

import math
import os
import pickle
import subprocess
import sys

import numpy as np

from spline_model import cross_axis_pivot, solve_statics
from studies.record.source import ROOT
from tests.table_one import SIX

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


def test_what_nobody_asks_for_is_not_made():
    """Requirement: what an answer is along its strips is made once, when it is asked for, and kept with it
    when it is stored."""
    answer = solve_statics(cross_axis_pivot(**SIX), rotation=math.pi / 2)
    made = vars(answer)
    assert answer.torque[-1] > 0.0
    assert "sections" not in made
    assert "array" not in vars(answer.unknowns)
    assert answer.shape is answer.shape
    stored = pickle.loads(pickle.dumps(answer))
    np.testing.assert_array_equal(stored.shear_force, answer.shear_force)
