"""The strips' elements against the paper's bordered system: the same answers, whatever the scene."""

import numpy as np
import pytest

from spline_model import (
    BodyDesign,
    InvalidParameter,
    StripDesign,
    compliant_mechanism,
    cross_axis_pivot,
    solve_mechanism,
)
from tests.frames import STEEL
from tests.refusals import scene
from tests.table_one import SIDES, TABLE_ONE

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
    return StripDesign(name=name, start=start, end=end, **STEEL | {"density": 7800.0}, **more)


def elastic(form, **parameters):
    """The effects of a form, and others with their parameters, as keywords."""
    stretching = "inextensible" if form.get("stretch") == "inextensible" else "stretching"
    return form | scene(("bending", stretching), **parameters)


def arc(form):
    """A curved, pre-strained strip with a body."""
    given = {"applied_force": {"force": (0.3, 2.0)}, "pre_strain": {"curvature": 2.0, "strain": 1e-5}}
    body = BodyDesign(name="b", centre=(0.11, 0.01))
    bent = strip("a", (0, 0), (0.1, 0), tip="b", rise=0.02)
    return compliant_mechanism(strips=[bent], bodies=[body], **elastic(form, **given)), {}


def chain(form):
    """Three strips in a row: from the ground to a body, between two bodies, and back to the ground."""
    strips = [
        strip("a", (0.0, 0.0), (0.1, 0.01), tip="b"),
        strip("c", (0.12, 0.01), (0.2, 0.05), root="b", tip="d"),
        strip("e", (0.22, 0.06), (0.25, 0.0), root="d", tip="ground"),
    ]
    places = {"b": (0.11, 0.0), "d": (0.21, 0.05)}
    bodies = [BodyDesign(name=name, centre=centre, mass=0.01) for name, centre in places.items()]
    given = elastic(form, applied_moment={"body": "b", "moment": 0.01}, gravity={})
    return compliant_mechanism(strips=strips, bodies=bodies, **given), {"rotation": 0.1, "body": "d"}


def led_pivot(form):
    """Table 1, its centre led."""
    led = {"displacement": (5e-5, -5e-5)}
    return cross_axis_pivot(**TABLE_ONE, **elastic(form, driven_displacement=led)), {"rotation": 0.2}


def rooted_pivot(form):
    """Table 1 under a weight, its strips' roots cut from the same block."""
    given = {"gravity": {"acceleration": (300.0, -500.0)}, "root_compliance": {"root": "monolithic"}}
    return cross_axis_pivot(**TABLE_ONE | SIDES, **elastic(form, **given)), {"rotation": 1.5}


def solved(build, form, method):
    """The path of a scene in four increments, by a method."""
    made, how = build(FORMS[form])
    return solve_mechanism(
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
    with pytest.raises(InvalidParameter, match="singular"):
        solved(led_pivot, "inextensible", method)
