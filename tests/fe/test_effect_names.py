"""An effect with nothing in it leaves statics and motions as they are without it."""

import numpy as np
import pytest

from fe_reference import DEFAULT_EFFECTS, solve_motion, solve_statics
from tests.fe.cases import LENGTH, pivot
from tests.spline.test_effects import ZERO

MOTIONS = ({"step": 1e-7}, {"integrator": "generalised-alpha", "step": 1e-5})


@pytest.mark.parametrize("name", ZERO)
def test_zero_equals_absent(name: str) -> None:
    """An effect with a coefficient of zero gives the path and the motion of either scheme without it."""
    scene = {"effects": (*DEFAULT_EFFECTS, name), "parameters": {name: ZERO[name]}}
    bare, named = pivot(elements=4), pivot(elements=4, **scene)
    paths = [solve_statics(each, rotation=0.4, increments=5, order="together") for each in (bare, named)]
    assert np.abs(paths[0].torque - paths[1].torque).max() <= 1e-14 * paths[0].torque[-1]
    for how in MOTIONS:
        runs = [solve_motion(each, start=0.4, duration=1e-4, check=False, **how) for each in (bare, named)]
        assert np.ptp(runs[0].rotation) > 1e-6
        assert np.abs(runs[0].shape - runs[1].shape).max() <= 1e-14 * LENGTH
