"""Critical points of the spline against those of the finite elements, and against published ones."""

import math

import pytest

import fe_reference
from fe_reference import solve_statics as solve_elements
from spline_model import cross_axis_pivot, solve_statics
from tests.fe.cases import extrapolated
from tests.fe.cases import pivot as fe_pivot
from tests.frames import opposed
from tests.gates import hold
from tests.table_one import TABLE_ONE

pytestmark = pytest.mark.slow


def test_first_instability_of_the_pivot_agrees():
    """Requirement: the torque of Table 1 has its first limit at the same rotation in both models."""

    def first(answer):
        (point,) = answer.critical_points
        assert point.kind == "limit point"
        assert answer.inertia.max() == 0
        return math.degrees(point.rotation)

    path = {"rotation": math.radians(320), "increments": 64}
    reference = float(extrapolated([first(solve_elements(fe_pivot(elements=n), **path)) for n in (20, 40)]))

    def error(control_points=20, gauss_points=40):
        pivot = cross_axis_pivot(**TABLE_ONE, control_points=control_points, gauss_points=gauss_points)
        # more points than 20 are lost to round-off, so that none confirm the limit: the elements do
        return abs(first(solve_statics(pivot, **path, check=False)) - reference)

    hold("first_instability", error)


def buckling_deg(answer):
    """Rotation [deg] at which the body on two opposed strips gives way."""
    (point,) = [c for c in answer.critical_points if c.kind == "bifurcation"]
    return math.degrees(point.rotation)


def test_buckling_of_a_driven_body_agrees():
    """Requirement: strips that a driven body pushes together buckle at the same rotation in both models."""
    path = {"rotation": -0.05, "increments": 10}
    meshes = [opposed(fe_reference, elements=n) for n in (10, 20, 40)]
    reference = float(extrapolated([buckling_deg(solve_elements(mesh, **path)) for mesh in meshes]))

    def error(control_points=10):
        found = solve_statics(opposed(control_points=control_points), **path)
        return abs(buckling_deg(found) - reference)

    hold("driven_buckling", error)
