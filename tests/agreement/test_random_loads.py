"""Both models on loaded pivots: torque and stiffness, with loads and rotations of either sign."""

import itertools
import math
from functools import cache

import numpy as np
import pytest

import fe_reference
import spline_model
from tests import gates
from tests.table_one import TABLE_ONE

DEGREES = (-30.0, -10.0, 10.0, 30.0)


def random_loads(seed):
    """A force [N], a moment [N m] and a weight of the order that turns Table 1 by a radian."""
    rng = np.random.default_rng(seed)
    return {
        "applied_force": {"force": tuple(rng.uniform(-5e3, 5e3, 2).tolist())},
        "applied_moment": {"moment": float(rng.uniform(-300.0, 300.0))},
        "gravity": {"acceleration": tuple(rng.uniform(-1e3, 1e3, 2).tolist())},
    }


@cache
def path(model, seed, degrees, **discretisation):
    """Solution of a model under random loads, driven to a rotation [deg]."""
    loads = random_loads(seed)
    pivot = model.cross_axis_pivot(
        **TABLE_ONE, effects=("bending", "stretching", *loads), parameters=loads, **discretisation
    )
    return model.solve_statics(pivot, rotation=math.radians(degrees), increments=3, order="together")


def differences(quantity, control_points=8):
    """Largest difference of a quantity on random paths, over its largest value on the path."""
    worst = 0.0
    for seed, degrees in itertools.product((1, 2), DEGREES):
        spline = getattr(path(spline_model, seed, degrees, control_points=control_points), quantity)
        elements = getattr(path(fe_reference, seed, degrees, elements=40), quantity)
        worst = max(worst, float(np.abs(spline - elements).max() / np.abs(elements).max()))
    return worst


@pytest.mark.parametrize("quantity", ["torque", "stiffness"])
def test_models_agree_under_random_loads(quantity):
    """Requirement: torque and stiffness of loaded pivots agree, whatever the signs of loads and rotation."""
    gates.check(f"agreement_loaded_{quantity}", differences(quantity))


@pytest.mark.parametrize("quantity", ["torque", "stiffness"])
def test_loaded_agreement_gates_have_teeth(quantity):
    """Requirement: the checks notice fewer control points."""
    gate = f"agreement_loaded_{quantity}"
    with pytest.raises(AssertionError, match="x the gate"):
        gates.check(gate, differences(quantity, **gates.teeth(gate)))
