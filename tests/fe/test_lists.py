"""Definitions that are lists: several loads, drives, supports and springs, against closed forms."""

import numpy as np
import pytest

from fe_reference import solve_mechanism
from tests.fe.scenes import four_bar, free_cantilever


def test_loads_add_up() -> None:
    """Several loads of a kind act as their sum: forces and moments, on bodies and at a free end."""
    pulls = [{"force": (300.0, 0.0), "body": "coupler"}, {"force": (0.0, -200.0), "body": "coupler"}]
    twists = [{"moment": 2.0, "body": "crank"}, {"moment": -5.0, "body": "crank"}]
    sums = {"force": (300.0, -200.0), "body": "coupler"}, [{"moment": -3.0, "body": "crank"}]
    one, other = (
        solve_mechanism(four_bar({"applied_force": f, "applied_moment": m}, elements=3), increments=3).states
        for f, m in ((pulls, twists), sums)
    )
    assert np.abs(one[-1]).max() > 1e-3
    assert np.abs(one - other).max() < 1e-9 * np.abs(one).max()
    ends = [{"strip": "strip", "force": (0.0, 2.0)}, {"strip": "strip", "force": (0.0, -2.0), "moment": 0.3}]
    bent = solve_mechanism(free_cantilever(parameters={"tip_force": ends}, elements=4), increments=3)
    assert bent.bending_moment[-1, 0] == pytest.approx(0.3, rel=1e-9)
