"""Senseless scenes, on the command line or in a case file, are one clear line and exit code 2."""

import pytest

from studies.cases.problem import FOLDER

#: `--effects`, model, verb, and what the one line must say.
REFUSED = {
    "unknown": (
        "+gravty",
        "spline",
        "solve",
        "--effects: got gravty, expected gravity (the nearest name), or one of",
    ),
    "nonsense": (
        "+zzz",
        "fe",
        "solve",
        "--effects: got zzz, expected one of bending, stretching, inextensible,",
    ),
    "there already": (
        "+bending",
        "spline",
        "solve",
        "got +bending, expected an effect beside bending, stretching",
    ),
    "not there": (
        "-gravity",
        "spline",
        "modes",
        "got -gravity, expected one of bending, stretching, strip_inertia",
    ),
    "some signs": ("+gravity,bending", "spline", "solve", "expected +NAME and -NAME, or names alone"),
    "empty": ("", "spline", "solve", "--effects: got '', expected +NAME"),
    "no parameter": (
        "+strip_damping",
        "spline",
        "release",
        "effects.strip_damping.relaxation_time_s: got no such key, expected a number of at least 0 [s]",
    ),
    "contradiction": (
        "+inextensible",
        "spline",
        "solve",
        "effects: got 'stretching and inextensible', expected one of stretching, inextensible, not both",
    ),
    "no stiffness": (
        "-bending",
        "spline",
        "solve",
        "expected bending, without which a strip has no stiffness",
    ),
    "no axial part": ("-stretching", "spline", "solve", "expected stretching or inextensible beside bending"),
    "no inertia": (
        "-strip_inertia,-body_inertia",
        "spline",
        "release",
        "got ['bending', 'stretching'], expected one of strip_inertia, section_rotary_inertia, body_inertia",
    ),
    "no inertia in modes": (
        "bending,stretching",
        "spline",
        "modes",
        "expected one of strip_inertia, section_",
    ),
    "no inertia of elements": (
        "bending,stretching",
        "fe",
        "release",
        "expected strip_inertia or body_inertia",
    ),
    "rigid elements": (
        "-stretching,+inextensible",
        "fe",
        "solve",
        "fe: effects: got 'inextensible', expected one of",
    ),
}


@pytest.mark.parametrize("name", REFUSED)
def test_senseless_effects_are_one_line(name, case, refused):
    """Unknown, contradictory and missing effects are one line that lists what there is, and exit code 2."""
    change, model, verb, text = REFUSED[name]
    refused(verb, case(), "--model", model, f"--effects={change}", says=text)


#: What is written over a mechanism's case, and what the one line must say.
BAD_SCENES = {
    "unknown effect": (
        '"gravity"]',
        '"gravty"]',
        "scene.effects: got gravty, expected gravity (the nearest name)",
    ),
    "effects no list": (
        'effects = ["bending"',
        'effects = "bending" #',
        'scene.effects: got the text "bending", expected a list',
    ),
    "some signs": (
        'effects = ["bending"',
        'effects = ["+bending"',
        'strip_inertia,body_inertia,gravity", expected +NAME and -NAME, or names alone',
    ),
    "a load that is not named": (
        "[drive]",
        "[effects.applied_force]\nforce_N = [0, -1]\n[drive]",
        "effects.applied_force: got it, but the scene does not name applied_force, "
        'expected "applied_force" in scene.effects as well',
    ),
    "unknown table": ("[drive]", "[effects.gravty]\n[drive]", "effects: got gravty, expected gravity"),
    "unknown parameter": (
        "[drive]",
        "[effects.gravity]\ng = 9.81\n[drive]",
        "effects.gravity.g: got an unknown key, expected one of acceleration_m_per_s2",
    ),
    "one component": (
        "[drive]",
        "[effects.gravity]\nacceleration_m_per_s2 = [9.81]\n[drive]",
        "effects.gravity.acceleration_m_per_s2: got [9.81], expected two finite numbers [x, y] [m/s^2]",
    ),
    "needed parameter": (
        '"gravity"]',
        '"strip_drag"]',
        "effects.strip_drag.rate_per_s: got no such key, expected",
    ),
    "negative parameter": (
        "[drive]",
        "[effects.strip_drag]\nrate_per_s = -1\n[drive]",
        "effects.strip_drag.rate_per_s: got -1, expected a number of at least 0 [1/s]",
    ),
    "history in disorder": (
        "[drive]",
        "[effects.applied_moment]\nmoment_Nm = 1\nhistory = [[0, 0], [0, 1]]\n[drive]",
        "effects.applied_moment.history: got [[0, 0], [0, 1]], expected pairs [time, factor] with increasing",
    ),
    "unknown body": (
        'tip = "crank"',
        'tip = "crnk"',
        "strips.ground_crank.tip: got crnk, expected crank (the nearest",
    ),
    "no tip": (
        'tip = "crank"',
        "",
        "strips.ground_crank.tip: got no such key, expected ground or the name of a body",
    ),
    "no name": ('name = "ground_crank"', "", "strips number 1.name: got no such key, expected a name"),
    "same name": ('name = "coupler"\n', 'name = "crank"\n', "name: got crank, expected different names"),
    "no length": (
        "end_m = [0, 0.02]",
        "end_m = [0, 0]",
        "strips.ground_crank.end_m: got [0.0, 0.0], where it begins, expected a length",
    ),
    "misspelt key": (
        "mass_kg = 0.1",
        "mas_kg = 0.1",
        "bodies.coupler.mas_kg: got an unknown key, expected mass_kg",
    ),
    "negative mass": (
        "mass_kg = 0.1",
        "mass_kg = -1",
        "bodies.coupler.mass_kg: got -1, expected a number of at least",
    ),
    "no section": (
        "area_m2 = 3e-6",
        "",
        "strips.ground_crank.area_m2: got no such key there nor in [section], expected a positive number",
    ),
    "misspelt section": (
        "[section]",
        "[sektion]",
        "[sektion]: got an unknown section, expected section (the nearest",
    ),
    "whose drive": (
        'body = "crank"',
        "",
        "drive.body: got no such key, expected one of crank, coupler, rocker",
    ),
    "drive of nothing": ('body = "crank"', 'body = "lever"', "drive.body: got lever, expected"),
    "no drive": ("[drive]\nbody", "[drivee]\nbody", "[drivee]: got an unknown section, expected drive"),
    "strips no tables": ("[section]", "[[section]]", "section: got list, expected a table [section]"),
}


@pytest.mark.parametrize("name", BAD_SCENES)
def test_bad_scene_is_one_line(name, tmp_path, refused):
    """A mechanism's case file with a fault is refused with file, key, got and expected in one line."""
    old, new, text = BAD_SCENES[name]
    content = (FOLDER / "four_bar_of_flexures.toml").read_text(encoding="utf-8")
    assert old in content
    path = tmp_path / "case.toml"
    path.write_text(content.replace(old, new, 1), encoding="utf-8")
    assert refused("solve", path, "--model", "spline", says=text).startswith(f"studies: {path}: ")


def test_refining_needs_a_rotation(refused):
    """Errors are related to a rotation: a mechanism that follows its loads is refused in one line."""
    text = "drive.rotation_deg: got none, expected a rotation to relate errors to"
    refused("converge", FOLDER / "parallel_strip_guide.toml", says=text)


@pytest.mark.parametrize("head", ["strips = []", "strips = [1]"])
def test_mechanism_without_strips_is_refused(head, tmp_path, refused):
    """A mechanism needs strips, each a table of its own."""
    path = tmp_path / "case.toml"
    path.write_text(f"{head}\n[drive]\nincrements = 2\n", encoding="utf-8")
    refused("modes", path, "--model", "spline", says=f"strips: got {head[9:]}, expected tables [[strips]]")
