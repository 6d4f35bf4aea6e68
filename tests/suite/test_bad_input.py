"""Bad input is one clear line (file, key, got, expected) and exit code 2, whatever is wrong with it."""

import subprocess
import sys
from pathlib import Path

import pytest

from studies.record.source import ROOT

#: What is written over the Table 1 case, and what the one line must say.
BAD_VALUES = {
    "missing key": ("poisson_ratio = 0.29", "", "material.poisson_ratio: got no such key, expected a number"),
    "misspelt key": (
        "length_m",
        "lenght_m",
        "strip.lenght_m: got an unknown key, expected length_m (the nearest",
    ),
    "unknown key": (
        "[drive]",
        "[drive]\nzzz = 1",
        "drive.zzz: got an unknown key, expected one of rotation_deg",
    ),
    "missing section": ("[drive]", "[body.drive]", "body.drive: got an unknown key"),
    "misspelt section": (
        "[material]",
        "[materail]",
        "[materail]: got an unknown section, expected material (the",
    ),
    "value outside sections": (
        "[strip]",
        "x = 1\n[strip]",
        "x: got a value outside any section, expected one of [s",
    ),
    "text for a number": ("= 45 ", '= "45" ', 'strip.inclination_deg: got the text "45", expected a number'),
    "truth value": (
        "= 206e9",
        "= true",
        "material.youngs_modulus_Pa: got the truth value true, expected a positive",
    ),
    "not a number": (
        "= 206e9",
        "= nan",
        "material.youngs_modulus_Pa: got nan, expected a positive number [Pa]",
    ),
    "infinite": ("= 5e-5", "= inf", "strip.area_m2: got inf, expected a positive number [m^2]"),
    "zero": ("= 5e-5", "= 0", "strip.area_m2: got 0, expected a positive number [m^2]"),
    "negative": (
        "mass_kg = 0.2",
        "mass_kg = -0.2",
        "body.mass_kg: got -0.2, expected a positive number [kg]",
    ),
    "crossing ratio 0": (
        "crossing_ratio = 0.5",
        "crossing_ratio = 0.0",
        "strip.crossing_ratio: got 0.0, expected",
    ),
    "crossing ratio 1": (
        "crossing_ratio = 0.5",
        "crossing_ratio = 1",
        "strip.crossing_ratio: got 1, expected",
    ),
    "inclination 90": (
        "= 45 ",
        "= 90 ",
        "strip.inclination_deg: got 90, expected a number between 0 and 90, both",
    ),
    "poisson ratio -1": (
        "= 0.29",
        "= -1",
        "material.poisson_ratio: got -1, expected a number above -1 and at most",
    ),
    "poisson ratio 0.51": (
        "= 0.29",
        "= 0.51",
        "material.poisson_ratio: got 0.51, expected a number above -1",
    ),
    "one offset": ("[0, 0]", "[0]", "body.centre_offset_m: got [0], expected two finite numbers [x, y] [m]"),
    "offset not a number": ("[0, 0]", "[0, nan]", "body.centre_offset_m: got [0, nan], expected two finite"),
    "no increments": (
        "increments = 20",
        "increments = 0",
        "drive.increments: got 0, expected a whole number from 1",
    ),
    "broken increments": (
        "increments = 20",
        "increments = 20.5",
        "drive.increments: got 20.5, expected a whole",
    ),
    "too far a rotation": (
        "= 90 ",
        "= 400 ",
        "drive.rotation_deg: got 400, expected a number from -360 to 360",
    ),
    "no depth": (
        "[material]",
        "section_depth_m = 0\n[material]",
        "strip.section_depth_m: got 0, expected a positive",
    ),
    "both pairs": (
        "area_m2 = 5e-5",
        "area_m2 = 5e-5\nwidth_m = 0.01",
        "strip.width_m: got it beside area_m2, expected width_m and thickness_m, or area_m2 and",
    ),
    "one of a pair": (
        "area_m2 = 5e-5",
        "",
        "strip.area_m2: got no such key, expected a positive number [m^2]",
    ),
    "one side": (
        "second_moment_m4 = 1.041e-10",
        "",
        "strip.second_moment_m4: got no such key, expected a positive number [m^4]",
    ),
    "material that is not there": (
        "[material]",
        '[material]\nname = "steel"',
        'material.name: got the text "steel", expected one of "spring_steel", "titanium_6al_4v"',
    ),
    "gravity twice": (
        "[drive]",
        '[scene]\neffects = ["+gravity"]\n[effects.gravity]\nacceleration_m_per_s2 = [0, 1]\n'
        "direction_deg = 0\n[drive]",
        "effects.gravity.direction_deg: got it beside acceleration_m_per_s2, expected one of them",
    ),
    "not TOML": ("[strip]", "[strip", "got text that is not TOML"),
    "400 digits": (
        "= 90 ",
        f"= 1{'0' * 400} ",
        "drive.rotation_deg: got a whole number of about 400 digits, expected a number from -360 to 360",
    ),
    "400 digits in a list": (
        "[0, 0]",
        f"[0, {'7' * 400}]",
        "body.centre_offset_m: got [0, a whole number of about 400 digits], expected two finite numbers",
    ),
    "more digits than Python reads": ("= 90 ", f"= 1{'0' * 5000} ", "got a whole number that fills pages"),
    "more digits than Python writes": (
        "increments = 20",
        f"increments = 0x{'f' * 8000}",
        "drive.increments: got a whole number of about 9633 digits, expected a whole number from 1 to 100000",
    ),
    "lists in lists": ("[0, 0]", "[" * 3000 + "]" * 3000, "got lists or tables nested too deep"),
}


@pytest.mark.parametrize("name", BAD_VALUES)
def test_bad_case_is_one_line(name, case, refused):
    """A case file with a fault is refused with file, key, got and expected in one line."""
    old, new, text = BAD_VALUES[name]
    path = case((old, new))
    assert refused("solve", path, "--model", "fe", says=text).startswith(f"studies: {path}: ")


def test_missing_section_names_what_it_needs(case, refused, table_1):
    """A case without a section is refused with the keys that the section must have."""
    body = table_1[table_1.index("[body]") : table_1.index("[drive]")]
    text = "[body]: got no such section, expected one with mass_kg, moment_of_inertia_kg_m2"
    refused("solve", case((body, "")), "--model", "fe", says=text)


#: Words after `solve CASE.toml`, and what the one line must say.
BAD_OPTIONS = {
    "unknown model": (
        ["--model", "rod"],
        "argument --model: got rod, expected one or more of spline, fe, fe-shear",
    ),
    "a model twice": (
        ["--model", "fe,fe"],
        "argument --model: got fe, expected one or more of spline, fe, fe-shear, each once",
    ),
    "three control points": (
        ["--model", "spline", "--control-points", "3"],
        "control_points: got 3, expected",
    ),
    "no axial mode": (["--model", "spline", "--axial-modes", "0"], "axial_modes: got 0, expected"),
    "six modes of six": (["--model", "spline", "--axial-modes", "6"], "axial_modes: got 6, expected"),
    "no element": (["--model", "fe", "--elements", "0"], "elements: got 0, expected"),
    "half an element": (["--model", "fe", "--elements", "1.5"], "--elements: invalid int value: '1.5'"),
    "no increment": (
        ["--model", "fe", "--increments", "0"],
        "--increments: got 0, expected a whole number from 1",
    ),
    "no repeat": (
        ["--model", "fe", "--repeat", "0"],
        "--repeat: got 0, expected a whole number of at least 1",
    ),
    "rotation nan": (
        ["--model", "fe", "--rotation-deg", "nan"],
        "--rotation-deg: got nan, expected a finite",
    ),
    "rotation 720": (
        ["--model", "fe", "--rotation-deg", "720"],
        "--rotation-deg: got 720.0, expected a number",
    ),
    "option of the other model": (["--model", "fe", "--basis", "bezier"], "--basis: got it with --model fe"),
    "misspelt option": (["--model", "fe", "--elemnts", "4"], "expected --elements (the nearest option)"),
    "effects without =": (["--effects", "-gravity"], "one that begins with - is given as --effects=-..."),
    "unknown basis": (
        ["--model", "spline", "--basis", "nurbs"],
        "--basis: got nurbs, expected one of bezier, bspline",
    ),
}


@pytest.mark.parametrize("name", BAD_OPTIONS)
def test_bad_option_is_one_line(name, case, refused):
    """An option with a fault is refused with got and expected in one line."""
    words, text = BAD_OPTIONS[name]
    refused("solve", case(), *words, says=text)


@pytest.mark.parametrize(
    ("words", "text"),
    [
        (["slove"], "studies: argument COMMAND: got slove, expected solve (the nearest name)"),
        (["run", "fig04_trajectry"], "got fig04_trajectry, expected fig04_trajectory (the nearest name)"),
        (["run"], "required: NAME"),
        (
            ["solve", "absent.toml", "--model", "fe"],
            "absent.toml: cannot be read (No such file or directory)",
        ),
        (["solve", "cross_axis"], "got cross_axis, expected cross_axis_pivot (the nearest name), or a file"),
        (["converge", "absent.toml"], "absent.toml: cannot be read (No such file or directory)"),
    ],
)
def test_bad_words_are_one_line(words, text, refused):
    """Unknown commands, studies and files are refused in one line."""
    refused(*words, says=text)


def test_a_case_here_is_named_with_its_ending(tmp_path, monkeypatch, refused):
    """Who leaves out the ending of a file that is here is told the file, and not another case."""
    monkeypatch.chdir(tmp_path)
    Path("my_pivot.toml").write_text("", encoding="utf-8")
    refused("solve", "my_pivot", says="got my_pivot, expected my_pivot.toml")


def test_folder_and_binary_files_are_refused(tmp_path, refused):
    """A folder, or bytes that are not text, given as case file are refused in one line."""
    binary = tmp_path / "binary.toml"
    binary.write_bytes(b"\xff\xfe\x00")
    for path, text in ((tmp_path, "cannot be read (Is a directory)"), (binary, "bytes that are not UTF-8")):
        refused("solve", path, "--model", "fe", says=text)


def test_unwritable_answer_is_refused_before_solving(case, refused, tmp_path):
    """An answer that cannot be written is refused in one line before solving and leaves nothing."""
    blocked = tmp_path / "file"
    blocked.write_text("in the way")
    before = sorted(tmp_path.rglob("*"))
    for target in (blocked / "x.json", tmp_path / "absent" / "x.json", tmp_path):
        path = case()
        refused("solve", path, "--model", "fe", "--json", target, says=f"{target}: cannot be written")
        path.unlink()
    assert sorted(tmp_path.rglob("*")) == before


def test_unwritable_results_are_refused_before_computing(refused, tmp_path):
    """A results folder that cannot be written is refused in one line, before anything is computed."""
    blocked = tmp_path / "file"
    blocked.write_text("in the way")
    refused("run", "fig04_trajectory", "--results", blocked / "results", says="cannot be written")


def test_bad_input_as_a_user_sees_it(tmp_path):
    """The process itself ends with exit code 2, one line on the error stream and no traceback."""
    case = tmp_path / "case.toml"
    case.write_text("[strip]\nlenght_m = 1\n", encoding="utf-8")
    words = [sys.executable, "-m", "studies", "solve", str(case), "--model", "fe"]
    done = subprocess.run(words, cwd=Path(ROOT), capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert done.stdout == ""
    assert done.stderr == (
        f"studies: {case}: strip.lenght_m: got an unknown key, expected length_m (the nearest name)\n"
    )
