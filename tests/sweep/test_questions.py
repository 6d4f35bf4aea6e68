"""What the studies of sweeps are made of: the front, the sample that users are shown, the costs of chunks."""

import tomllib

import numpy as np
import pandas as pd
import pytest

from studies import engine as study
from studies.record.source import ROOT
from studies.sweep import throughput
from studies.sweep.design_space import SPACE, WITTRICK, rounded
from studies.sweep.space_figure import dominating, not_dominated


@pytest.mark.parametrize("quantities", [1, 2, 4])
def test_front_is_what_no_design_betters(quantities):
    """Requirement: the front is that of asking every pair, also with designs that are equal in parts."""
    costs = np.random.default_rng(3).integers(0, 12, (300, quantities)).astype(float)
    front = not_dominated(costs)
    assert list(front) == [not dominating(costs, design).any() for design in costs]
    assert 0 < front.sum() < 300


def test_designs_that_are_equal_in_all_stay_together():
    """Requirement: a design does not better its double."""
    assert list(not_dominated(np.array([[1.0, 2.0], [1.0, 2.0], [2.0, 2.0]]))) == [True, True, False]


def test_the_example_is_the_sample_of_the_study():
    """Requirement: the file that users are shown gives the study's designs."""
    path = ROOT / "studies" / "sweep" / "examples" / "design_space.toml"
    assert tomllib.loads(path.read_text(encoding="utf-8")) == SPACE


def test_wittricks_ratio_is_the_published_one():
    """Published: 12.7 %, Kahrobaiyan et al., J Mech Des 140 (2018) 075002, abstract."""
    assert round(WITTRICK, 3) == 0.127
    assert pytest.approx(0.0, abs=1e-15) == 9.0 * WITTRICK**2 - 9.0 * WITTRICK + 1.0


def test_rounding_keeps_seven_digits():
    """Requirement: stored numbers keep seven digits, whatever their size; other columns are untouched."""
    table = rounded(pd.DataFrame({"a": [1.23456789e9, 1.23456789e-9], "name": ["x", "y"]}))
    assert list(table["a"]) == [1.234568e9, 1.234568e-9]
    assert list(table["name"]) == ["x", "y"]


def test_cost_of_a_chunk_is_the_slope():
    """Requirement: what a chunk costs is found from times that grow by it."""
    chunks = np.array([2, 16, 64])
    rows = pd.DataFrame({"workers": "threads", "chunks": chunks, "wall_s": 1.0 + 0.003 * chunks})
    assert throughput.chunk_cost(rows, "threads") == pytest.approx(0.003, rel=1e-12)


def test_throughput_is_left_out_without_the_cluster(monkeypatch):
    """Requirement: without Dask the study says what is missing instead of failing."""
    monkeypatch.setattr(study.importlib.util, "find_spec", lambda name: name)
    assert throughput.missing() == ""
    monkeypatch.setattr(study.importlib.util, "find_spec", lambda name: None)
    assert throughput.missing() == "it needs distributed: python -m pip install '.[cluster]'"
