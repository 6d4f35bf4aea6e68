"""Case files as a designer writes them: sections, materials, directions, templates, scenes, tapers."""

import json
import math
import tomllib
from dataclasses import fields, replace
from types import SimpleNamespace

import numpy as np
import pytest

from spline_model import DEFAULT_EFFECTS, REGISTRY
from studies.cases.design import as_toml, document_of, read_design
from studies.cases.effects import DEFAULT, Effects
from studies.cases.keys import EFFECT_KEYS, EFFECTS, MATERIALS, OWN
from studies.cases.keys import EFFECT_KEYS as KEYS
from studies.cases.mechanism import Body, Mechanism, Strip
from studies.cases.problem import FOLDER, CaseError, Problem, named_case
from studies.commands.case import MECHANISM, PIVOT
from tests.one_strip import SECOND_MOMENT, one_strip

DECLARED = [
    *(key for each in (PIVOT, MECHANISM, EFFECT_KEYS) for keys in each.values() for key in keys),
    *OWN,
]
AREA, MOMENT = "width_m = 0.01000320153681966", "thickness_m = 0.0049983997439180475"


def test_every_key_says_what_it_is():
    """A key has a meaning and an example that its own rule admits, and a default if it is optional."""
    assert set(EFFECT_KEYS) == set(EFFECTS)
    for key in DECLARED:
        key.rule.parse(tomllib.loads(f"value = {key.example}")["value"])
        assert key.meaning, key
        assert bool(key.default) == key.optional, key


@pytest.mark.parametrize("kind", ["pivot", "mechanism"])
@pytest.mark.parametrize("model", [["--model", "spline"], ["--model", "fe", "--elements", "8"]])
def test_template_is_solved_as_it_is(kind, model, command, tmp_path):
    """What `case` prints is a case file that either model solves; every line of it is explained."""
    path = tmp_path / "my.toml"
    assert command("case", f"--{kind}", "--out", path).code == 0
    assert path.read_text(encoding="utf-8") == command("case", f"--{kind}").out
    assert json.loads(command("solve", path, *model, "--json", "-").out)["status"] == "converged"
    assert isinstance(read_design(path), Problem) == (kind == "pivot")


def test_sides_are_area_and_second_moment(case):
    """A rectangle by its sides has A = b h and I = b h^3 / 12, keeps the sides and hands them on."""
    found = read_design(case((AREA, "width_m = 0.01 "), (MOMENT, "thickness_m = 0.004 ")))
    assert isinstance(found, Problem)
    assert (found.width, found.thickness, found.depth) == (0.01, 0.004, pytest.approx(0.004))
    assert found.area == pytest.approx(4e-5, rel=1e-15)
    assert found.second_moment_of_area == pytest.approx(0.01 * 0.004**3 / 12.0, rel=1e-15)
    given = found.pivot_parameters()
    assert (given["width"], given["thickness"]) == (0.01, 0.004)
    moments = case((AREA, "area_m2 = 5e-5 "), (MOMENT, "second_moment_m4 = 1e-10 "))
    assert "width" not in read_design(moments).pivot_parameters()
    with pytest.raises(
        CaseError, match="strip_1: got no sides for clamped_width and anticlastic, expected wid"
    ):
        read_design(moments, changes="+clamped_width,+anticlastic")


@pytest.mark.parametrize("name", MATERIALS)
def test_named_material_fills_what_no_key_gives(name, case):
    """A named material gives every value that is missing in the case, and a key beside it is taken as it
    is."""
    keys = ("youngs_modulus_Pa = 206e9", "poisson_ratio = 0.29", "density_kg_m3 = 7800")
    found = read_design(case((keys[0], f'name = "{name}"'), (keys[1], ""), (keys[2], "density_kg_m3 = 1234")))
    given = MATERIALS[name]
    assert isinstance(found, Problem)
    assert (found.youngs_modulus, found.poisson_ratio) == (given["youngs_modulus"], given["poisson_ratio"])
    assert (found.yield_strength, found.density) == (given.get("yield_strength"), 1234.0)


@pytest.mark.parametrize(("name", "turned"), [("silicon_100", False), ("silicon_110", True)])
def test_silicon_follows_from_the_constants_of_its_crystal(name, turned):
    """Along <100> and <110> modulus and Poisson's ratio to <001> are those of the cubic crystal."""
    c11, c12, c44 = 166e9, 64e9, 80e9
    s11 = (c11 + c12) / ((c11 - c12) * (c11 + 2.0 * c12))
    s12 = -c12 / ((c11 - c12) * (c11 + 2.0 * c12))
    modulus = 1.0 / (s11 - 0.5 * (s11 - s12 - 0.5 / c44) * turned)
    given = MATERIALS[name]
    assert given["youngs_modulus"] == pytest.approx(modulus, rel=5e-3)
    assert given["poisson_ratio"] == pytest.approx(-s12 * modulus, abs=5e-3)


def test_materials_say_what_was_found_again():
    """Every material has a source, and says which of its values were found again, and where."""
    assert all(
        given["source"] and ("http" in given["checked"] or "not" in given["checked"])
        for given in MATERIALS.values()
    )


#: The guide, its strips with sections and materials of their own.
OWN_SECTIONS = {
    'name = "left"': 'name = "left"\narea_m2 = 1e-5\nsecond_moment_m4 = 1e-12\nmaterial = "peek"',
    'name = "right"': 'name = "right"\nthickness_m = 0.002',
    "thickness_m = 0.0005": "thickness_m = 0.001",
    "youngs_modulus_Pa = 206e9\npoisson_ratio = 0.29": 'name = "titanium_6al_4v"',
    "density_kg_m3 = 7800": "density_kg_m3 = 1000",
}


def test_a_strip_has_its_own_section_and_material(tmp_path):
    """A strip's own pair replaces the pair that all have, a side this side, a named material all values."""
    path, text = tmp_path / "guide.toml", (FOLDER / "parallel_strip_guide.toml").read_text(encoding="utf-8")
    for old, new in OWN_SECTIONS.items():
        assert old in text
        text = text.replace(old, new)
    path.write_text(text, encoding="utf-8")
    found = read_design(path)
    assert isinstance(found, Mechanism)
    own, shared = found.strips
    assert (own.area, own.width, own.youngs_modulus, own.density) == (1e-5, None, 4.0e9, 1300.0)
    assert (shared.width, shared.thickness, shared.area) == (0.01, 0.002, pytest.approx(2e-5))
    assert (shared.youngs_modulus, shared.density, shared.yield_strength) == (113.8e9, 1000.0, 880e6)
    given = SimpleNamespace(
        StripDesign=dict, BodyDesign=dict, compliant_mechanism=lambda strips, bodies: strips
    )
    strips = found.modelled(given)
    assert all("yield_strength" not in each for each in strips)
    assert [each.get("width") for each in strips] == [None, 0.01]


@pytest.mark.parametrize(
    ("table", "expected"), [("acceleration_m_per_s2 = [1.62, 0]", (1.62, 0.0)), ("", (0.0, -9.81))]
)
def test_gravity_by_its_parts(table, expected, case):
    """Gravity is given by its two parts, downwards if unsaid."""
    path = case(("[drive]", f'[scene]\neffects = ["+gravity"]\n[effects.gravity]\n{table}\n[drive]'))
    found = read_design(path).effects.parameters()["gravity"]["acceleration"]
    assert found == pytest.approx(expected, abs=1e-14)


WRITTEN = [
    design for path in sorted(FOLDER.glob("*.toml")) if isinstance(design := read_design(path), Problem)
]
LOADED = Effects(
    names=("bending", "stretching", "gravity", "applied_force"),
    tables={
        "gravity": {"acceleration": (1.0, -9.81)},
        "applied_force": {"force": (0.0, -2.5), "history": ((0.0, 0.0), (0.01, 1.0))},
    },
)
OTHER = {
    "effects": LOADED,
    "orientation": 0.3,
    "held": (0.0, 0.5),
    "order": "together",
    "yield_strength": 5e8,
}


@pytest.mark.parametrize("design", [*WRITTEN, replace(WRITTEN[0], **OTHER)])
def test_a_pivot_that_is_written_is_read_as_it_was(design, tmp_path):
    """A pivot written as a case file is read as the same pivot, to the digits that a file has."""
    path = tmp_path / "written.toml"
    path.write_text(as_toml(document_of(design), ["one", "two"]), encoding="utf-8")
    assert path.read_text(encoding="utf-8").startswith("# one\n# two\n\n[strip]\n")
    found = named_case(path)
    assert found.effects == design.effects
    assert found.effects.parameters() == design.effects.parameters()
    for each in fields(design):
        if each.init and each.name != "effects":
            value = getattr(design, each.name)
            exact = value is None or isinstance(value, str)
            assert getattr(found, each.name) == (value if exact else pytest.approx(value, rel=1e-14))


def test_a_mechanism_that_is_written_is_read_as_it_was(tmp_path):
    """Free ends, hinges, followers and lists of loads survive a case file."""
    force = {"body": "platform", "force": (0.0, -2.5), "follower": True}
    loads = ({"force": (1.0, 2.0), "body": "platform", "follower": False}, force)
    rod = {"area": 2e-6, "second_moment_of_area": 2e-12, "youngs_modulus": 2e11}
    rod |= {"poisson_ratio": 0.3, "density": 7800.0}
    design = Mechanism(
        strips=(
            Strip(name="leg", start=(0.0, 0.0), end=(0.0, 0.1), tip="platform", root_joint="hinge", **rod),
            Strip(name="arm", start=(0.0, 0.1), end=(0.1, 0.1), root="platform", tip=None, **rod),
        ),
        bodies=(Body(name="platform", centre=(0.0, 0.1), mass=0.1, moment_of_inertia=1e-4),),
        body="platform",
        rotation=None,
        increments=4,
        effects=Effects(names=("bending", "applied_force"), tables={"applied_force": loads}),
    )
    path = tmp_path / "written.toml"
    path.write_text(as_toml(document_of(design)), encoding="utf-8")
    assert read_design(path) == design


#: A coarse discretisation of each model; the splines' is nearly exact.
COARSE = {"spline": [], "fe": ["--elements", 8]}


SHIPPED = sorted(path.stem for path in FOLDER.glob("*.toml"))
QUICK = ("cross_axis_pivot", "parallel_strip_guide")


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=[] if name in QUICK else pytest.mark.slow) for name in SHIPPED]
)
def test_shipped_cases_take_the_effects_of_their_sides(name, answered):
    """Every case that comes with the suite names its sides: both models take what asks for them, alike."""
    words = ("solve", name, "--effects=+clamped_width,+anticlastic,+root_compliance", "--increments", 2)
    spline, fe = (
        answered(*words, "--model", model, *coarse)["strain_energy_J"][-1] for model, coarse in COARSE.items()
    )
    assert fe == pytest.approx(spline, rel=5e-3)  # eight elements leave 2e-3 of Table 1's at 90 degrees


@pytest.mark.parametrize("model", ["spline", "fe"])
def test_tables_of_effects_are_there_for_the_command_line(model, case, answered):
    """A table gives the parameters of an effect that --effects adds; without it weight is the earth's. A
    scene in the case gives the same, and a table that --effects takes out stays behind."""
    end = ("increments = 20", "increments = 2\n[effects.gravity]\nacceleration_m_per_s2 = [0, -9810]")
    words = ["--model", model, *COARSE[model], "--rotation-deg", 1, "--increments", 2]
    bare = answered("solve", case(), *words)
    assert bare["effects"] == ["bending", "stretching"]
    shifts = []
    for changes in ((), (end,)):
        loaded = answered("solve", case(*changes), *words, "--effects=+gravity")
        shifts.append(loaded["com_y_m"][0] - bare["com_y_m"][0])
    named = case((end[0], end[1].replace("[eff", '[scene]\neffects = ["+gravity"]\n[eff')))
    heavy = answered("solve", named, *words)
    assert heavy["com_y_m"] == loaded["com_y_m"]
    assert answered("solve", named, *words, "--effects=-gravity")["com_y_m"] == bare["com_y_m"]
    assert shifts[0] < 0.0
    assert shifts[1] == pytest.approx(1000.0 * shifts[0], rel=0.05)  # nearly linear


def test_effects_of_case_files_are_those_of_the_splines():
    """Every effect with keys is in the registry but the elements' shear; the default ones are the same."""
    assert set(KEYS) - {"shear"} <= set(REGISTRY)
    assert DEFAULT_EFFECTS == DEFAULT


#: A round rod of 8 mm and 100 mm with 25 N at its tip.
DIAMETER, LENGTH, LOAD = 8e-3, 0.1, 25.0
ROD_AREA, ROD_MOMENT = math.pi * DIAMETER**2 / 4.0, math.pi * DIAMETER**4 / 64.0
ROD = f"""
effects = ["bending", "stretching", "strip_inertia", "tip_force"]
[effects.tip_force]
strip = "strip"
force_N = [0, {-LOAD}]
"""
FIBRE = f"outer_fibre_m = {DIAMETER / 2.0}"


def rod(shared="", own=""):
    """The case of the rod, with more lines in [section] and for the strip."""
    text = one_strip(ROD).replace('tip = "free"', f'tip = "free"\n{own}')
    text = text.replace("area_m2 = 5e-6", f"area_m2 = {ROD_AREA}\n{shared}")
    return text.replace(f"= {SECOND_MOMENT}", f"= {ROD_MOMENT}")


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
    own, found = f"{FIBRE}\narea_m2 = {ROD_AREA}\nsecond_moment_m4 = {ROD_MOMENT}", []
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
    text = rod().replace(f"area_m2 = {ROD_AREA}", TAPERED).replace(f"second_moment_m4 = {ROD_MOMENT}", "")
    (tmp_path / "taper.toml").write_text(text.replace(f"{-LOAD}", "-1e-3"))
    asked = ("solve", tmp_path / "taper.toml", "--model", model, "--accuracy", 1e-5, "--json", "-")
    x = np.linspace(0.0, 1.0, 100_001)
    right = 1e-3 * LENGTH * (1.0 - x) / (0.01 * (1.0 - 0.2 * x) * (1e-3 * (1.0 - 0.5 * x)) ** 2 / 6.0)
    found = json.loads(command(*asked).out)["strength"]
    assert found["max_stress_Pa"] == pytest.approx(right.max(), rel=1e-4)
    assert found["station"] == pytest.approx(x[right.argmax()], abs=0.02)


def test_a_byte_order_mark_is_no_fault(tmp_path, command):
    """Editors that begin a file with the mark of UTF-8 are understood."""
    path = tmp_path / "rod.toml"
    path.write_text(rod(), encoding="utf-8-sig")
    assert command("solve", path).code == 0
