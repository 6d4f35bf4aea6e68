"""Signs of exported section forces and reactions, by hand on a cantilever, in both models."""

import numpy as np
import pytest

from studies.answers.adapters import answer_static
from studies.answers.settings import FeSettings, SplineSettings
from studies.cases.design import read_design
from studies.exchange import tables
from tests.one_strip import one_strip

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
