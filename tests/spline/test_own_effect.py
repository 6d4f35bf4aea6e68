"""A new effect is one class and one line; scenes that make no sense are refused."""

from dataclasses import dataclass

import numpy as np
import pytest

from spline_model import (
    DEFAULT_EFFECTS,
    InvalidParameter,
    cross_axis_pivot,
    natural_frequencies,
    solve_mechanism,
    solve_motion,
)
from spline_model.compile import compile_scene
from spline_model.continuation.followed import Followed
from spline_model.effects import registry
from spline_model.effects.base import OpenPotential
from tests.spline.effect_scenes import scene_with
from tests.table_one import SIX, TABLE_ONE


@pytest.mark.parametrize(
    "effects, parameters, line",
    [
        (("bending", "gravty"), {}, "effects: got 'gravty', expected one of bending, .*nearest: gravity"),
        (("bending", "stretching", "shear"), {}, r"'shear', expected .* \(use --model fe-shear\)"),
        (("bending", "stretching", "inextensible"), {}, "not both"),
        (("bending",), {}, "stretching or inextensible beside bending"),
        (("stretching",), {}, "bending, without which"),
        (DEFAULT_EFFECTS, {"gravity": {}}, "an effect of the scene"),
        ((*DEFAULT_EFFECTS, "strip_drag"), {"strip_drag": {"speed": 1.0}}, "only rate"),
        ((*DEFAULT_EFFECTS, "strip_drag"), {"strip_drag": {"rate": -1.0}}, "rate: got -1.0"),
        ((*DEFAULT_EFFECTS, "bending"), {}, "each name once"),
    ],
    ids=str,
)
def test_senseless_scenes_are_refused(effects, parameters, line):
    """Requirement: unknown, contradictory and missing effects are one clear line that lists what there is."""
    with pytest.raises(InvalidParameter, match=line):
        cross_axis_pivot(**TABLE_ONE, effects=effects, parameters=parameters)


def test_a_motion_without_inertia_is_refused():
    """Requirement: dynamics without any inertia says which effects would give it some."""
    pivot = cross_axis_pivot(**TABLE_ONE, effects=("bending", "stretching"))
    with pytest.raises(InvalidParameter, match="strip_inertia, section_rotary_inertia, body_inertia"):
        solve_motion(pivot, start=0.5)


@dataclass(frozen=True, kw_only=True)
class GroundSpring(OpenPotential):
    """The toy of CONTRIBUTING: a linear spring from a body's centre to the point where it rests."""

    body: str
    stiffness: float
    rest: tuple[float, float]

    def derivatives(self, q, layout):
        """V = 1/2 k |r - r0|^2."""
        at = layout.body(self.body)
        place = np.arange(at.start, at.start + 2)
        gap = q[place] - self.rest
        gradient, hessian = np.zeros(len(q)), np.zeros((len(q), len(q)))
        gradient[place] = self.stiffness * gap
        hessian[place, place] = self.stiffness
        return 0.5 * self.stiffness * gap @ gap, gradient, hessian


def ground_spring(design, stiffness):
    """The registry's entry of the toy effect."""
    for body in design.bodies:
        yield GroundSpring(body=body.name, stiffness=stiffness, rest=body.centre)


def test_a_new_effect_is_one_class_and_one_line(monkeypatch):
    """Requirement: an effect added by the recipe of CONTRIBUTING works in statics, modes and motion."""
    monkeypatch.setitem(registry.REGISTRY, "ground_spring", ground_spring)
    names = (*DEFAULT_EFFECTS, "ground_spring")
    pivot = cross_axis_pivot(**SIX, effects=names, parameters={"ground_spring": {"stiffness": 1e5}})
    plain = solve_mechanism(scene_with(), rotation=1.0)
    sprung = solve_mechanism(pivot, rotation=1.0)
    assert sprung.torque[-1] > 1.05 * plain.torque[-1]
    assert natural_frequencies(pivot).frequency[0] >= natural_frequencies(scene_with()).frequency[0]
    run = solve_motion(pivot, start=1.0, duration=0.002, integrator="generalised-alpha")
    assert run.status.value == "converged"
    with pytest.raises(InvalidParameter, match="generalised-alpha"):
        solve_motion(pivot, start=1.0, duration=0.002)
    work = Followed.of(compile_scene(pivot.scene))
    assert work.system.open_potentials[0].stiffness == 1e5
