"""What is pressed until it gives way: both models say where, in words and as JSON."""

import json
import math
import re

import pytest

from studies.cases.design import as_toml
from tests import gates
from tests.goldens.answers import document_of

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
SPLINE = ["--control-points", "12"]


def asked(command, tmp_path, drive, model, how):
    """First critical load factor and the message, as the command writes them in JSON; what it prints."""
    case = tmp_path / "pressed.toml"
    case.write_text(CASE.format(drive=DRIVES[drive]))
    words = ["solve", case, "--model", model, *how]
    document = json.loads(command(*words, "--json", "-").out)
    printed = command(*words)
    return document["critical_points"][0]["load_factor"], document["message"], printed.out + printed.err


@pytest.mark.slow
@pytest.mark.parametrize("drive", DRIVES)
def test_both_models_say_where_a_pressed_pivot_gives_way(command, tmp_path, drive):
    """Held at 0 and 0.01 deg and free, both find one first critical load, name it and what buckles later."""

    def said(model, how):
        load, message, printed = asked(command, tmp_path, drive, model, how)
        assert "buckle" in message  # later, and named with its load
        assert re.search(rf"(limit point|bifurcation): load factor {load:.6g}", printed)
        return load

    spline = said("spline", SPLINE)

    def error(elements=40):
        return abs(spline / said("fe", ["--elements", elements]) - 1.0)

    gates.check("pressed_pivot", error())
    if drive == "free":
        gates.refuse("pressed_pivot", error)


@pytest.mark.slow
def test_a_spline_that_stops_says_where_it_buckled(command, tmp_path):
    """Pressed far beyond what it bears, the spline stops and says so, with the force, and what may go on."""
    path = tmp_path / "pressed.toml"
    path.write_text(CASE.format(drive=DRIVES["turned"]).replace("-20e3", "-1e9"), encoding="utf-8")
    outcome = command("solve", path)
    assert outcome.code == 3
    assert re.search(r"lost its stability before, first at load factor \S+ \(force \d+ N\)", outcome.err)
    assert "--model fe may go further" in outcome.err


def test_what_a_converged_path_passed_is_told(command, tmp_path):
    """A path that reached its end says what it passed, in the table and in JSON, with the load factor."""
    path, column = tmp_path / "column.toml", document_of("column")
    column["effects"]["applied_force"]["force_N"] = [-4, 0]
    path.write_text(as_toml(column), encoding="utf-8")
    words = ["solve", path, "--model", "spline"]
    answer = json.loads(command(*words, "--json", "-").out)
    outcome = command(*words)
    assert (outcome.code, outcome.err, answer["status"]) == (0, "", "converged")
    assert answer["message"]
    assert answer["message"] in outcome.out
    (point,) = answer["critical_points"]
    euler = (math.pi / 2) ** 2  # one end free, EI and L one
    assert point["kind"] == "bifurcation"
    assert point["force_N"] == pytest.approx(euler, rel=1e-3)
    assert point["rotation_rad"] is None
    assert point["load_factor"] == pytest.approx(euler / 4.0, rel=1e-3)
    assert f"bifurcation: load factor {point['load_factor']:.6g}" in outcome.out
