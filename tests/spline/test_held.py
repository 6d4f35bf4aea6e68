"""A body held in a pose: strips solved one by one, against the bordered system with driven constraints."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from spline_model import (
    DrivenDisplacement,
    DrivenRotation,
    HeldPivot,
    cross_axis_pivot,
    solve_mechanism,
    solve_statics,
)
from tests import gates
from tests.table_one import SIX, TABLE_ONE

THIN = {"area": 5e-6, "second_moment_of_area": 1.041e-13, "youngs_modulus": 1.4e9}
ROOTS = {
    "width": 0.01,
    "thickness": 0.005,
    "effects": ("bending", "stretching", "root_compliance"),
    "parameters": {"root_compliance": {"root": "monolithic"}},
}
ROBUST = {"penalty_stiffness": 1000.0}
POSES = ((0.0004, -0.0003, 0.3), (-0.0008, 0.0002, -0.6), (0.0, 0.001, 1.2))
"""Displacement of the centre from where a free turn would have it [m, m], and rotation [rad]."""


def held(shift, rotation, **settings):
    """Solver and state of the pivot held away from the centre of a free turn."""
    pivot = cross_axis_pivot(**(SIX | settings))
    solver = HeldPivot(pivot)
    centre = solver.turn(rotation).pose[:2]
    solver.reset()
    return solver, solver.hold(*(centre + shift), rotation)


def disagreement(pose, increments=8, slide=None, **settings):
    """Largest relative difference of force and control points to the multiplier path of the same pose."""
    *shift, rotation = pose
    solver, state = held(np.array(shift), rotation, **settings)
    other = {} if slide is None else {"penalty_stiffness": slide}
    pivot = cross_axis_pivot(**(SIX | settings | other))
    reference, displacement = pivot, state.pose[:2] - pivot.centre
    drives = (
        DrivenRotation(body="body", angle=rotation),
        DrivenDisplacement(body="body", displacement=tuple(displacement)),
    )
    led = replace(reference, scene=reference.scene.with_effects(*drives))
    path = solve_mechanism(led, increments=increments)
    system, z = path.system, path.states[-1]
    rows = system.layout.multipliers[-2:]
    torque = z[rows[0][0]]
    force = z[rows[1][0] : rows[1][0] + 2]
    full = solver.full_state(system)
    points = slice(0, system.layout.coordinate_count)
    strips = [full[system.layout.strip(strip.name)].reshape(-1, 2) for strip in system.scene.strips]
    assert np.abs(solver.control_points - np.array(strips)).max() < 1e-15
    assert state.solved
    return max(
        abs(state.force[2] - torque) / abs(torque),
        np.abs(state.force[:2] - force).max() / np.abs(force).max(),
        np.abs(full - z)[points].max() / TABLE_ONE["length"],
    )


@pytest.mark.parametrize("scene", [{}, ROOTS], ids=["clamps", "roots that turn"])
@pytest.mark.parametrize("pose", POSES, ids=str)
def test_agrees_with_the_multiplier_path(pose, scene):
    """Requirement: forces, moment and shape are those of the driven rotation and displacements to 1e-9."""
    gates.check("spline_held_pose", disagreement(pose, **scene))


def test_another_penalty_stiffness_is_another_pose():
    """Requirement: the check notices a penalty stiffness that differs by a per mille."""
    gates.refuse("spline_held_pose", partial(disagreement, POSES[2]))


def test_tangent_is_the_derivative_of_the_force():
    """Requirement: the tangent is the central difference of force and moment in the pose, and symmetric."""
    solver, state = held(np.array([0.0003, 0.0002]), 0.4)
    known, step = solver.unknowns, np.array([1e-7, 1e-7, 1e-6])
    columns = []
    for k in range(3):
        ends = []
        for sign in (1.0, -1.0):
            solver.restore(known)
            ends.append(solver.hold(*(state.pose + sign * step * (np.arange(3) == k))).force)
        columns.append((ends[0] - ends[1]) / (2 * step[k]))
    scale = np.sqrt(np.outer(np.diag(state.tangent), np.diag(state.tangent)))
    assert np.abs((np.array(columns).T - state.tangent) / scale).max() < 1e-6


def test_a_pose_in_which_strips_buckle_is_refused():
    """Requirement: pushed straight towards the ground past the Euler load, the strips' straight shape is
    unstable: the last good state is kept, and how far it went is said."""
    pivot = cross_axis_pivot(**(SIX | THIN | ROBUST))
    solver = HeldPivot(pivot)
    known = solver.unknowns
    far, near = (solver.hold(pivot.centre[0], pivot.centre[1] + shift, 0.0) for shift in (-0.004, -4e-6))
    assert not far.solved
    assert 0.0 <= far.reached < 1.0
    assert near.solved
    solver.restore(known)
    assert np.array_equal(solver.unknowns, known)


def test_warm_start_needs_few_iterations():
    """Requirement: from one frame to the next, 2 degrees on, at most four Newton iterations a strip."""
    pivot = cross_axis_pivot(**SIX)
    path = solve_statics(pivot, rotation=1.0, increments=30)
    solver = HeldPivot(pivot)
    work = [
        solver.hold(*centre, angle).iterations
        for angle, centre in zip(path.rotation, path.centre, strict=True)
    ]
    assert max(work) <= 8
