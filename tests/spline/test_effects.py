"""Effects: each is exact, and a scene of all of them balances its work and energies."""

import numpy as np
import pytest

from spline_model import (
    DEFAULT_EFFECTS,
    DrivenRotation,
    cross_axis_pivot,
    motion_penalty_stiffness,
    solve_impulses,
    solve_mechanism,
    solve_motion,
)
from tests import gates
from tests.spline.effect_scenes import PARAMETERS, scene_with
from tests.spline.swings import drift
from tests.table_one import TABLE_ONE

#: The same effects at zero: legal, and the same answer as without them.
ZERO = {
    "gravity": {"acceleration": (0.0, 0.0)},
    "strip_damping": {"relaxation_time": 0.0},
    "strip_drag": {"rate": 0.0},
    "body_damping": {},
    "applied_force": {"force": (0.0, 0.0)},
    "applied_moment": {"moment": 0.0},
    "pre_strain": {"curvature": 0.0, "strain": 0.0},
}


def static_balance(increments=160):
    """Imbalance of work and energies over 0 to 0.5 rad with every static effect, over the energy."""
    names = ("gravity", "applied_force", "applied_moment", "driven_displacement", "tip_force")
    solution = solve_mechanism(scene_with(*names), rotation=0.5, increments=increments)
    energy = solution.bending_energy + solution.axial_energy + solution.gravity_energy
    return np.abs(energy - energy[0] - solution.work).max() / energy.max()


def motion_balance(booked=1.0):
    """Imbalance of work, energies and loss over 0.05 s with every effect and a catch, over the energy.

    booked : the share of the loss that is counted, 1 being right.
    """
    names = (
        "gravity",
        "section_rotary_inertia",
        "strip_damping",
        "strip_drag",
        "body_damping",
        "applied_force",
        "applied_moment",
    )
    scene = scene_with(*names, penalty_stiffness=motion_penalty_stiffness(6))
    drive = DrivenRotation(body="body", angle=1.0, history=((0.02, 0.0), (0.03, -0.6)), held=(0.02, 0.035))
    run = solve_motion(scene, start=1.2, duration=0.05, step=5e-5, drive=drive)
    assert run.status.value == "converged", run.message
    assert run.dissipated[-1] > 10  # J: the damping and the catch do take part
    assert abs(run.work[-1]) > 10
    energy = run.kinetic_energy + run.strain_energy + run.gravity_energy
    return np.abs(energy - energy[0] - run.work + booked * run.dissipated).max() / energy[0]


def test_static_work_is_the_change_of_energy():
    """Requirement: work of loads and drives = change of strain and gravity energy."""
    gates.hold("spline_static_balance", static_balance)


def test_work_in_motion_is_the_change_of_energy_and_the_loss():
    """Requirement: with damping, loads, a catch and a drive, the balance holds at the default step."""
    gates.hold("spline_motion_balance", motion_balance)


def test_pre_strained_strips_keep_their_energy():
    """Requirement: strips whose natural strain is in the law of a point move without losing energy."""
    pivot = cross_axis_pivot(
        **TABLE_ONE,
        control_points=5,
        stretch="consistent",
        effects=(*DEFAULT_EFFECTS, "pre_strain"),
        parameters={"pre_strain": {"curvature": 1.0, "strain": 1e-3}},
    )
    run = solve_motion(pivot, start=0.5, duration=2e-3, step=5e-5, check=False)
    gates.check("spline_motion_balance", drift(run))


@pytest.mark.parametrize("name", ZERO)
def test_zero_equals_absent(name):
    """Requirement: an effect with zero coefficients gives the answer of a scene without it."""
    plain = solve_mechanism(scene_with(), rotation=1.0, increments=8)
    zero = solve_mechanism(scene_with(name, parameters=ZERO), rotation=1.0, increments=8, order="together")
    assert np.abs(zero.torque - plain.torque).max() <= 1e-14 * np.abs(plain.torque).max()
    for solve in (solve_motion, solve_impulses):
        run, same = (
            solve(scene, start=1.0, duration=0.002, step=1e-4)
            for scene in (scene_with(), scene_with(name, parameters=ZERO))
        )
        assert np.abs(run.rotation - same.rotation).max() <= 1e-14


def frame_difference(turned_by=0.7):
    """Difference of a scene with every effect and its image turned by 0.7 rad: rotations, over 20 ms."""
    names = (
        "gravity",
        "section_rotary_inertia",
        "strip_damping",
        "strip_drag",
        "body_damping",
        "applied_force",
    )
    turn = np.array([[np.cos(turned_by), -np.sin(turned_by)], [np.sin(turned_by), np.cos(turned_by)]])
    given = {name: PARAMETERS[name] for name in names if name in PARAMETERS}
    turned = given | {
        "gravity": {"acceleration": tuple(turn @ given["gravity"]["acceleration"])},
        "applied_force": {"force": tuple(turn @ given["applied_force"]["force"])},
    }
    runs = [
        solve_motion(
            cross_axis_pivot(
                **TABLE_ONE, orientation=angle, effects=DEFAULT_EFFECTS + names, parameters=parameters
            ),
            start=1.2,
            duration=0.02,
        )
        for angle, parameters in ((0.0, given), (0.7, turned))
    ]
    return np.abs(runs[0].rotation - runs[1].rotation).max()


def test_effects_are_frame_indifferent():
    """Requirement: a scene turned as a whole, with its loads, moves in the same way."""
    gates.hold("spline_effects_frame", frame_difference)
