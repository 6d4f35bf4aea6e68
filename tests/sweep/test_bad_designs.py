"""DESIGNS.toml that cannot be used: one line each that says what and where, and nothing is written."""

import pytest

from studies.__main__ import main
from studies.cases.document import CaseError
from studies.cases.problem import FOLDER
from studies.sweep.points import solve
from tests.sweep.sweeps import plan

GOOD = {
    "case": 'case = "cross_axis_pivot"',
    "model": 'model = "spline"',
    "settings": "settings.control_points = 6",
    "set": "set.drive.rotation_deg = 45",
    "analysis": 'analysis.kind = "static"',
    "sample": 'sample = { method = "sobol", points = 8 }',
    "vary": "vary.strip.crossing_ratio = { from = 0.1, to = 0.9 }",
    "store": 'store.quantities = ["torque_Nm"]',
}
GRID = 'sample.method = "grid"'

BAD = [
    ({"case": ""}, "case: got None, expected the name of a case"),
    ({"case": 'case = "cross_axis_pivvot"'}, "cross_axis_pivot (the nearest name)"),
    ({"case": 'case = "cross_axis_pivot"\nmodell = "fe"'}, "modell: got an unknown name, expected model"),
    ({"case": "strip.length_m = 0.08"}, "[strip]: got a case, expected a sweep, which names one"),
    ({"model": 'model = "splines"'}, 'model: got the text "splines", expected spline (the nearest name)'),
    ({"settings": "settings.control_point = 6"}, "control_points (the nearest name)"),
    ({"settings": 'settings.stretch = "mixd"'}, "stretch: got 'mixd'"),
    ({"set": "set.drive.increments = 0"}, "set.drive.increments: got 0, expected a whole number from 1"),
    ({"set": "set.settings.control_points = 4"}, "got a setting, expected it in [settings]"),
    ({"analysis": 'analysis.kind = "statics"'}, "expected static (the nearest name)"),
    ({"analysis": "analysis.duration_s = 1"}, "analysis.duration_s: got an unknown key"),
    ({"sample": 'sample = { method = "sobol", points = 0 }'}, "sample.points: got 0, expected a whole"),
    ({"sample": 'sample = { method = "sobol" }'}, "sample.points: got no such key"),
    ({"sample": 'sample = { method = "grid", points = 8 }'}, "sample.points: got it for a grid"),
    ({"vary": ""}, "[vary]: got nothing to vary"),
    ({"vary": "vary.strips.left.area_m2 = [1e-5]"}, "got no key of the case"),
    ({"vary": "vary.foo = [1]"}, " names, which docs/cases.md lists"),
    ({"vary": "vary.strip.crossing_ratio = 0.5"}, "vary.strip.crossing_ratio: got 0.5, expected a list or"),
    ({"vary": "vary.strip.crossing_ratio = { from = 0.5, to = 0.5 }"}, "got an empty range from 0.5 to 0.5"),
    ({"vary": "vary.strip.crossing_ratio = { from = 0.5 }"}, "to: got no such key, expected a number"),
    ({"vary": 'vary.body.centre_offset_m.x = { from = 0, to = 1, scale = "log" }'}, "expected it above 0"),
    ({"vary": "vary.strip.crossing_ratio = []"}, "got [], expected a list of values"),
    ({"vary": "vary.strip.crossing_ratio = { values = [0.5] }"}, "crossing_ratio.values: got no key of"),
    (
        {"vary": 'vary.effects.driven_displacement.displacement_m = [["free", 0.1], [0.1, 0.1]]'},
        "got values of different types, expected numbers, texts or pairs of numbers alone",
    ),
    ({"vary": "vary.drive.increments = { from = 5, to = 9 }"}, "got a range, expected values"),
    ({"vary": "vary.strip.slenderness = [50]\nvary.strip.area_m2 = [1e-5]"}, "beside strip.area_m2"),
    ({"sample": GRID, "vary": "vary.strip.crossing_ratio = { from = 0.1, to = 0.9 }"}, "points: got no such"),
    (
        {
            "sample": 'sample.method = "list"',
            "vary": "vary.strip = { crossing_ratio = [0.5], length_m = [1, 2] }",
        },
        "got lists of different lengths (strip.crossing_ratio 1, strip.length_m 2)",
    ),
    ({"store": 'store.quantities = ["torque"]'}, "expected torque_Nm (the nearest name)"),
    ({"set": "set = 3"}, "set: got int, expected a table [set]"),
    ({"case": "case = "}, "got text that is not TOML"),
]


@pytest.mark.parametrize(("change", "words"), BAD, ids=[words[:40] for _, words in BAD])
def test_bad_designs_are_one_line(change, words, tmp_path, refused):
    """Requirement: what is wrong with the file is one line with its key, and the folder is not made."""
    path = tmp_path / "designs.toml"
    path.write_text("\n".join((GOOD | change).values()))
    out = tmp_path / "out"
    refused("sweep", path, "--out", out, says=words)
    assert not out.exists()


def test_the_good_file_is_good(tmp_path, capsys):
    """The checks above refuse the change, not the file."""
    path = tmp_path / "designs.toml"
    path.write_text("\n".join(GOOD.values()))
    assert main(["sweep", str(path), "--out", str(tmp_path / "out")]) == 0
    assert "8 designs solved" in capsys.readouterr().out


@pytest.mark.parametrize("part", ["strips", "bodies"])
def test_a_part_without_a_name_is_named(part, tmp_path, refused):
    """Requirement: keys to vary go by the names of parts: a sweep and `size` refuse a part without one."""
    text = (FOLDER / "four_bar_of_flexures.toml").read_text(encoding="utf-8")
    before, mark, after = text.partition(f"[[{part}]]\n")
    case, path = tmp_path / "case.toml", tmp_path / "designs.toml"
    case.write_text(before + mark + after.partition("\n")[2], encoding="utf-8")
    path.write_text('case = "case.toml"\nvary.material.density_kg_m3 = [1000, 2000]')
    says = f"{part} number 1.name: got no such key"
    refused("sweep", path, "--out", tmp_path / "out", says=says)
    refused("size", case, "--free", "section.thickness_m", "--objective", "stress", says=says)


#: A grid over a load, with or without its name in the scene.
LOADED = """
case = "cross_axis_pivot"
[set]
drive.rotation_deg = 5
drive.increments = 1
{scene}
[vary]
effects.applied_moment.moment_Nm = [1.0, 2.0]
"""


def test_a_load_that_the_scene_does_not_name_is_no_axis():
    """Requirement: a sweep over a load is refused where no scene names it, and solved where one does."""
    with pytest.raises(CaseError, match=r"effects\.applied_moment: got it, but the scene does not name"):
        plan(LOADED.format(scene=""))
    named = 'scene.effects = "bending,stretching,strip_inertia,body_inertia,applied_moment"'
    asked = plan(LOADED.format(scene=named)).task
    status, _, _ = solve(asked, {"effects.applied_moment.moment_Nm": 1.0})
    assert status == "converged"


def test_a_scene_without_a_load_leaves_its_parameters_aside():
    """Requirement: a list of effects that is varied takes the case's parameters of what it drops with it."""
    guide = 'case = "parallel_strip_guide"\n[vary]\nscene.effects = [{lists}]\n'
    lists = ["bending,stretching,strip_inertia,body_inertia", "bending,stretching,applied_force"]
    asked = plan(guide.format(lists=", ".join(f'"{names}"' for names in lists))).task
    bare, loaded = (asked.design({"scene.effects": names}) for names in lists)
    assert set(bare.effects.tables) == set()
    assert set(loaded.effects.tables) == {"applied_force"}
