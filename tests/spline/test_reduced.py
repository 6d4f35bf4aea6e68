"""Strips as elements, in segments and held in a pose: the answers of the paper's bordered system."""

import math
import sys
from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from numba.core.registry import CPUDispatcher

import spline_model as spline
from tests import gates
from tests.frames import STEEL, one_strip
from tests.models import scene
from tests.table_one import BARE, SIDES, SIX, TABLE_ONE

FORMS = {
    "mixed": {"control_points": 6},
    "inextensible": {"stretch": "inextensible", "control_points": 6},
    "consistent spatial": {"stretch": "consistent", "measure": "spatial", "control_points": 5},
    "segments": {"segments": 2, "control_points": 6},
    "all axial modes": {"control_points": 8, "axial_modes": 7},
}
METHODS = ("condensed", "multipliers")


def strip(name, start, end, **more):
    """A strip of spring steel, 10 mm x 0.5 mm."""
    return spline.StripDesign(name=name, start=start, end=end, **STEEL | {"density": 7800.0}, **more)


def elastic(form, **parameters):
    """The effects of a form, and others with their parameters, as keywords."""
    stretching = "inextensible" if form.get("stretch") == "inextensible" else "stretching"
    return form | scene(("bending", stretching), **parameters)


def arc(form):
    """A curved, pre-strained strip with a body."""
    given = {"applied_force": {"force": (0.3, 2.0)}, "pre_strain": {"curvature": 2.0, "strain": 1e-5}}
    body = spline.BodyDesign(name="b", centre=(0.11, 0.01))
    bent = strip("a", (0, 0), (0.1, 0), tip="b", rise=0.02)
    return spline.compliant_mechanism(strips=[bent], bodies=[body], **elastic(form, **given)), {}


def chain(form):
    """Three strips in a row: from the ground to a body, between two bodies, and back to the ground."""
    strips = [
        strip("a", (0.0, 0.0), (0.1, 0.01), tip="b"),
        strip("c", (0.12, 0.01), (0.2, 0.05), root="b", tip="d"),
        strip("e", (0.22, 0.06), (0.25, 0.0), root="d", tip="ground"),
    ]
    places = {"b": (0.11, 0.0), "d": (0.21, 0.05)}
    bodies = [spline.BodyDesign(name=name, centre=centre, mass=0.01) for name, centre in places.items()]
    given = elastic(form, applied_moment={"body": "b", "moment": 0.01}, gravity={})
    return spline.compliant_mechanism(strips=strips, bodies=bodies, **given), {"rotation": 0.1, "body": "d"}


def led_pivot(form):
    """Table 1, its centre led."""
    led = {"displacement": (5e-5, -5e-5)}
    return spline.cross_axis_pivot(**TABLE_ONE, **elastic(form, driven_displacement=led)), {"rotation": 0.2}


def rooted_pivot(form):
    """Table 1 under a weight, its strips' roots cut from the same block."""
    given = {"gravity": {"acceleration": (300.0, -500.0)}, "root_compliance": {"root": "monolithic"}}
    return spline.cross_axis_pivot(**TABLE_ONE | SIDES, **elastic(form, **given)), {"rotation": 1.5}


def solved(build, form, method):
    """The path of a scene in four increments, by a method."""
    made, how = build(FORMS[form])
    return spline.solve_statics(
        made, increments=4, order="together", method=method, check=False, raise_on_failure=False, **how
    )


SCENES = (arc, chain, led_pivot, rooted_pivot)
PAIRS = [(scene, form) for scene in SCENES for form in FORMS if (scene, form) != (led_pivot, "inextensible")]


@pytest.mark.parametrize(("build", "form"), PAIRS)
def test_elements_find_the_states_of_the_bordered_system(build, form):
    """Requirement: states, multipliers, energies, work, stiffness and doubt agree to 1e-9."""
    quick, slow = (solved(build, form, method) for method in METHODS)
    assert slow.status is quick.status
    assert np.abs((quick.states - slow.states) / slow.system.scales.unit).max() < 1e-9
    alike = quick.counters["halved_increments"] == slow.counters["halved_increments"]
    for name in ("energies", "work", "stiffness"):
        mine, other = getattr(quick, name), getattr(slow, name)
        scale = np.nanmax(np.abs(other), initial=1e-6 * slow.system.scales.energy)
        error = 1e-9 if alike or name != "work" else 1e-5  # a quadrature over other steps
        np.testing.assert_allclose(mine, other, rtol=0.0, atol=error * scale, err_msg=name)
    np.testing.assert_allclose(quick.moment_defect, slow.moment_defect, atol=1e-7)


@pytest.mark.parametrize("method", METHODS)
def test_both_refuse_what_cannot_move(method):
    """Requirement: leading the centre of a pivot with inextensible strips is refused by both."""
    with pytest.raises(spline.InvalidParameter, match="singular"):
        solved(led_pivot, "inextensible", method)


WIDE = BARE | {"width": 0.03, "thickness": 0.002}
#: Effects that act along a whole strip, and what they are given.
ALONG = ("gravity", "pre_strain", "clamped_width")
GIVEN = {"gravity": {"acceleration": (2e2, -9e2)}, "pre_strain": {"strain": 1e-3}, "clamped_width": {}}
PLACES = ("shape", "axial_force", "bending_moment", "shear_force", "clamp_reactions", "bodies")


def apart(one, other, names):
    """Largest difference of arrays of two answers, each over the largest magnitude."""
    pairs = [(getattr(one, name), getattr(other, name)) for name in names]
    pairs = [
        (next(iter(a.values())), next(iter(b.values()))) if isinstance(a, dict) else (a, b) for a, b in pairs
    ]
    return max(float(np.abs(a - b).max() / np.abs(b).max()) for a, b in pairs)


def made(**grid):
    """The pivot of Table 1 with wide strips and effects along them."""
    return spline.cross_axis_pivot(
        **WIDE, effects=(*spline.DEFAULT_EFFECTS, *ALONG), parameters=GIVEN, **grid
    )


def test_a_pivot_in_segments_answers_as_a_whole_one():
    """Forces, shapes, reactions and fields along the strips are those of one curve with many points."""

    def error(segments=3, control_points=9):
        pivots = made(segments=segments, control_points=control_points), made(control_points=17)
        paths = [
            replace(spline.solve_statics(each, rotation=0.9, increments=3), balanced=True) for each in pivots
        ]
        fields = [spline.strip_fields(each, path.states) for each, path in zip(pivots, paths, strict=True)]
        curves = ("arc_length", "rest_shape", "rotation", "stretch", "reactions", "rest_bodies")
        numbers = ("torque", "stiffness", "work", "bending_energy", "own_stiffness")
        return max(apart(*paths, (*PLACES, *numbers)), apart(*fields, curves))

    gates.hold("spline_segments", error)


@pytest.mark.slow
def test_a_strip_in_tension_is_resolved_by_default():
    """Under a pull of 1e4 EI/L^2 a tip turns in a layer a hundredth of the strip long.

    Exact of a half-infinite strip, of which the rest is e^-100 away: what is the same all along it is
    M^2 / 2 EI + F cos(turn) + (F cos(turn))^2 / 2 EA.
    """
    pull, turn = 1e4, 0.5
    section = {"area": 12e6, "second_moment_of_area": 1.0, "youngs_modulus": 1.0, "density": 1.0}
    pulled = {"applied_force": {"force": (pull, 0.0)}}
    strip = one_strip(spline, pulled, pulled, end=(1.0, 0.0), section=section)
    path = spline.solve_statics(strip, rotation=turn, increments=4)
    stored = pull * (1.0 - math.cos(turn)) + (pull * math.sin(turn)) ** 2 / (2.0 * 12e6)
    assert path.segments > 1
    assert path.torque[-1] == pytest.approx(math.sqrt(2.0 * stored), rel=1e-4)


SOFT = {"area": 5e-6, "second_moment_of_area": 1.041e-13, "youngs_modulus": 1.4e9}
ROOTS = SIDES | scene(("bending", "stretching"), root_compliance={"root": "monolithic"})
ROBUST = {"penalty_stiffness": 1000.0}
POSES = ((0.0004, -0.0003, 0.3), (-0.0008, 0.0002, -0.6), (0.0, 0.001, 1.2))
"""Displacement of the centre from where a free turn would have it [m, m], and rotation [rad]."""


def held(shift, rotation, **settings):
    """Solver and state of the pivot held away from the centre of a free turn."""
    pivot = spline.cross_axis_pivot(**(SIX | settings))
    solver = spline.HeldPivot(pivot)
    centre = solver.turn(rotation).pose[:2]
    solver.reset()
    return solver, solver.hold(*(centre + shift), rotation)


def disagreement(pose, increments=8, slide=None, **settings):
    """Largest relative difference of force and control points to the multiplier path of the same pose."""
    *shift, rotation = pose
    solver, state = held(np.array(shift), rotation, **settings)
    other = {} if slide is None else {"penalty_stiffness": slide}
    pivot = spline.cross_axis_pivot(**(SIX | settings | other))
    reference, displacement = pivot, state.pose[:2] - pivot.design.bodies[0].centre
    drives = (
        spline.DrivenRotation(body="body", angle=rotation),
        spline.DrivenDisplacement(body="body", displacement=tuple(displacement)),
    )
    led = replace(reference, scene=reference.scene.with_effects(*drives))
    path = spline.solve_statics(led, increments=increments)
    system, z = path.system, path.states[-1]
    rows = system.layout.multipliers[-2:]
    torque = z[rows[0][0]]
    force = z[rows[1][0] : rows[1][0] + 2]
    full = solver.full_state(system)
    points = slice(0, system.layout.coordinate_count)
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
    pivot = spline.cross_axis_pivot(**(SIX | SOFT | ROBUST))
    solver = spline.HeldPivot(pivot)
    known = solver.unknowns
    x, y = pivot.design.bodies[0].centre
    far, near = (solver.hold(x, y + shift, 0.0) for shift in (-0.004, -4e-6))
    assert not far.solved
    assert 0.0 <= far.reached < 1.0
    assert near.solved
    solver.restore(known)
    assert np.array_equal(solver.unknowns, known)


def test_warm_start_needs_few_iterations():
    """Requirement: from one frame to the next, 2 degrees on, at most four Newton iterations a strip."""
    pivot = spline.cross_axis_pivot(**SIX)
    path = spline.solve_statics(pivot, rotation=1.0, increments=30)
    solver = spline.HeldPivot(pivot)
    work = [
        solver.hold(*centre, angle).iterations
        for angle, centre in zip(path.rotation, path.centre, strict=True)
    ]
    assert max(work) <= 8


def test_mechanisms_of_one_structure_have_their_own_numbers():
    """A pivot solved behind one of other numbers has the answer of a pivot that shares nothing with it."""
    alone = scene(spline.DEFAULT_EFFECTS, pre_strain={"strain": 0.0})
    for change in ({"length": 0.07}, {"inclination": 0.6}, {"area": 1e-6}, {"crossing_ratio": 0.3}):
        spline.solve_statics(spline.cross_axis_pivot(**SIX), rotation=0.3, increments=2)
        given = SIX | change
        mine = spline.solve_statics(spline.cross_axis_pivot(**given), rotation=[0.5, -0.2], increments=2)
        right = spline.solve_statics(
            spline.cross_axis_pivot(**given, **alone), rotation=[0.5, -0.2], increments=2
        )
        size = np.abs(right.states).max(axis=0) + 1e-9
        assert np.abs((mine.states - right.states) / size).max() < 1e-8
        np.testing.assert_allclose(mine.torque, right.torque, rtol=1e-10, atol=1e-12)


def kinds_of_arguments():
    """How many kinds of arguments each kernel was compiled for, by its module and name."""
    modules = [module for name, module in sys.modules.items() if name.startswith("spline_model.")]
    found = [each for module in modules for each in vars(module).values() if isinstance(each, CPUDispatcher)]
    return {(each.py_func.__module__, each.py_func.__name__): len(each.signatures) for each in found}


INERTIA = ("strip_inertia", "body_inertia")
DAMPED = SIX | scene(spline.DEFAULT_EFFECTS, strip_damping={"relaxation_time": 1e-5})
SHORT = {"start": 0.3, "duration": 1e-7, "step": 1e-8}


def alone():
    """One strip with a body at its tip."""
    return one_strip(spline, INERTIA, {}, section=STEEL | {"density": 7800.0}, mass=0.1, control_points=6)


@pytest.mark.parametrize(
    "solve, integrator, other",
    [
        (spline.solve_motion, {}, lambda: spline.cross_axis_pivot(**DAMPED)),
        (spline.solve_motion, {"integrator": "leapfrog"}, alone),
        (spline.solve_impulses, {}, lambda: spline.cross_axis_pivot(**DAMPED)),
    ],
)
def test_kernels_are_compiled_for_one_kind_of_arguments(solve, integrator, other):
    """Requirement: another effect, or another number of strips, compiles no kernel again."""
    solve(spline.cross_axis_pivot(**SIX), **SHORT, **integrator)
    known = kinds_of_arguments()
    solve(other(), **SHORT, **integrator)
    assert kinds_of_arguments() == known
