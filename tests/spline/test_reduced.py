"""The strips' elements against the bordered system: the same states, whatever the scene."""

import math

import numpy as np
import pytest

from spline_model.compile import compile_scene
from spline_model.continuation.arc_length import follow_arc
from spline_model.errors import InvalidParameter
from spline_model.mechanism import BodyDesign, StripDesign, mechanism
from spline_model.path import follow
from spline_model.pivot import cross_axis_pivot
from spline_model.reduced.model import at_rest, from_unknowns, reduced
from spline_model.reduced.states import whole_tangents
from spline_model.statics import solve_statics
from tests.spline.frames import column, opposed, toggle
from tests.spline.test_branches import heavy, strained
from tests.table_one import SIX, TABLE_ONE

STEEL = {
    "area": 5e-6,
    "second_moment_of_area": 1.0416667e-13,
    "youngs_modulus": 206e9,
    "density": 7800.0,
}
FORMS = {
    "mixed": {},
    "inextensible": {"stretch": "inextensible"},
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
REFUSED = [("arc", "four points"), ("led_pivot", "inextensible")]
"""A curved strip of four points does not resolve its pre-strain, inextensible strips hold their centre."""
PAIRS = [(scene, form) for scene in SCENES for form in FORMS if (scene, form) not in REFUSED]


@pytest.mark.parametrize(("scene", "form"), PAIRS)
def test_elements_find_the_states_of_the_bordered_system(scene, form):
    """Requirement: states, multipliers, energies, work, stiffness and doubt agree to 1e-9."""
    system = compile_scene(SCENES[scene](FORMS[form]))
    quick, slow = (follow(system, FACTORS, method=method) for method in ("condensed", "multipliers"))
    assert slow.status is quick.status
    assert quick.history == () or slow.message  # compiled, but for what stops or buckles
    unit = system.scales.unit
    assert np.abs((quick.states - slow.states) / unit).max() < 1e-9
    alike = quick.counters["halved_increments"] == slow.counters["halved_increments"]
    for name in ("energies", "work", "stiffness"):
        mine, other = getattr(quick, name), getattr(slow, name)
        scale = np.nanmax(np.abs(other), initial=1e-6 * system.scales.energy)
        error = 1e-9 if alike or name != "work" else 1e-5  # a quadrature over other steps
        np.testing.assert_allclose(mine, other, rtol=0.0, atol=error * scale, err_msg=name)
    np.testing.assert_allclose(quick.moment_defect, slow.moment_defect, atol=1e-7)


@pytest.mark.parametrize("method", ["condensed", "multipliers"])
@pytest.mark.parametrize(("scene", "form"), REFUSED)
def test_both_refuse_what_has_no_path(scene, form, method):
    """Requirement: what does not resolve its pre-strain, or leads what cannot move, is refused by both."""
    with pytest.raises(InvalidParameter, match=r"do not resolve|singular"):
        follow(compile_scene(SCENES[scene](FORMS[form])), FACTORS, method=method)


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
    np.testing.assert_allclose(y, from_unknowns(model, system.rest), rtol=1e-14, atol=1e-15)


def test_slender_strips_need_no_other_path():
    """Requirement: a slenderness L/t of 1e5 is solved on the elements, next to the inextensible strip."""
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


def buckling_column():
    """A column pressed to one and a half times Euler's load."""
    load = 1.5 * math.pi**2 / 4 * STEEL["youngs_modulus"] * STEEL["second_moment_of_area"] / 0.1**2
    return mechanism(
        strips=[strip("a", (0, 0), (0, 0.1), tip="b")],
        bodies=[BodyDesign(name="b", centre=(0.0, 0.1))],
        effects=("bending", "stretching", "applied_force"),
        parameters={"applied_force": {"force": (0.0, -load)}},
    ).scene


WATCHED = {
    "column": lambda: column(load=4.0, control_points=8).scene,
    "pre-strained": lambda: strained(41.0).driven(0.0),
    "heavy": lambda: heavy(30.0, 0.0).scene,
    "toggle": lambda: toggle(control_points=8).scene,
    "opposed": lambda: opposed(offset=0.03, control_points=8).driven(-0.3),
    "inextensible": lambda: column(load=4.0, effects=("bending", "inextensible")).scene,
}


@pytest.mark.parametrize("name", WATCHED)
def test_elements_find_the_critical_points_of_the_bordered_system(name):
    """Requirement: critical points, their modes, stability, status and what is said are the same on both."""
    system = compile_scene(WATCHED[name]())
    quick, slow = (
        follow(system, np.linspace(0.0, 1.0, 9)[1:], method=method) for method in ("condensed", "multipliers")
    )
    said = [
        path.message.partition(" (no convergence")[0] for path in (quick, slow)
    ]  # its residual is round-off
    assert (quick.status, said[0]) == (slow.status, said[1])
    assert np.array_equal(quick.inertia, slow.inertia)
    assert np.abs((quick.states - slow.states) / system.scales.unit).max() < 1e-8
    unit = system.scales.unit[: system.layout.coordinate_count]
    assert len(quick.critical_points) == len(slow.critical_points)
    for mine, other in zip(quick.critical_points, slow.critical_points, strict=True):
        assert (mine.kind, mine.inertia) == (other.kind, other.inertia)
        assert abs(mine.load_factor / other.load_factor - 1) < 1e-6
        assert np.abs((mine.mode - other.mode) / unit).max() < 1e-5


def test_arc_length_is_the_same_on_the_elements():
    """Requirement: a path through two limit points ends in the same state on both, with the same limits."""
    system = compile_scene(toggle(control_points=6).scene)
    quick, slow = (follow_arc(system, method=method) for method in ("condensed", "multipliers"))
    assert np.abs((quick.states[-1] - slow.states[-1]) / system.scales.unit).max() < 1e-8
    loads = [[c.load_factor for c in path.critical_points] for path in (quick, slow)]
    np.testing.assert_allclose(*loads, rtol=1e-7)
    assert len(loads[0]) == 2


def test_an_increment_in_which_nothing_happens_stays_compiled():
    """Requirement: on a column that buckles only the increment where it does is taken in steps."""
    path = follow(compile_scene(buckling_column()), np.linspace(0.0, 1.0, 21)[1:])
    assert len(path.history) == 1
    assert "buckles" in path.message
    assert path.inertia[-1] == 1


@pytest.mark.parametrize("control_points", [6, 15])
def test_an_unloaded_pivot_is_at_rest(control_points):
    """Requirement: before anything acts there is no torque and no reaction, not their round-off."""
    pivot = cross_axis_pivot(**TABLE_ONE, control_points=control_points)
    answer = solve_statics(pivot, rotation=0.3, increments=2)
    assert answer.torque[0] == 0.0
    assert not answer.clamp_reactions[0].any()


@pytest.mark.parametrize("more", [(), ("root_compliance",)])
def test_confirmed_states_have_the_torque_and_stiffness_of_all_derivatives(more):
    """Requirement: states confirmed without a tangent are those of gradient and Hessian in all unknowns."""
    roots = {"parameters": {"root_compliance": {"root": "monolithic"}}, "width": 0.01, "thickness": 0.005}
    given = roots if "root_compliance" in more else {}
    pivot = cross_axis_pivot(**SIX, effects=("bending", "stretching", *more), **given)
    system = compile_scene(pivot.driven(0.5))
    path = follow(system, np.linspace(0.0, 1.0, 7)[1:])
    assert path.counters["residual_evaluations"] >= path.counters["tangent_evaluations"] + 5
    model = reduced(system)
    gradient, hessian = whole_tangents(model, from_unknowns(model, path.states))
    turn, free = 2, np.delete(np.arange(model.size), 2)
    assert np.abs(gradient[:, free]).max() < 1e-12
    torque = path.states[:, system.drives.row[0]]
    np.testing.assert_allclose(model.energy * gradient[:, turn], torque, atol=1e-14 * torque.max())
    for state, k in enumerate(hessian):
        through = k[turn, turn] - k[turn, free] @ np.linalg.solve(k[np.ix_(free, free)], k[free, turn])
        assert path.stiffness[state] == pytest.approx(model.energy * through, rel=1e-12)
