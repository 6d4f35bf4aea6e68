"""What a solve costs beside its iterations, counted: compiled kernels, parts of its time, memory."""

import itertools
import math
import os
import pickle
import subprocess
import sys
import tracemalloc

import numpy as np
import pytest

from fe_reference import DEFAULT_EFFECTS, bending
from fe_reference import cross_axis_pivot as element_pivot
from fe_reference.bending import ROUND_OFF, bent_element
from fe_reference.structure import structure_of
from spline_model import cross_axis_pivot, newton, solve_statics
from spline_model.compile import compile_scene
from spline_model.reduced.elements import Elements
from spline_model.reduced.model import at_rest
from studies.record.source import ROOT
from tests.table_one import SIX, TABLE_ONE

FIRST_SOLVE = """
from spline_model.pivot import cross_axis_pivot
from spline_model.statics import solve_statics
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


def test_parts_are_all_of_a_solve(monkeypatch):
    """Requirement: tables, path and recovery are booked without a gap: by a clock that counts its readings,
    their sum is all that passed between the first and the last."""
    readings = itertools.count()
    monkeypatch.setattr(newton, "perf_counter", lambda: float(next(readings)))
    seconds = solve_statics(cross_axis_pivot(**SIX), rotation=math.pi / 2).seconds
    assert set(seconds) == {"compile", "solve", "recover"}
    assert all(part >= 1.0 for part in seconds.values())
    assert sum(seconds.values()) == pytest.approx(next(readings) - 1.0, abs=1e-9)


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


def test_memory_does_not_grow_with_the_increments():
    """Requirement: apart from its answer a path of 2000 increments needs what one of 20 does."""
    work = Elements.of(compile_scene(cross_axis_pivot(**SIX).driven(math.pi / 2)))
    start = at_rest(work.model)

    def beyond_the_answer(increments):
        factors = np.linspace(0.0, 1.0, increments + 1)
        work.run(factors, start)
        tracemalloc.start()
        answer = work.run(factors, start)
        peak = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        return peak - sum(part.nbytes for part in answer)

    # less than a byte an increment; compiled code cannot allocate at all, see `spline_model.strip.compiled`
    assert abs(beyond_the_answer(2000) - beyond_the_answer(20)) < 2000 - 20


@pytest.mark.parametrize(("more", "evaluations"), [((), 1), (("clamped_width",), 1), (("anticlastic",), 2)])
def test_turns_of_roots_take_few_evaluations_of_the_law(monkeypatch, more, evaluations):
    """Requirement: the turns of an element's roots are exact after one evaluation of a linear law, and two
    where sections flatten, as far as they turn in the reference pivot at 90 degrees."""
    bare = {name: value for name, value in TABLE_ONE.items() if name not in ("area", "second_moment_of_area")}
    pivot = element_pivot(
        **bare,
        width=0.01,
        thickness=0.005,
        elements=20,
        effects=(*DEFAULT_EFFECTS, "root_compliance", *more),
        parameters={"root_compliance": {"root": "monolithic"}},
    )
    _, table, _, curl = structure_of(pivot).given
    asked = []
    monkeypatch.setattr(bending, "bent_element", lambda *given: asked.append(given) or bent_element(*given))
    bent, *turns = bending.rooted_element.py_func(
        curl, table[0], 1.0 / table[0, 2], 0.0, 0.03, -0.015, ROUND_OFF
    )
    assert len(asked) == evaluations
    np.testing.assert_allclose(turns, table[0, 12:] * bent[1:3], rtol=1e-14)
