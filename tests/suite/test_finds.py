"""Inputs of users whose right value is known in closed form: what the command prints is this value."""

import json
import math
from pathlib import Path

import pytest

FINDS = Path(__file__).with_name("finds")
#: Elements are asked for an accuracy, splines choose it.
ACCURATE = {"spline": [], "fe": ["--accuracy", 1e-4]}
STRESS = 32.0 * 25.0 * 0.15 / (math.pi * 0.008**3)
STIFFNESS = 2.0 * 205e9 * 0.01 * 0.001**3 / 12.0 / (0.08 + 2.0 * 0.416 * 0.001)


@pytest.mark.parametrize(
    ("name", "model", "key", "state", "value"),
    [
        *(("half_circle", model, "torque_Nm", -1, -1e6) for model in ACCURATE),
        *(("round_rod", model, "max_stress_Pa", -1, STRESS) for model in ACCURATE),
        *(("supports_by_default", model, "stiffness_Nm_per_rad", 0, STIFFNESS) for model in ACCURATE),
    ],
)
def test_the_right_value(name, model, key, state, value, command):
    """Every model that takes the input has its value to the accuracy that it was asked for, 1e-4."""
    outcome = command("solve", FINDS / f"{name}.toml", "--model", model, *ACCURATE[model], "--json", "-")
    assert (outcome.code, outcome.err) == (0, "")
    assert json.loads(outcome.out)[key][state] == pytest.approx(value, rel=1e-4)


@pytest.mark.parametrize("model", ACCURATE)
@pytest.mark.parametrize("asked", [["solve"], ["modes"]], ids=" ".join)
def test_weight_that_buckles_the_strips_is_no_bad_input(asked, model, command, tmp_path):
    """An arch that snaps under 43 % of its weight ends every command with exit code 3, in both models."""
    arch = (FINDS / "shallow_arch.toml").read_text().partition("[scene]")[0]
    heavy = tmp_path / "heavy_arch.toml"
    heavy.write_text(arch.replace("mass_kg = 0", "mass_kg = 1.5") + '[scene]\neffects = ["+gravity"]\n')
    outcome = command(*asked, heavy, "--model", model)
    assert outcome.code == 3
    assert "limit point" in outcome.err and "of weight" in outcome.err.replace("the weight", "weight")
