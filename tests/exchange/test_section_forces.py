"""Section forces, their signs and stresses: balance of cut strips, both models alike, motions."""

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest

from studies.answers.adapters import answer_release, answer_static
from studies.answers.settings import FeSettings, Settings, SplineSettings
from studies.cases.design import Design, named_design, read_design
from studies.exchange import tables
from tests import gates
from tests.one_strip import one_strip

SPLINE, ELEMENTS = SplineSettings(control_points=12), FeSettings(elements=40)
SHEAR = FeSettings(elements=20, element="reissner")
GRAVITY = 9.81


def design_of(case: str) -> Design:
    return replace(named_design(case), increments=8)


@cache
def solved(case: str, settings: Settings) -> Any:
    return static_fields(design_of(case), settings)


def static_fields(design: Design, settings: Settings) -> Any:
    return answer_static(design, settings).along


def force(fields: Any, state: int = -1) -> np.ndarray:
    """Force of the part beyond on the part before (G, P, 2) [N], in the fixed frame."""
    rest = np.diff(fields.rest_shape, axis=1)
    angle = fields.rotation[state] + np.arctan2(rest[:, :1, 1], rest[:, :1, 0])  # straight strips
    along, across = fields.axial_force[state], fields.shear_force[state]
    c, s = np.cos(angle), np.sin(angle)
    return np.stack((along * c - across * s, along * s + across * c), axis=-1)


def cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def imbalance(fields: Any) -> float:
    """Largest defect of a strip cut anywhere, of its force and of its moment, over the largest of each."""
    pull, reaction = force(fields), fields.reactions[-1, :, 0]
    apart = np.abs(pull + reaction[:, None, :2]).max() / np.abs(pull).max()
    arm = fields.shape[-1] - fields.shape[-1, :, :1]
    moment = fields.bending_moment[-1] + reaction[:, None, 2] - cross(arm, reaction[:, None, :2])
    return max(apart, np.abs(moment).max() / np.abs(fields.bending_moment[-1]).max())


@pytest.mark.parametrize("settings", [FeSettings(elements=20), SHEAR], ids=lambda s: s.model)
def test_elements_balance_where_they_are_cut(settings):
    """Without distributed load an element strip's force is constant and its moment linear in position."""
    # Newton stops at residuals of 1e-9 EI/L^2 or below, and N is thousands of times that unit
    assert imbalance(solved("cross_axis_pivot", settings)) < 1e-8


def difference(fine: Any, other: Any) -> float:
    """Largest difference of N, V and M between elements and the spline, over the largest of each."""
    worst = 0.0
    for name in ("axial_force", "shear_force", "bending_moment"):
        values, against = getattr(other, name)[-1], getattr(fine, name)[-1]
        for strip, (value, known) in enumerate(zip(values, against, strict=True)):
            at = fine.arc_length[strip], other.arc_length[strip]
            apart = np.abs(
                known[::15] - np.interp(at[0][::15], at[1], value)
            ).max()  # quarters: nodes of both
            worst = max(worst, apart / np.abs(against).max())
    return worst


def test_both_models_agree_on_section_forces():
    """Spline and shear-rigid elements have the same section forces at a quarter turn."""
    fine = solved("cross_axis_pivot", SPLINE)
    gates.hold(
        "section_forces_agree",
        lambda elements=40: difference(fine, solved("cross_axis_pivot", FeSettings(elements=elements))),
    )


@pytest.mark.parametrize("settings", [SPLINE, SplineSettings(control_points=4), ELEMENTS, SHEAR], ids=str)
def test_clamps_carry_the_weight_of_the_strip(settings):
    """Forces at both ends of a heavy strip hold its weight, and so does the change of its section force."""
    fields, strip = solved("cantilever_with_body", settings), named_design("cantilever_with_body").strips[0]
    weight = strip.area * strip.density * float(fields.arc_length[0, -1]) * GRAVITY
    last_digit = 4.0 * np.finfo(float).eps * strip.area * strip.youngs_modulus  # of a strain, as a force
    close = {"rel": 1e-8, "abs": 1e-8 * weight + last_digit}
    ends = fields.reactions[-1, 0, :, :2].sum(axis=0)
    assert ends == pytest.approx([0.0, weight], **close)
    pull = force(fields)[0]
    if settings in (ELEMENTS, SHEAR):  # N of the spline follows from its strains and has their error
        assert pull[-1] - pull[0] == pytest.approx([0.0, weight], **close)


@pytest.mark.parametrize("settings", [SPLINE, FeSettings(elements=20)], ids=lambda s: s.model)
def test_a_release_begins_with_the_static_section_forces(settings):
    """The first record of a motion has the fields and the stress of the released static state."""
    step = {"step": 1e-4} if settings is SPLINE else {"integrator": "generalised-alpha", "step": 1e-4}
    pivot = design_of("cross_axis_pivot")
    motion, path = (
        answer_release(pivot, settings, duration=2e-4, records=2, **step),
        answer_static(pivot, settings),
    )
    assert motion.max_stress[0] == pytest.approx(path.max_stress[-1], rel=1e-3)
    begin, static = motion.along, path.along
    assert begin.bending_moment[0] == pytest.approx(static.bending_moment[-1], rel=1e-3)
    # by the moments' balance the spline's shear force is a derivative, and its strips are stiffer in motion
    size = np.abs(static.shear_force[-1]).max()
    assert np.abs(begin.shear_force[0] - static.shear_force[-1]).max() < 0.02 * size
    assert np.abs(begin.reactions[0] - static.reactions[-1]).max() < 0.02 * size
    assert np.abs(begin.bodies[0] - static.bodies[-1]).max() < 1e-4


@pytest.mark.parametrize("settings", [SPLINE, ELEMENTS], ids=lambda s: s.model)
def test_motion_keeps_the_bodies_and_strips_together(settings):
    """Ends of strips stay on their bodies in every record of a mechanism whose reference points differ."""
    design = design_of("four_bar_of_flexures")
    step = {} if settings is SPLINE else {"integrator": "generalised-alpha", "step": 1e-4}
    fields = answer_release(design, settings, duration=1e-3, records=4, **step).along
    crank = [body.name for body in design.bodies].index("crank")
    turn, centre = fields.bodies[:, crank, 2], fields.bodies[:, crank, :2]
    offset = np.exp(1j * turn) * complex(*(fields.rest_shape[0, -1] - fields.rest_bodies[crank]))
    turned = np.stack((offset.real, offset.imag), axis=-1)
    assert fields.shape[:, 0, -1] == pytest.approx(centre + turned, abs=1e-8)
    assert fields.rotation[:, 0, -1] == pytest.approx(turn, abs=1e-8)


LENGTH, PULL, LIFT = 0.1, 0.02, 0.01
SCENE = f"""
effects = ["bending", "stretching", "tip_force"]

[effects.tip_force]
strip = "strip"
force_N = [{PULL}, {LIFT}]
"""
MODELS = [
    SplineSettings(control_points=8),
    FeSettings(elements=20),
    FeSettings(elements=20, element="reissner"),
]


@pytest.mark.parametrize("settings", MODELS, ids=lambda s: s.model)
def test_signs_of_a_cantilever_that_is_pulled_and_lifted(settings, tmp_path):
    """Requirement: positive are tension, a force to the left and the moment that lifts the strip."""
    path = tmp_path / "cantilever.toml"
    path.write_text(one_strip(SCENE), encoding="utf-8")
    table = tables(answer_static(read_design(path), settings))
    strips, reactions = (table[name][table[name]["load_factor"] == 1.0] for name in ("strips", "reactions"))
    x, y, at = (strips[name].to_numpy() for name in ("x_m", "y_m", "arc_length_m"))
    moment = LIFT * (x[-1] - x) - PULL * (y[-1] - y)  # about each section, of the force at the tip
    size, inner = LIFT * LENGTH, (at > 0.1 * LENGTH) & (at < 0.9 * LENGTH)
    assert np.abs(strips["bending_moment_Nm"] - moment)[inner].max() < 0.01 * size
    assert strips["bending_moment_Nm"].iloc[0] == pytest.approx(moment[0], rel=0.01)
    assert strips["axial_force_N"].iloc[0] == pytest.approx(PULL, rel=0.01)
    assert strips["shear_force_N"].iloc[0] == pytest.approx(LIFT, rel=0.05)
    assert (strips["curvature_per_m"].to_numpy()[inner] > 0.0).all()
    root = reactions[reactions["end"] == "root"].iloc[0]
    assert [root["force_x_N"], root["force_y_N"]] == pytest.approx([-PULL, -LIFT], rel=0.01)
    assert root["moment_Nm"] == pytest.approx(-moment[0], rel=0.01)
