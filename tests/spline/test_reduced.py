"""The strips' elements against the bordered system: the same states, whatever the scene."""

import math

import numpy as np
import pytest

from spline_model.compile import compile_scene
from spline_model.mechanism import BodyDesign, StripDesign, mechanism
from spline_model.path import follow
from spline_model.pivot import cross_axis_pivot
from spline_model.reduced.model import at_rest, from_unknowns, reduced
from spline_model.statics import solve_statics
from tests.table_one import TABLE_ONE

STEEL = {
    "area": 5e-6,
    "second_moment_of_area": 1.0416667e-13,
    "youngs_modulus": 206e9,
    "density": 7800.0,
}
FORMS = {
    "mixed": {},
    "spatial": {"measure": "spatial"},
    "inextensible": {"stretch": "inextensible"},
    "inextensible spatial": {"stretch": "inextensible", "measure": "spatial"},
    "consistent": {"stretch": "consistent", "control_points": 5},
    "consistent spatial": {"stretch": "consistent", "measure": "spatial", "control_points": 5},
    "B-spline": {"basis": "bspline", "control_points": 9},
    "four points": {"control_points": 4},
}
FACTORS = (0.25, 0.5, 0.75, 1.0)


def strip(name, start, end, **more):
    """A strip of spring steel, 10 mm x 0.5 mm."""
    return StripDesign(name=name, start=start, end=end, **STEEL, **more)


def stretching(form):
    """The name of the form's stretching effect."""
    return "inextensible" if form.get("stretch") == "inextensible" else "stretching"


def guide(form):
    """Two parallel strips under a body that is pushed aside and weighs."""
    return mechanism(
        strips=[strip("a", (0, 0), (0, 0.1), tip="b"), strip("c", (0.05, 0), (0.05, 0.1), tip="b")],
        bodies=[BodyDesign(name="b", centre=(0.025, 0.1), mass=0.02)],
        effects=("bending", stretching(form), "applied_force", "gravity"),
        parameters={"applied_force": {"force": (2.0, 0.5)}},
        **form,
    ).scene


def free_end(form):
    """A cantilever whose tip is free and loaded."""
    return mechanism(
        strips=[strip("a", (0, 0), (0.1, 0))],
        bodies=[],
        effects=("bending", stretching(form), "tip_force", "gravity"),
        parameters={"tip_force": {"strip": "a", "force": (0.3, 2.0)}},
        **form,
    ).scene


def arc(form):
    """A curved, pre-strained strip with a body."""
    return mechanism(
        strips=[strip("a", (0, 0), (0.1, 0), tip="b", rise=0.02)],
        bodies=[BodyDesign(name="b", centre=(0.11, 0.01))],
        effects=("bending", stretching(form), "applied_force", "pre_strain"),
        parameters={"applied_force": {"force": (0.3, 2.0)}, "pre_strain": {"curvature": 2.0, "strain": 1e-5}},
        **form,
    ).scene


def chain(form):
    """Three strips in a row: from the ground to a body, between two bodies, and back to the ground."""
    return mechanism(
        strips=[
            strip("a", (0, 0), (0.1, 0), tip="b"),
            strip("c", (0.12, 0.01), (0.2, 0.05), root="b", tip="d"),
            strip("e", (0.22, 0.06), (0.25, 0.0), root="d", tip="ground"),
        ],
        bodies=[
            BodyDesign(name="b", centre=(0.11, 0.0), mass=0.1),
            BodyDesign(name="d", centre=(0.21, 0.05), mass=0.1),
        ],
        effects=("bending", stretching(form), "applied_moment", "gravity"),
        parameters={"applied_moment": {"body": "b", "moment": 0.1}},
        **form,
    ).driven(0.1, "d")


def loaded_pivot(form):
    """Table 1 turned the other way under a force, a moment and a led centre's height."""
    return cross_axis_pivot(
        **TABLE_ONE,
        effects=("bending", stretching(form), "applied_moment", "applied_force"),
        parameters={"applied_moment": {"moment": 100.0}, "applied_force": {"force": (3000.0, 5000.0)}},
        **form,
    ).driven(-0.5)


def led_pivot(form):
    """Table 1 turned, its centre led."""
    return cross_axis_pivot(
        **TABLE_ONE,
        effects=("bending", stretching(form), "driven_displacement"),
        parameters={"driven_displacement": {"displacement": (5e-5, -5e-5)}},
        **form,
    ).driven(0.2)


SCENES = {build.__name__: build for build in (guide, free_end, arc, chain, loaded_pivot, led_pivot)}
PAIRS = [(scene, form) for scene in SCENES for form in FORMS if (scene, form) != ("arc", "four points")]
"""All but a curved strip of four points, which does not resolve its pre-strain and is refused."""


@pytest.mark.parametrize(("scene", "form"), PAIRS)
def test_elements_find_the_states_of_the_bordered_system(scene, form):
    """Requirement: states, multipliers, energies, work, stiffness and doubt agree to 1e-9."""
    system = compile_scene(SCENES[scene](FORMS[form]))
    quick, slow = (follow(system, FACTORS, method=method) for method in ("condensed", "multipliers"))
    assert slow.status is quick.status
    assert quick.history == () or slow.message  # on the elements, but for what stops or buckles
    unit = system.scales.unit
    assert np.abs((quick.states - slow.states) / unit).max() < 1e-9
    for name in ("energies", "work", "stiffness"):
        mine, other = getattr(quick, name), getattr(slow, name)
        scale = np.nanmax(np.abs(other), initial=1e-6 * system.scales.energy)
        np.testing.assert_allclose(mine, other, rtol=0.0, atol=1e-9 * scale, err_msg=name)
    np.testing.assert_allclose(quick.moment_defect, slow.moment_defect, atol=1e-7)
    rows = system.tables.drives.row
    np.testing.assert_allclose(quick.rates[:, rows] / unit[rows], slow.rates[:, rows] / unit[rows], atol=1e-8)


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("scene", SCENES)
def test_unknowns_come_back_from_the_elements(scene, form):
    """Requirement: at rest the unknowns are those of straight or curved strips of speed 1 at the clamps."""
    system = compile_scene(SCENES[scene](FORMS[form]))
    model = reduced(system)
    y = at_rest(model)
    own, modes = 2 * len(model.shape.order) - 6, model.strips.compliance.shape[1]
    for s in range(len(model.strips.roots)):
        at = len(model.bodies.rest) + s * (own + modes)
        np.testing.assert_allclose(y[at + own - 2 : at + own], 1.0, rtol=1e-12)
    assert np.array_equal(y, from_unknowns(model, system.rest))


def test_slender_strips_need_no_other_path():
    """Requirement: a slenderness L/h of 1e5 is solved on the elements, next to the inextensible strip."""
    slenderness = 1e5
    design = TABLE_ONE | {
        "second_moment_of_area": TABLE_ONE["area"] * (TABLE_ONE["length"] / slenderness) ** 2 / 12
    }
    thin = solve_statics(cross_axis_pivot(**design), rotation=math.pi / 2)
    limit = solve_statics(cross_axis_pivot(**design, stretch="inextensible"), rotation=math.pi / 2)
    assert thin.history == limit.history == ()
    np.testing.assert_allclose(thin.torque, limit.torque, rtol=1e-7, atol=1e-7 * limit.torque.max())


def test_what_the_elements_do_not_know_is_left_to_the_bordered_system():
    """Requirement: printed forces and long B-splines have no element."""
    printed = cross_axis_pivot(**TABLE_ONE, measure="printed", stretch="consistent", control_points=4)
    assert reduced(compile_scene(printed.driven(1.0))) is None
    long = cross_axis_pivot(**TABLE_ONE, basis="bspline", control_points=40)
    assert reduced(compile_scene(long.driven(1.0))) is None


def test_an_unstable_path_is_left_to_the_bordered_system():
    """Requirement: a column pressed beyond Euler's load is not answered on the elements, and says so."""
    load = 1.5 * math.pi**2 / 4 * STEEL["youngs_modulus"] * STEEL["second_moment_of_area"] / 0.1**2
    column = mechanism(
        strips=[strip("a", (0, 0), (0, 0.1), tip="b")],
        bodies=[BodyDesign(name="b", centre=(0.0, 0.1))],
        effects=("bending", "stretching", "applied_force"),
        parameters={"applied_force": {"force": (0.0, -load)}},
    )
    path = follow(compile_scene(column.scene), FACTORS)
    assert path.history != () and "buckles" in path.message
