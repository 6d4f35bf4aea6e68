"""Properties that hold for any design and any number of control points."""

import math

import numpy as np
import pytest

from spline_model import cross_axis_pivot, solve_statics
from tests import gates
from tests.table_one import SIX, TABLE_ONE

QUARTER = math.pi / 2


def solved(rotation=QUARTER, increments=20, method="condensed", **settings):
    """Static solution of Table 1 with settings."""
    pivot = cross_axis_pivot(**(SIX | settings))
    return solve_statics(pivot, rotation=rotation, increments=increments, method=method)


def torque_against_energy(**settings):
    """Largest error of the torque against dU/d(theta), over the torque, at four angles.

    Sixth-order central differences; step 0.02 rad leaves less than 1e-10 of truncation.
    """
    step, weights = 0.02, np.array([-1, 9, -45, 0, 45, -9, 1]) / 60
    errors = []
    for angle in (0.3, 0.7, 1.1, 1.5):
        around = angle + step * np.arange(-3, 4)
        solution = solved(rotation=list(around), increments=1, **settings)
        energy = (solution.bending_energy + solution.axial_energy)[1:]
        errors.append(abs(weights @ energy / step / solution.torque[4] - 1))
    return max(errors)


def stiffness_against_torque(step=0.02, **settings):
    """Largest error of K against the sixth-order difference of the torque."""
    weights = np.array([-1, 9, -45, 0, 45, -9, 1]) / 60
    solution = solved(rotation=list(1.1 + step * np.arange(-3, 4)), increments=1, **settings)
    return abs(weights @ solution.torque[1:] / step / solution.stiffness[4] - 1)


def balance_of_reactions(end=1, **settings):
    """Largest imbalance of the clamps' forces on the strips and of the body's moments, over the torque.

    end : the clamp whose reactions are taken for the body's, 1 being right.
    """
    solution = solved(**settings)
    reactions = solution.clamp_reactions
    length, peak = TABLE_ONE["length"], np.abs(solution.torque).max()
    forces = np.abs(reactions[..., :2].sum(axis=(1, 2))).max() * length / peak
    arms = solution.shape[:, :, -1] - solution.centre[:, None]
    on_strips = reactions[:, :, end]
    moments = on_strips[..., 2] + arms[..., 0] * on_strips[..., 1] - arms[..., 1] * on_strips[..., 0]
    return max(forces, np.abs(moments.sum(axis=1) - solution.torque).max() / peak)


def mirror(**settings):
    """Largest difference between +90 and -90 deg, in torque over its peak and path over L."""
    there, back = solved(**settings), solved(rotation=-QUARTER, **settings)
    axis = 2 * TABLE_ONE["crossing_ratio"] * TABLE_ONE["length"] * math.cos(TABLE_ONE["inclination"])
    image = np.column_stack((axis - back.centre[:, 0], back.centre[:, 1]))
    torque = np.abs(there.torque + back.torque).max() / there.torque.max()
    return max(torque, np.abs(there.centre - image).max() / TABLE_ONE["length"])


def frame(turned_by=0.7, **settings):
    """Largest difference after a rotation of the whole pivot, against its image turned by 0.7 rad."""
    plain, turned = solved(**settings), solved(orientation=turned_by, **settings)
    turn = np.array([[math.cos(0.7), -math.sin(0.7)], [math.sin(0.7), math.cos(0.7)]])
    torque = np.abs(plain.torque - turned.torque).max() / plain.torque.max()
    return max(torque, np.abs(plain.centre @ turn.T - turned.centre).max() / TABLE_ONE["length"])


def unloaded_return(back_to=0.0, **settings):
    """Torque left after 90 deg and back, over its peak."""
    solution = solved(rotation=[QUARTER, back_to], **settings)
    return np.abs(solution.torque[-1]) / solution.torque.max()


CHECKS = {
    "spline_torque_is_energy_derivative": torque_against_energy,
    "spline_stiffness_is_torque_derivative": stiffness_against_torque,
    "spline_balance_of_reactions": balance_of_reactions,
}
SYMMETRIES = {
    "spline_mirror": mirror,
    "spline_rigid_rotation": frame,
    "spline_unloaded_return": unloaded_return,
}
FORMS = (
    {},
    {"control_points": 4},
    {"control_points": 9, "basis": "bspline"},
    {"stretch": "inextensible"},
    {"stretch": "consistent", "measure": "spatial", "control_points": 4},
    {"crossing_ratio": 0.2, "inclination": math.radians(30), "centre_offset": (0.01, 0.02)},
)


@pytest.mark.parametrize("settings", FORMS, ids=str)
@pytest.mark.parametrize("gate", CHECKS)
def test_work_and_balance(gate, settings):
    """Requirement: torque = dU/d(theta), K = dT/d(theta) and the reactions balance, in every form."""
    gates.check(gate, CHECKS[gate](**settings))
    if not settings:
        gates.refuse(gate, CHECKS[gate])


@pytest.mark.parametrize("gate", SYMMETRIES)
def test_symmetries(gate):
    """Requirement: mirror image, rigid rotation and the way back give the same answer, for any n."""
    methods = ("condensed", "multipliers")
    errors = [SYMMETRIES[gate](control_points=n, method=m) for n in (4, 6, 8, 10, 12) for m in methods]
    gates.check(gate, max(errors))
    gates.refuse(gate, SYMMETRIES[gate])


def test_body_offset_only_moves_the_reported_point():
    """Requirement: a centre of mass off the plate changes its path, not the torque."""
    plain, moved = solved(), solved(centre_offset=(0.01, -0.02))
    turn = np.stack(
        [
            np.stack((np.cos(plain.rotation), -np.sin(plain.rotation)), -1),
            np.stack((np.sin(plain.rotation), np.cos(plain.rotation)), -1),
        ],
        axis=1,
    )
    expected = plain.centre + turn @ np.array([0.01, -0.02])
    gates.check("spline_rigid_rotation", np.abs(moved.centre - expected).max() / TABLE_ONE["length"])
    gates.check("spline_rigid_rotation", np.abs(moved.torque - plain.torque).max() / plain.torque.max())
