"""The strips' elements against the bordered system: the same states, whatever the scene."""

import numpy as np
import pytest

from spline_model import (
    BodyDesign,
    InvalidParameter,
    StripDesign,
    compliant_mechanism,
    cross_axis_pivot,
)
from spline_model.compile import compile_scene
from spline_model.path import follow
from tests.frames import STEEL
from tests.table_one import TABLE_ONE

FORMS = {
    "mixed": {},
    "inextensible": {"stretch": "inextensible"},
    "consistent": {"stretch": "consistent", "control_points": 5},
    "consistent spatial": {"stretch": "consistent", "measure": "spatial", "control_points": 5},
    "segments": {"segments": 2, "control_points": 6},
    "four points": {"control_points": 4},
    "all axial modes": {"control_points": 8, "axial_modes": 7},
}
FACTORS = (0.25, 0.5, 0.75, 1.0)


def strip(name, start, end, **more):
    """A strip of spring steel, 10 mm x 0.5 mm."""
    return StripDesign(name=name, start=start, end=end, **STEEL | {"density": 7800.0}, **more)


def stretching(form):
    """The name of the form's stretching effect."""
    return "inextensible" if form.get("stretch") == "inextensible" else "stretching"


def arc(form):
    """A curved, pre-strained strip with a body."""
    return compliant_mechanism(
        strips=[strip("a", (0, 0), (0.1, 0), tip="b", rise=0.02)],
        bodies=[BodyDesign(name="b", centre=(0.11, 0.01))],
        effects=("bending", stretching(form), "applied_force", "pre_strain"),
        parameters={"applied_force": {"force": (0.3, 2.0)}, "pre_strain": {"curvature": 2.0, "strain": 1e-5}},
        **form,
    ).scene


def chain(form):
    """Three strips in a row: from the ground to a body, between two bodies, and back to the ground."""
    return compliant_mechanism(
        strips=[
            strip("a", (0.0, 0.0), (0.1, 0.01), tip="b"),
            strip("c", (0.12, 0.01), (0.2, 0.05), root="b", tip="d"),
            strip("e", (0.22, 0.06), (0.25, 0.0), root="d", tip="ground"),
        ],
        bodies=[
            BodyDesign(name="b", centre=(0.11, 0.0), mass=0.01),
            BodyDesign(name="d", centre=(0.21, 0.05), mass=0.01),
        ],
        effects=("bending", stretching(form), "applied_moment", "gravity"),
        parameters={"applied_moment": {"body": "b", "moment": 0.01}},
        **form,
    ).driven(0.1, "d")


def led_pivot(form):
    """Table 1 turned, its centre led."""
    return cross_axis_pivot(
        **TABLE_ONE,
        effects=("bending", stretching(form), "driven_displacement"),
        parameters={"driven_displacement": {"displacement": (5e-5, -5e-5)}},
        **form,
    ).driven(0.2)


def rooted_pivot(form):
    """Table 1 under its weight, its strips' roots cut from the same block."""
    return cross_axis_pivot(
        **TABLE_ONE,
        width=0.01,
        thickness=0.005,
        effects=("bending", stretching(form), "gravity", "root_compliance"),
        parameters={"gravity": {"acceleration": (300.0, -500.0)}, "root_compliance": {"root": "monolithic"}},
        **form,
    ).driven(1.5)


SCENES = {build.__name__: build for build in (arc, chain, led_pivot, rooted_pivot)}
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
def test_both_stop_where_pre_strain_is_not_resolved(method):
    """Requirement: four control points of an arc do not resolve its pre-strain: the path does not begin."""
    path = follow(compile_scene(arc(FORMS["four points"])), FACTORS, method=method)
    assert not path.settled
    assert "do not resolve" in path.message


@pytest.mark.parametrize("method", ["condensed", "multipliers"])
def test_both_refuse_what_cannot_move(method):
    """Requirement: leading the centre of a pivot with inextensible strips is refused by both."""
    with pytest.raises(InvalidParameter, match="singular"):
        follow(compile_scene(led_pivot(FORMS["inextensible"])), FACTORS, method=method)
