"""Plate action and roots, each model by its own plate and its own law: at large rotations both agree."""

import numpy as np
import pytest

import fe_reference
import spline_model
from tests import gates
from tests.table_one import TABLE_ONE

DESIGN = {name: value for name, value in TABLE_ONE.items() if name not in ("area", "second_moment_of_area")}
PLAIN = ("bending", "stretching", "strip_inertia", "body_inertia")
EFFECTS = ("clamped_width", "anticlastic", "root_compliance")
#: Width and thickness [m]: Table 1's, and a wide thin strip that flattens as it bends.
SECTIONS = {"table 1": (0.01, 0.005), "wide": (0.04, 0.0005)}
INCREMENTS = 18


def torques(section, effects, *, control_points=14):
    """Torque (S,) of the splines, and of the elements in the limit of two meshes, to a quarter turn."""
    width, thickness = SECTIONS[section]
    scene = {
        "effects": (*PLAIN, *effects),
        "parameters": {"root_compliance": {"root": "monolithic"}} if EFFECTS[2] in effects else {},
        "width": width,
        "thickness": thickness,
    }
    path = {"rotation": np.pi / 2, "increments": INCREMENTS}
    spline = spline_model.cross_axis_pivot(**DESIGN, **scene, control_points=control_points)
    coarse, fine = (
        fe_reference.solve_statics(
            fe_reference.cross_axis_pivot(**DESIGN, **scene, elements=elements), **path
        ).torque
        for elements in (20, 40)
    )
    return spline_model.solve_statics(spline, **path).torque, (4.0 * fine - coarse) / 3.0


def difference(section, effects, **options):
    """Largest difference of the models' torques, over the largest torque."""
    spline, elements = torques(section, effects, **options)
    return float(np.abs(spline - elements).max() / np.abs(elements).max())


@pytest.mark.parametrize("section", SECTIONS)
@pytest.mark.parametrize("effects", [*((name,) for name in EFFECTS), EFFECTS], ids="+".join)
def test_models_agree_at_large_rotations(section, effects):
    """Requirement: with each effect and all, both models agree to a quarter turn as they do without."""
    gates.check("section_effects_torque", difference(section, effects))


def test_gate_has_teeth():
    """Requirement: the check notices a curve of six control points."""
    coarse = difference("wide", EFFECTS, **gates.teeth("section_effects_torque"))
    with pytest.raises(AssertionError, match="x the gate"):
        gates.check("section_effects_torque", coarse)


def test_effects_are_as_large_as_plates_say():
    """Requirement: in Table 1 clamps add and roots take some per cent: no effect is merely named."""
    plain, share = torques("table 1", ())[0][-1], {}
    for name in EFFECTS:
        share[name] = torques("table 1", (name,))[0][-1] / plain - 1.0
    assert 0.005 < share["clamped_width"] < 0.03
    assert 0.0 < share["anticlastic"] < 0.01
    assert -0.06 < share["root_compliance"] < -0.03
