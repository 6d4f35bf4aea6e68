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
        ("half_circle", "fe", "torque_Nm", -1, -1e6),
        *(("round_rod", model, "max_stress_Pa", -1, STRESS) for model in ACCURATE),
        *(("supports_by_default", model, "stiffness_Nm_per_rad", 0, STIFFNESS) for model in ACCURATE),
    ],
)
def test_the_right_value(name, model, key, state, value, command):
    """Every model that takes the input has its value to the accuracy that it was asked for, 1e-4."""
    outcome = command("solve", FINDS / f"{name}.toml", "--model", model, *ACCURATE[model], "--json", "-")
    assert (outcome.code, outcome.err) == (0, "")
    assert json.loads(outcome.out)[key][state] == pytest.approx(value, rel=1e-4)


def test_an_arc_that_the_splines_do_not_take(command):
    """A half circle is refused by the name of its strip, with a remedy."""
    outcome = command("solve", FINDS / "half_circle.toml", "--model", "spline")
    assert outcome.code == 2
    assert "rise of beam: got 1.0, expected less than half the chord, 1, or two strips" in outcome.err
