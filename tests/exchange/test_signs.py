"""Signs of exported section forces and reactions, by hand on a cantilever, in both models."""

import numpy as np
import pytest

from studies.answers.adapters import answer_static
from studies.answers.fields import fields_of
from studies.answers.settings import FeSettings, SplineSettings
from studies.cases.effects import Effects
from studies.cases.mechanism import Mechanism, Strip
from studies.exchange.formats import tables

LENGTH, PULL, LIFT = 0.1, 0.02, 0.01
CANTILEVER = Mechanism(
    strips=(
        Strip(
            name="strip",
            start=(0.0, 0.0),
            end=(LENGTH, 0.0),
            tip=None,
            area=5e-6,
            second_moment_of_area=1.0416667e-13,
            youngs_modulus=206e9,
            poisson_ratio=0.29,
            density=7800.0,
        ),
    ),
    bodies=(),
    body=None,
    rotation=None,
    increments=2,
    effects=Effects(
        names=("bending", "stretching", "tip_force"),
        tables={"tip_force": {"strip": "strip", "force": (PULL, LIFT)}},
    ),
)
MODELS = [
    SplineSettings(control_points=8),
    FeSettings(elements=20),
    FeSettings(elements=20, element="reissner"),
]


@pytest.mark.parametrize("settings", MODELS, ids=lambda s: s.model)
def test_signs_of_a_cantilever_that_is_pulled_and_lifted(settings):
    """Requirement: positive are tension, a force to the left and the moment that lifts the strip."""
    table = tables(fields_of(answer_static(CANTILEVER, settings)))
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
