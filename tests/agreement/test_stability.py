"""Critical points of the spline against those of the finite elements."""

import math

import numpy as np
import pytest
from fe_reference.arc_length import follow_arc

from fe_reference import BodyDesign, StripDesign, compliant_mechanism
from fe_reference.control import spans
from fe_reference.structure import structure_of
from spline_model import cross_axis_pivot, solve_loads, solve_statics
from tests import gates
from tests.fe import frames as fe_frames
from tests.fe.cases import extrapolated
from tests.fe.cases import pivot as fe_pivot
from tests.spline import frames as spline_frames
from tests.table_one import TABLE_ONE

pytestmark = pytest.mark.slow


def spline_limits(scene, load):
    """Loads of the critical points of a spline frame."""
    path = solve_loads(scene, control="arc-length")[1]
    return load * np.array([c.load_factor for c in path.critical_points])


def fe_limits(make, load, meshes=(10, 20, 40)):
    """The same of the finite elements, extrapolated."""
    found = [[c.parameter for c in follow_arc(make(elements=count)).critical] for count in meshes]
    return load * np.asarray(extrapolated(found))


def disagreement(name, **settings):
    """Largest relative difference of limit loads."""
    load = {"toggle": 60.0, "lees_frame": 3.0}[name]
    scene = getattr(spline_frames, name)(**settings)
    found = spline_limits(getattr(scene, "scene", scene), load)
    reference = fe_limits(getattr(fe_frames, name), load)
    return float(np.abs(found / reference - 1.0).max())


@pytest.mark.parametrize("name", ["toggle", "lees_frame"])
def test_limit_loads_agree(name):
    """Requirement: both models find the same limit loads, in number and value."""
    gates.check(f"limit_loads_{name}", disagreement(name, control_points=12))
    with pytest.raises(AssertionError, match="x the gate"):
        gates.check(f"limit_loads_{name}", disagreement(name, **gates.teeth(f"limit_loads_{name}")))


def first_limit_deg(**settings):
    """Rotation [deg] of the first critical point of Table 1, by the spline."""
    pivot = cross_axis_pivot(**TABLE_ONE, **settings)
    answer = solve_statics(pivot, rotation=math.radians(320), increments=64)
    (point,) = answer.critical_points
    assert point.kind == "limit point"
    assert answer.inertia.max() == 0
    return math.degrees(point.rotation)


def test_first_instability_of_the_pivot_agrees():
    """Requirement: the torque of Table 1 has its first limit at the same rotation in both models."""
    found = []
    for elements in (20, 40):
        structure = structure_of(fe_pivot(elements=elements))
        rotation = math.radians(320)
        control = spans(structure, body=0, rotations=[rotation], watched=int(structure.turns[0]))[0]
        path = follow_arc(control, increments=64)
        (point,) = path.critical
        assert point.kind == "limit point"
        assert max(state.inertia for state in path.states) == 0
        found.append(320.0 * point.parameter)
    reference = float(extrapolated(found))
    gates.check("first_instability", abs(first_limit_deg(control_points=20, gauss_points=40) - reference))
    with pytest.raises(AssertionError, match="x the gate"):
        coarse = first_limit_deg(**gates.teeth("first_instability"))
        gates.check("first_instability", abs(coarse - reference))


def buckling_deg(**settings):
    """Rotation [deg] at which the body on two opposed strips gives way, by the spline."""
    answer = solve_statics(spline_frames.opposed(**settings), rotation=-0.05, increments=10)
    (point,) = [c for c in answer.critical_points if c.kind == "bifurcation"]
    return math.degrees(point.rotation)


def fe_buckling_deg(elements, offset=0.01, half=0.05):
    """The same by the finite elements."""
    section = fe_frames.section_of(
        **{n: TABLE_ONE[n] for n in ("area", "second_moment_of_area", "youngs_modulus")}
    )
    ends = (((-half, -offset), (half, -offset)), ((half, offset), (-half, offset)))
    model = compliant_mechanism(
        strips=[
            StripDesign(name=f"strip_{i}", start=a, end=b, tip="body", **section)
            for i, (a, b) in enumerate(ends)
        ],
        bodies=[BodyDesign(name="body", centre=(0.0, 0.0))],
        effects=("bending", "stretching"),
        elements=elements,
    )
    structure = structure_of(model)
    control = spans(structure, body=0, rotations=[-0.05], watched=int(structure.turns[0]))[0]
    (point,) = [c for c in follow_arc(control).critical if c.kind == "bifurcation"]
    return math.degrees(-0.05 * point.parameter)


def test_buckling_of_a_driven_body_agrees():
    """Requirement: strips that a driven body pushes together buckle at the same rotation in both models."""
    reference = float(extrapolated([fe_buckling_deg(count) for count in (10, 20, 40)]))
    gates.check("driven_buckling", abs(buckling_deg(control_points=10) - reference))
    with pytest.raises(AssertionError, match="x the gate"):
        gates.check("driven_buckling", abs(buckling_deg(**gates.teeth("driven_buckling")) - reference))
