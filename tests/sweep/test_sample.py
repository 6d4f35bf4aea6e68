"""Samples: the right points, the same for the same file, whatever part of them is asked for."""

import math

import numpy as np
import pytest
from scipy.stats import qmc

from tests.sweep.sweeps import GRID, RANDOM, plan


def drawn(text, *cuts):
    """Return the sample in pieces between the cuts, joined."""
    asked = plan(text)
    pieces = [asked.rows(a, b) for a, b in zip((0, *cuts), (*cuts, asked.points), strict=True)]
    return {key: [value for piece in pieces for value in piece[key]] for key in pieces[0]}


def test_a_grid_holds_every_combination_once():
    """Requirement: a grid is the product of its axes, the last fastest, with the ends as they are written."""
    columns = drawn(GRID)
    rows = list(zip(*columns.values(), strict=True))
    assert len(rows) == len(set(rows)) == 12
    assert rows[:4] == [(0.3, 4, 0.0), (0.3, 4, 0.01), (0.3, 6, 0.0), (0.3, 6, 0.01)]
    assert columns["strip.crossing_ratio"][-1] == 0.7


def test_a_list_runs_along_all_columns_at_once():
    """Requirement: a list takes the first of every key, then the second."""
    listed = """
        case = "cross_axis_pivot"
        sample.method = "list"
        vary.strip.crossing_ratio = [0.2, 0.4]
        vary.strip.inclination_deg = [30, 50]
    """
    assert drawn(listed) == {"strip.crossing_ratio": [0.2, 0.4], "strip.inclination_deg": [30.0, 50.0]}


@pytest.mark.parametrize("text", [GRID, RANDOM], ids=["grid", "sobol"])
def test_a_sample_does_not_depend_on_its_pieces(text):
    """Requirement: the points are the same in one piece and in several."""
    whole = drawn(text)
    assert drawn(text, 1, 5, 7) == whole


def test_random_points_are_those_of_scipy():
    """Requirement: the points are scipy's, spread over the ranges; a logarithmic one in its logarithm."""
    columns = drawn(RANDOM.replace("200\nchunk", "256\nchunk"))
    unit = qmc.Sobol(d=3, seed=0).random(256)
    assert np.allclose(columns["strip.crossing_ratio"], 0.1 + 0.8 * unit[:, 0], rtol=1e-14)
    logarithm = np.log(columns["strip.slenderness"])
    assert np.allclose(logarithm, math.log(20) + math.log(10) * unit[:, 2], rtol=1e-14)


def test_another_seed_is_another_sample():
    """Requirement: the seed counts."""
    assert drawn(RANDOM) != drawn(RANDOM.replace("chunk", "seed = 1\nchunk"))
