"""Sections of case files: their depth, what is assumed of it, and numbers that no solve can bear."""

import json
import math

import pytest

#: A round rod of 8 mm, 25 N at 150 mm: E, area and second moment as a designer has them.
ROD = """
[[strips]]
name = "rod"
start_m = [0, 0]
end_m = [0.15, 0]
tip = "free"
{own}
[section]
area_m2 = {area}
second_moment_m4 = {second}
{depth}
[material]
youngs_modulus_Pa = 200e9
poisson_ratio = 0.3
density_kg_m3 = 7850
yield_strength_Pa = 600e6
[drive]
increments = 5
[scene]
effects = ["+tip_force"]
[effects.tip_force]
strip = "rod"
force_N = [0, -25]
"""
DIAMETER = 8e-3
GIVEN = {"area": math.pi * DIAMETER**2 / 4.0, "second": math.pi * DIAMETER**4 / 64.0, "depth": "", "own": ""}
#: 32 F L / (pi d^3) [Pa].
RIGHT = 32.0 * 25.0 * 0.15 / (math.pi * DIAMETER**3)


@pytest.mark.parametrize("place", ["depth", "own"])
def test_stress_of_a_round_rod(place, tmp_path, command):
    """A section names its depth in [section] or of its own: stress and safety are those of the rod."""
    given = GIVEN | {place: f"section_depth_m = {DIAMETER}"}
    if place == "own":
        given["own"] += f"\narea_m2 = {GIVEN['area']}\nsecond_moment_m4 = {GIVEN['second']}"
    (tmp_path / "rod.toml").write_text(ROD.format(**given))
    found = json.loads(command("solve", tmp_path / "rod.toml", "--json", "-").out)
    assert found["strength"]["max_stress_Pa"] == pytest.approx(RIGHT, rel=1e-3)
    assert not any("stress: takes" in each for each in found["validity"]["outside"])


def test_a_rectangle_that_no_one_named_is_said(tmp_path, command):
    """Without a depth the stress is that of a rectangle, and the answer says so and asks for the depth."""
    (tmp_path / "rod.toml").write_text(ROD.format(**GIVEN))
    said = command("solve", tmp_path / "rod.toml").out
    assert "stress: takes rod as 6.928 mm deep, rectangles of the area and second moment" in said
    assert "section_depth_m" in said


def test_a_byte_order_mark_is_no_fault(tmp_path, command):
    """Editors that begin a file with the mark of UTF-8 are understood."""
    path = tmp_path / "rod.toml"
    path.write_text(ROD.format(**GIVEN), encoding="utf-8-sig")
    assert command("solve", path).code == 0


@pytest.mark.parametrize("model", ["spline", "fe"])
def test_roots_have_the_default_that_is_documented(model, command):
    """Without parameters root_compliance is that of roots cut from the same block."""
    case = ("titanium_pivot", "--rotation-deg", "5", "--model", model, "--json", "-")
    named, bare = (
        json.loads(command("solve", *case, f"--effects=+{effect}").out)["torque_Nm"][-1]
        for effect in ("root_compliance", "gravity")
    )
    assert 0.9 < named / bare < 1.0
