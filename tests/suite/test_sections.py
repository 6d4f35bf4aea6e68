"""Sections of case files: outermost fibre, tapers, what is refused of them; and strips without a body."""

import json
import math

import numpy as np
import pytest

from tests.one_strip import SECOND_MOMENT, one_strip

#: A round rod of 8 mm and 100 mm with 25 N at its tip.
DIAMETER, LENGTH, LOAD = 8e-3, 0.1, 25.0
AREA, MOMENT = math.pi * DIAMETER**2 / 4.0, math.pi * DIAMETER**4 / 64.0
SCENE = f"""
effects = ["bending", "stretching", "strip_inertia", "tip_force"]
[effects.tip_force]
strip = "strip"
force_N = [0, {-LOAD}]
"""
FIBRE = f"outer_fibre_m = {DIAMETER / 2.0}"


def rod(shared="", own=""):
    """The case of the rod, with more lines in [section] and for the strip."""
    text = one_strip(SCENE).replace('tip = "free"', f'tip = "free"\n{own}')
    text = text.replace("area_m2 = 5e-6", f"area_m2 = {AREA}\n{shared}")
    return text.replace(f"= {SECOND_MOMENT}", f"= {MOMENT}")


@pytest.mark.parametrize("model", ["spline", "fe"])
def test_no_stress_without_an_outermost_fibre(model, tmp_path, command):
    """Of a section by area and second moment alone no stress is printed, and the answer names the key."""
    (tmp_path / "rod.toml").write_text(rod())
    asked = ("solve", tmp_path / "rod.toml", "--model", model)
    said = command(*asked).out
    assert "MPa" not in said and "stress: none without the distance of the outermost fibre of strip" in said
    assert not any("stress" in line for line in said.splitlines() if line.startswith("estimated error:"))
    found = json.loads(command(*asked, "--json", "-").out)
    assert found["strength"] == {} and set(found["max_stress_Pa"]) == {None}


def test_the_outermost_fibre_stands_in_several_places(tmp_path, command, caplog):
    """It is named in [section] or of a strip's own, or is half the depth of a section, with a warning."""
    own, found = f"{FIBRE}\narea_m2 = {AREA}\nsecond_moment_m4 = {MOMENT}", []
    texts = {"old": rod(f"section_depth_m = {DIAMETER}"), "new": rod(FIBRE), "own": rod(own=own)}
    for name, text in texts.items():
        (tmp_path / f"{name}.toml").write_text(text)
        found.append(json.loads(command("solve", tmp_path / f"{name}.toml", "--json", "-").out)["strength"])
    assert found[0] == found[1] == found[2]
    assert "old.toml: version 0.3 ends section_depth_m (use: outer_fibre_m" in caplog.text


TAPERED = "width_m = 0.01\nthickness_m = 1e-3\nwidth_end_m = 0.008\nthickness_end_m = 0.5e-3"


@pytest.mark.parametrize("model", ["spline", "fe"])
def test_stress_of_a_tapered_strip(model, tmp_path, command):
    """The largest stress is that of the section at hand, M/W inside a strip that gets thin fast enough."""
    text = rod().replace(f"area_m2 = {AREA}", TAPERED).replace(f"second_moment_m4 = {MOMENT}", "")
    (tmp_path / "taper.toml").write_text(text.replace(f"{-LOAD}", "-1e-3"))
    asked = ("solve", tmp_path / "taper.toml", "--model", model, "--accuracy", 1e-5, "--json", "-")
    x = np.linspace(0.0, 1.0, 100_001)
    right = 1e-3 * LENGTH * (1.0 - x) / (0.01 * (1.0 - 0.2 * x) * (1e-3 * (1.0 - 0.5 * x)) ** 2 / 6.0)
    found = json.loads(command(*asked).out)["strength"]
    assert found["max_stress_Pa"] == pytest.approx(right.max(), rel=1e-4)
    assert found["station"] == pytest.approx(x[right.argmax()], abs=0.02)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ("thickness_end_m = 1e-3", "section.thickness_end_m: got it beside area_m2, expected width_m and"),
        (f"{FIBRE}\nsection_depth_m = 1", "section.section_depth_m: got an unknown key"),
        ("section_depth_m = -1", "section.outer_fibre_m: got -0.5, expected a positive number [m]"),
        ("outer_fibre_m = 0", "section.outer_fibre_m: got 0, expected a positive number [m]"),
    ],
)
def test_sections_that_are_refused(given, said, tmp_path, command):
    """What makes no section is refused in one line."""
    (tmp_path / "rod.toml").write_text(rod(given))
    outcome = command("solve", tmp_path / "rod.toml")
    assert outcome.code == 2 and said in outcome.err


@pytest.mark.parametrize("asked", [("size", "--objective", "centre-shift"), ("advise",)])
def test_commands_without_tapers_refuse_them(asked, case, command):
    """Sizing, and the models that `advise` tries on a pivot, refuse a tapered strip in one line."""
    outcome = command(asked[0], case(("thickness_m =", "thickness_end_m = 0.002\nthickness_m =")), *asked[1:])
    assert outcome.code == 2
    assert "strip_1: got a taper, expected a constant section for" in outcome.err


def test_a_byte_order_mark_is_no_fault(tmp_path, command):
    """Editors that begin a file with the mark of UTF-8 are understood."""
    path = tmp_path / "rod.toml"
    path.write_text(rod(), encoding="utf-8-sig")
    assert command("solve", path).code == 0


@pytest.fixture
def strip(tmp_path):
    """Path of a case of one strip with a small force at its free tip."""
    path = tmp_path / "strip.toml"
    path.write_text(one_strip(SCENE.replace(f"{-LOAD}", "-0.5")), encoding="utf-8")
    return path


@pytest.mark.parametrize("model", ["fe", "fe-shear"])
def test_modes_of_strips_alone(model, strip, command):
    """The table has the frequencies of a strip; no body moves in its modes."""
    ended = command("modes", strip, "--model", model, "--elements", 4, "--count", 2)
    assert ended.code == 0
    first = next(line.split() for line in ended.out.splitlines() if line.split()[0] == "1")
    assert [float(value) for value in first[2:]] == [0.0, 0.0, 0.0]


@pytest.mark.parametrize("model", ["fe", "fe-shear", "spline"])
def test_release_of_strips_alone_is_refused(model, strip, refused):
    """A release reports the swing of a body: without one it is refused in one line."""
    text = "studies: bodies: got none, expected a body whose motion is computed"
    assert refused("release", strip, "--model", model, says=text).startswith(text)
