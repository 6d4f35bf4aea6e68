"""The 3 x 3 stiffness of a body: both models agree, and it is what is known of it in closed form."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest

import fe_reference
import spline_model
from studies.answers.settings import FeSettings, SplineSettings
from studies.cases.design import named_design
from studies.cases.effects import DEFAULT, Effects
from tests import gates
from tests.agreement.loaded import LOADS, design, solution
from tests.table_one import TABLE_ONE

MESHES = FeSettings(elements=20), FeSettings(elements=40)


def apart(asked, body=None, control_points=10):
    """Largest difference of the spline from the limit of two meshes, over the largest entry of its units."""
    coarse, fine = (solution(asked, mesh)[0].body_stiffness(body) for mesh in MESHES)
    limit = (4.0 * fine - coarse) / 3.0
    found = solution(asked, SplineSettings(control_points=control_points))[0].body_stiffness(body)
    unit = np.sqrt(np.abs(np.einsum("sii->si", limit)).max(axis=0))
    return float((np.abs(found - limit) / (unit[:, None] * unit)).max())


@pytest.mark.parametrize("effect", LOADS)
def test_body_stiffness_agrees(effect):
    """Requirement: under every load, along a path, both models give a body the same stiffness."""
    gates.check("body_stiffness", apart(design(effect)))
    if effect == "applied_force":
        gates.refuse("body_stiffness", partial(apart, design(effect)))


@pytest.mark.parametrize("body", [None, "coupler"])
def test_body_stiffness_of_a_linkage_agrees(body):
    """Requirement: so they do for the driven body of a linkage, and for another one while that is held."""
    gates.check("body_stiffness", apart(named_design("four_bar_of_flexures"), body))


@pytest.mark.parametrize("body", ["coupler", "rocker"])
def test_body_stiffness_beside_a_led_body_agrees(body):
    """Requirement: a centre that is led one way holds the others that way alone, and no turn that is free."""
    asked = named_design("four_bar_of_flexures")
    led = {"driven_displacement": {"displacement": (2e-3, None), "body": "rocker"}}
    effects = Effects(names=(*DEFAULT, *led), tables=led)
    gates.check("body_stiffness", apart(replace(asked, rotation=None, increments=3, effects=effects), body))


@pytest.mark.parametrize(
    ("package", "how"),
    [
        (spline_model, {"control_points": 6}),
        (spline_model, {"control_points": 5, "segments": 2}),
        (fe_reference, {"elements": 8}),
    ],
)
def test_body_stiffness_holds_that_of_the_rotation(package, how):
    """Requirement: with x and y released it is d(torque)/d(rotation), in every form of the models."""
    path = package.solve_statics(package.cross_axis_pivot(**TABLE_ONE, **how), rotation=0.6, increments=3)
    released = 1.0 / np.linalg.inv(path.body_stiffness())[:, 2, 2]
    assert released == pytest.approx(path.stiffness, rel=1e-8)


def test_strips_that_cannot_stretch_leave_no_stiffness_at_rest():
    """Requirement: straight inextensible strips hold the body in x and y without end: there is no number."""
    pivot = spline_model.cross_axis_pivot(**TABLE_ONE, control_points=6, stretch="inextensible")
    found = spline_model.solve_statics(pivot, rotation=0.6, increments=2).body_stiffness()
    assert np.isnan(found[0]).all()
    assert np.isfinite(found[1:]).all()
