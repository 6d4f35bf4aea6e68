"""Loads beside a driven rotation: their sign, and the stiffness of the loaded pivot."""

import math

import numpy as np
import pytest

from spline_model import cross_axis_pivot, solve_mechanism, solve_statics
from tests.table_one import TABLE_ONE

MOMENT = 100.0  # N m
FORCE = {"force": (3000.0, 5000.0)}
LED = {"displacement": (5e-4, -5e-4)}
LOADS = {
    "moment": {"applied_moment": {"moment": MOMENT}},
    "force": {"applied_force": FORCE},
    "led": {"driven_displacement": LED},
    "all": {
        "applied_moment": {"moment": -60.0},
        "applied_force": FORCE,
        "gravity": {"acceleration": (300.0, -500.0)},
        "pre_strain": {"curvature": 1.0, "strain": 1e-4},
    },
}


def loaded(parameters, **settings):
    """The pivot of Table 1 under loads, by the names and parameters of their effects."""
    effects = ("bending", "stretching", *parameters)
    return cross_axis_pivot(
        **(TABLE_ONE | {"control_points": 8} | settings), effects=effects, parameters=parameters
    )


def turned(parameters, degrees, **how):
    """The loaded pivot's path to a rotation [deg], its loads growing with it."""
    how = {"increments": 5, "order": "together"} | how
    return solve_statics(loaded(parameters), rotation=math.radians(degrees), **how)


@pytest.mark.parametrize("name", ["moment", "force"])
def test_a_path_there_and_back_carries_the_load_with_it(name):
    """Requirement: loads go with the size of the rotation over the largest; work is energy."""
    legs = [math.radians(d) for d in (-10.0, -30.0, -5.0)]
    path = solve_statics(loaded(LOADS[name]), rotation=legs, increments=3, order="together")
    assert np.allclose(path.load_factor, np.abs(path.rotation) / math.radians(30))
    direct = turned(LOADS[name], -30.0)
    row = int(np.argmin(path.rotation))
    assert abs(path.torque[row] / direct.torque[-1] - 1) < 1e-9
    energy = path.bending_energy + path.axial_energy
    assert np.abs(path.work - energy).max() < 1e-3 * energy.max()


def test_a_held_pivot_tips_where_its_own_stiffness_vanishes():
    """Requirement: under growing loads a limit of the torque is where the stiffness vanishes, in newtons."""
    made = loaded({"applied_force": {"force": (0.0, -5e4)}})
    answers = [solve_statics(made, rotation=0.0, increments=count) for count in (3, 10)]
    answers.append(solve_statics(made, rotation=math.radians(0.01), increments=10))
    factors = []
    for answer in answers:
        (point,) = answer.critical_points
        assert point.kind == "limit point"
        assert "stiffness vanishes" in answer.message
        assert f"force {5e1 * point.load_factor:.4g} kN" in answer.message
        factors.append(point.load_factor)
    assert max(factors) - min(factors) < 1e-4
    free = solve_mechanism(made, increments=10, raise_on_failure=False)
    assert abs(free.critical_points[0].load_factor - factors[0]) < 1e-4


def test_a_ramp_of_load_makes_no_limit_of_the_torque():
    """Requirement: where the torque turns because a moment grows beside it, there is no limit point."""
    answer = turned({"applied_moment": {"moment": 270.0}}, 30.0, increments=20)
    assert (np.diff(answer.torque) < 0).any()
    assert (np.diff(answer.torque) > 0).any()
    assert answer.critical_points == ()
    assert answer.message == ""


def first(name, degrees, **how):
    """The path under loads that come on before the rotation [deg]."""
    return solve_statics(loaded(LOADS[name]), rotation=np.radians(degrees), **({"increments": 4} | how))


@pytest.mark.parametrize("name", [name for name in LOADS if name != "led"])
def test_loads_come_on_first_and_stay(name):
    """Requirement: the body is held while loads grow; they are in full on the rotation, whatever its sign."""
    path = first(name, [20.0, -30.0])
    assert np.allclose(path.load_factor, np.minimum(np.arange(13) / 4, 1.0))
    assert np.allclose(np.degrees(path.rotation[4:]), [*np.linspace(0, 20, 5), *np.linspace(20, -30, 5)[1:]])
    assert not path.rotation[:4].any()
    for row, degrees in ((8, 20.0), (12, -30.0)):
        direct = turned(LOADS[name], degrees)
        for quantity in ("torque", "stiffness"):
            assert abs(getattr(path, quantity)[row] / getattr(direct, quantity)[-1] - 1) < 1e-8
    energy = path.bending_energy + path.axial_energy + path.gravity_energy
    assert np.abs(path.work - (energy - energy[0])).max() < 1e-3 * energy.max()


def test_loads_first_by_both_methods_and_for_any_mechanism():
    """Requirement: the paper's bordered system and the mechanism of one body have the same path."""
    path, other = first("all", -25.0), first("all", -25.0, method="multipliers")
    body = solve_mechanism(loaded(LOADS["all"]), rotation=math.radians(-25.0), increments=4)
    for same in (other, body):
        assert np.allclose(same.torque, path.torque, rtol=0, atol=1e-9 * np.abs(path.torque).max())
        assert np.array_equal(same.load_factor, path.load_factor)
