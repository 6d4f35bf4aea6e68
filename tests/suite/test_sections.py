"""Sections of case files: their depth, and what is assumed of it."""

import json
import math

import pytest

from tests.one_strip import SECOND_MOMENT, one_strip

#: A round rod of 8 mm and 100 mm with 25 N at its tip.
DIAMETER, LENGTH, LOAD = 8e-3, 0.1, 25.0
AREA, MOMENT = math.pi * DIAMETER**2 / 4.0, math.pi * DIAMETER**4 / 64.0
SCENE = f"""
effects = ["bending", "stretching", "tip_force"]
[effects.tip_force]
strip = "strip"
force_N = [0, {-LOAD}]
"""
DEPTH = f"section_depth_m = {DIAMETER}"


def rod(shared="", own=""):
    """The case of the rod, with more lines in [section] and for the strip."""
    text = one_strip(SCENE).replace('tip = "free"', f'tip = "free"\n{own}')
    text = text.replace("area_m2 = 5e-6", f"area_m2 = {AREA}\n{shared}")
    return text.replace(f"= {SECOND_MOMENT}", f"= {MOMENT}")


@pytest.mark.parametrize(
    "given", [{"shared": DEPTH}, {"own": f"{DEPTH}\narea_m2 = {AREA}\nsecond_moment_m4 = {MOMENT}"}]
)
def test_stress_of_a_round_rod(given, tmp_path, command):
    """A section names its depth in [section] or of its own: the stress is that of the rod."""
    (tmp_path / "rod.toml").write_text(rod(**given))
    found = json.loads(command("solve", tmp_path / "rod.toml", "--json", "-").out)
    right = 32.0 * LOAD * LENGTH / (math.pi * DIAMETER**3)
    assert found["strength"]["max_stress_Pa"] == pytest.approx(right, rel=1e-3)
    assert not any("stress: takes" in each for each in found["validity"]["outside"])


def test_a_rectangle_that_no_one_named_is_said(tmp_path, command):
    """Without a depth the stress is that of a rectangle, and the answer says so and asks for the depth."""
    (tmp_path / "rod.toml").write_text(rod())
    said = command("solve", tmp_path / "rod.toml").out
    assert "stress: takes strip as 6.928 mm deep, rectangles of the area and second moment" in said
    assert "section_depth_m" in said


def test_a_byte_order_mark_is_no_fault(tmp_path, command):
    """Editors that begin a file with the mark of UTF-8 are understood."""
    path = tmp_path / "rod.toml"
    path.write_text(rod(), encoding="utf-8-sig")
    assert command("solve", path).code == 0
