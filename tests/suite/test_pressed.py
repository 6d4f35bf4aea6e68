"""A pivot of steel strips that is pressed down: both models say where it gives way, in words and as JSON."""

import json
import re

import pytest

from tests import gates

pytestmark = pytest.mark.slow

#: 300 x 50 x 3 mm at 60 deg, crossing in the middle, pressed at the body's centre.
CASE = """
[[strips]]
name = "left"
start_m = [0, 0]
end_m = [0.15, 0.25980762]
tip = "body"

[[strips]]
name = "right"
start_m = [0.15, 0]
end_m = [0, 0.25980762]
tip = "body"

[[bodies]]
name = "body"
centre_m = [0.075, 0.25980762]
mass_kg = 1
moment_of_inertia_kg_m2 = 0.01

[section]
area_m2 = 150e-6
second_moment_m4 = 1.125e-10

[material]
youngs_modulus_Pa = 206e9
poisson_ratio = 0.3
density_kg_m3 = 7850

[drive]
{drive}
increments = 8

[scene]
effects = ["bending", "stretching", "strip_inertia", "body_inertia", "applied_force"]

[effects.applied_force]
force_N = [0, -20e3]
"""
DRIVES = {"held": "rotation_deg = 0", "turned": "rotation_deg = 0.01", "free": ""}
FINE = {"spline": ["--control-points", "12"], "fe": ["--elements", "40"]}


def asked(command, tmp_path, drive, model, how):
    """First critical load factor and the message, as the command writes them in JSON; what it prints."""
    case = tmp_path / "pressed.toml"
    case.write_text(CASE.format(drive=DRIVES[drive]))
    words = ["solve", case, "--model", model, *how]
    document = json.loads(command(*words, "--json", "-").out)
    printed = command(*words)
    return document["critical_points"][0]["load_factor"], document["message"], printed.out + printed.err


@pytest.mark.parametrize("drive", DRIVES)
def test_both_models_say_where_a_pressed_pivot_gives_way(command, tmp_path, drive):
    """Held at 0 and 0.01 deg and free, both find one first critical load, name it and what buckles later."""
    loads = []
    for model, how in FINE.items():
        load, message, printed = asked(command, tmp_path, drive, model, how)
        loads.append(load)
        assert "buckle" in message  # later, and named with its load
        assert re.search(rf"(limit point|bifurcation): load factor {load:.6g}", printed)
    gates.check("pressed_pivot", abs(loads[0] / loads[1] - 1.0))


def test_pressed_pivot_gate_has_teeth(command, tmp_path):
    """Few elements do not pass."""
    teeth = [f"--elements={gates.teeth('pressed_pivot')['elements']}"]
    fine, coarse = (
        asked(command, tmp_path, "free", model, how)[0]
        for model, how in (("spline", FINE["spline"]), ("fe", teeth))
    )
    with pytest.raises(AssertionError, match="x the gate"):
        gates.check("pressed_pivot", abs(fine / coarse - 1.0))
