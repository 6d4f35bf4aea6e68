"""Roots that turn: a rotational spring at each clamped end."""

import math

import numpy as np
import pytest

from spline_model.batch import solve_many
from spline_model.compile import compile_scene
from spline_model.dynamics import solve_motion
from spline_model.effects.registry import DEFAULT_EFFECTS
from spline_model.errors import InvalidParameter
from spline_model.mechanism import BodyDesign, StripDesign, mechanism
from spline_model.modes import natural_frequencies
from spline_model.pivot import cross_axis_pivot
from spline_model.reduced.model import from_unknowns, reduced
from spline_model.reduced.whole import whole_tangents
from spline_model.statics import solve_mechanism, solve_statics
from tests import gates
from tests.table_one import SIX, TABLE_ONE

SIDES = {"width": 0.01, "thickness": 0.005}
EXPECTED = 'expected "monolithic" or a number >= 0, its length over the thickness'
ROOTS = (*DEFAULT_EFFECTS, "root_compliance")


def rooted(root="monolithic", **changed):
    """Table 1 with roots of that length over the thickness."""
    given = {"effects": ROOTS, "parameters": {"root_compliance": {"root": root}}}
    return cross_axis_pivot(**SIX | SIDES | given | changed)


def test_roots_lengthen_a_strip_in_pure_bending():
    """A pivot that crosses in the middle has K(0) = 2 EI / (L + 2 c t): roots and strip in series."""

    def error(root=0.416):
        pivot = rooted()
        found = solve_statics(pivot, rotation=0.01, increments=1).stiffness[0]
        longer = TABLE_ONE["length"] + 2.0 * root * SIDES["thickness"]
        return abs(found * longer / (2.0 * pivot.flexural_rigidity) - 1.0)

    gates.check("spline_roots", error())
    with pytest.raises(AssertionError):
        gates.check("spline_roots", error(**gates.teeth("spline_roots")))


def test_roots_turn_by_their_moment_at_any_angle():
    """In a roll-up the tip turns by that of the strip and c t / EI times the moment at each end."""
    strip = StripDesign(
        name="strip", start=(0.0, 0.0), end=(1.0, 0.0), tip="tip", youngs_modulus=2e11, density=1.0,
        width=0.1, thickness=0.05,
    )  # fmt: skip
    tip, root = BodyDesign(name="tip", centre=(1.0, 0.0)), {"root_compliance": {"root": 0.416}}
    made = mechanism(strips=[strip], bodies=[tip], effects=ROOTS, parameters=root)
    path = solve_mechanism(made, rotation=2.0, increments=4)
    moment = strip.flexural_rigidity * 2.0 / (1.0 + 2.0 * 0.416 * 0.05)
    assert path.torque[-1] == pytest.approx(moment, rel=1e-8)
    assert path.bending_energy[-1] == pytest.approx(moment, rel=1e-8)  # half of moment times two radians
    at_root = math.sin(0.416 * 0.05 * moment / strip.flexural_rigidity)
    end = path.states[-1][2:4]  # the second control point stands on the tangent
    assert end[1] / math.hypot(*end) == pytest.approx(at_root, rel=1e-8)


@pytest.mark.parametrize("measure", ["material", "spatial"])
def test_element_is_the_bordered_form(measure):
    """The turns of the roots as coordinates of the elements are the clamps' rows that yield, tangents too."""
    given = {"gravity": {"acceleration": (300.0, -500.0)}, "root_compliance": {"root": "monolithic"}}
    pivot = rooted(measure=measure, effects=(*ROOTS, "gravity"), parameters=given)
    element, bordered = (
        solve_statics(pivot, rotation=1.5, increments=6, method=method)
        for method in ("condensed", "multipliers")
    )
    assert element.torque == pytest.approx(bordered.torque, rel=1e-10)
    assert element.stiffness == pytest.approx(bordered.stiffness, rel=1e-9)
    assert element.bending_energy == pytest.approx(bordered.bending_energy, rel=1e-10)
    model = reduced(compile_scene(pivot.driven(1.5)))
    y = from_unknowns(model, element.states)[-1:]
    step = 1e-6 * np.eye(model.size)
    tangent = whole_tangents(model, y)[1][0]
    near = [whole_tangents(model, y + sign * step)[0] for sign in (1.0, -1.0)]
    assert np.abs((near[0] - near[1]) / 2e-6 - tangent).max() < 1e-6 * np.abs(tangent).max()


def test_work_is_the_energy_of_strips_and_roots():
    """Over a quarter turn the energy of strips and roots is the work of the drive, and roots soften."""

    def error(increments=20):
        path = solve_statics(rooted(), rotation=np.pi / 2, increments=increments)
        assert path.inertia.max() == 0
        return np.abs(path.bending_energy + path.axial_energy - path.work).max() / path.work[-1]

    gates.check("spline_root_work", error())
    with pytest.raises(AssertionError):
        gates.check("spline_root_work", error(**gates.teeth("spline_root_work")))


def test_roots_of_no_length_are_none():
    """A root of no length is a clamp: the same scene, to the last digit."""
    none, plain = (
        solve_statics(pivot, rotation=1.0, increments=4)
        for pivot in (rooted(0.0), rooted(effects=DEFAULT_EFFECTS, parameters=None))
    )
    assert np.array_equal(none.torque, plain.torque)


def test_modes_know_the_roots():
    """The swing of a heavy body at rest goes with the root of its stiffness, and so with its roots."""
    swing = [
        natural_frequencies(rooted(root, body_moment_of_inertia=10.0)).frequency[0] for root in (0.0, 0.416)
    ]
    series = 1.0 + 2.0 * 0.416 * SIDES["thickness"] / TABLE_ONE["length"]
    assert (swing[0] / swing[1]) ** 2 == pytest.approx(series, rel=1e-6)


@pytest.mark.parametrize(
    ("root", "message"),
    [
        (
            "sharp",
            "root: got 'sharp', expected \"monolithic\" or a number >= 0, its length over the thickness",
        ),
        (-1.0, "root: got -1.0, " + EXPECTED),
    ],
)
def test_roots_that_are_none_are_refused(root, message):
    """A word that is not known and a length below zero are refused in one line."""
    with pytest.raises(InvalidParameter) as caught:
        rooted(root)
    assert str(caught.value) == message


def test_what_holds_its_clamps_refuses_roots():
    """Strips without thickness, motions and batches refuse roots that turn, each in one line."""
    with pytest.raises(InvalidParameter, match="thickness of strip_1: got None, expected width and"):
        rooted(width=None, thickness=None)
    with pytest.raises(InvalidParameter, match="effects: got 'root_compliance', expected statics or modes"):
        solve_motion(rooted(), start=0.5, duration=1e-3)
    with pytest.raises(InvalidParameter, match="discretisation: got 'printed forces, long splines or root"):
        solve_many(rooted(), {"thickness": [0.005]}, rotation=0.5)
