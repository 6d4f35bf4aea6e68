"""Control points that are chosen for one design or for many, and what their estimates are about."""

import math

import numpy as np
import pytest

from spline_model import cross_axis_pivot, solve_many, solve_statics
from tests.table_one import TABLE_ONE

ACCURACY = 1e-4


def loaded(**changes):
    """The pivot of Table 1 under a force at its body."""
    effects = ("bending", "stretching", "applied_force")
    return cross_axis_pivot(
        **TABLE_ONE, effects=effects, parameters={"applied_force": {"force": (200.0, -3000.0)}}, **changes
    )


def spread(count=40, rotation=60.0):
    """Designs over most of the space, their rotation in degrees."""
    generator = np.random.default_rng(3)
    designs = TABLE_ONE | {
        "crossing_ratio": generator.uniform(0.05, 0.95, count),
        "inclination": np.radians(generator.uniform(15.0, 75.0, count)),
    }
    return designs, math.radians(rotation)


@pytest.mark.parametrize("order", ["loads first", "together", None])
def test_one_and_many_have_one_order_of_loads(order):
    """Requirement: loads come on before the rotation by default, in a batch as in a single solve."""
    how = {"rotation": 0.9, "increments": 6} | ({} if order is None else {"order": order})
    one, many = solve_statics(loaded(), **how), solve_many(loaded(), {"youngs_modulus": [2.06e11]}, **how)
    torque = one.torque[-7:]
    assert many.torque[0] == pytest.approx(torque, abs=1e-8 * np.abs(torque).max())
    assert many.control_points[0] == one.control_points
    assert (abs(torque[0]) > 1.0) == (order != "together")  # it holds the loaded body


def test_every_design_of_a_batch_gets_the_points_that_it_takes():
    """Requirement: designs of a batch are within 1e-4 of answers with many more control points."""
    designs, rotation = spread()
    how = {"rotation": rotation, "increments": 6, "section_depth": 4e-3}
    found, right = solve_many(designs, **how), solve_many(designs, **how, control_points=19)
    assert found.resolved.all()
    assert len(np.unique(found.control_points)) > 1
    for name in ("torque", "stiffness", "energy", "strain"):
        mine, good = getattr(found, name), getattr(right, name)
        error = np.abs(mine - good).max(axis=1) / np.abs(good).max(axis=1)
        assert error.max() < ACCURACY
        assert (error < 1.5 * found.errors[name] + 1e-9).all()  # the estimate knows it
    assert found.resolution(0) == ""


def test_a_design_of_a_batch_that_misses_its_accuracy_is_told():
    """Requirement: where no number of control points reaches the accuracy, the row has this status."""
    designs, rotation = spread(2, 90.0)
    batch = solve_many(designs, rotation=rotation, increments=4, section_depth=4e-3, accuracy=1e-13)
    assert batch.converged.all()
    assert not batch.resolved.any()
    assert batch.resolution(1).startswith("estimated error above 1e-13 with ")
    assert "strain" in batch.resolution(1)


def test_what_a_path_lacks_has_no_error():
    """Requirement: strains that nobody asks for have no estimate, not one of 0; body stiffness and
    energy have theirs."""
    estimate = solve_statics(loaded(), rotation=0.7, increments=3).estimate
    assert 0.0 < estimate.body_stiffness <= ACCURACY
    assert 0.0 < estimate.energy <= ACCURACY
    batch = solve_many(loaded(), {}, rotation=0.7, increments=3)
    assert math.isnan(batch.errors["strain"][0])
