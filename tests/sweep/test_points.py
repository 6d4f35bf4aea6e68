"""Rows of a sweep: the numbers of the answers, come what may; samples; DESIGNS.toml that cannot be used."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import qmc

from studies.answers.adapters import answer_static
from studies.answers.settings import FeSettings, SplineSettings
from studies.answers.validity import validity
from studies.cases.design import named_design
from studies.cases.document import CaseError
from studies.cases.effects import DEFAULT, Effects
from studies.cases.problem import FOLDER, named_case
from studies.cases.section import of_sides
from studies.sweep import points
from studies.sweep.plan import Plan
from studies.sweep.points import PATH, SHIFT, WORTH, solve, values
from studies.sweep.run import sweep
from tests.sweep.sweeps import GRID, RANDOM, plan, within


def rows(asked: Plan, start=0, stop=None):
    """Return the rows of points of a sweep."""
    columns = asked.rows(start, asked.points if stop is None else stop)
    return points.solve_chunk(asked.task, start, columns).to_pandas()


def test_rows_are_what_solve_answers():
    """Requirement: a row of a pivot, whatever varies, has the numbers of `solve` to the last digit."""
    asked = plan(RANDOM.replace("points = 104", "points = 3"))
    for row in rows(asked).to_dict("records"):
        given = {key: row[key] for key in asked.columns}
        answer = answer_static(asked.task.design(given), SplineSettings())
        assert row["torque_Nm"] == answer.torque[-1]
        assert row["stress_max_Pa"] == answer.max_stress.max()
        assert row["estimated_error"] == answer.largest_error


def test_a_mechanism_is_swept_by_its_parts():
    """Requirement: keys of one strip and one body of a mechanism vary, and its bodies' places are stored."""
    asked = plan("""
        case = "four_bar_of_flexures"
        set.drive = { rotation_deg = 5, increments = 2 }
        vary.strips.crank_coupler.thickness_m = [3e-4, 4e-4]
        vary.bodies.coupler.centre_m.y = [0.1, 0.12]
    """)
    found = rows(asked)
    design = named_design("four_bar_of_flexures")
    strips = tuple(
        replace(strip, thickness=4e-4, **of_sides(0.01, 4e-4)) if strip.name == "crank_coupler" else strip
        for strip in design.strips
    )
    turned = replace(design, strips=strips, rotation=math.radians(5), increments=2)
    answer = answer_static(turned, SplineSettings())
    assert found["torque_Nm"][2] == answer.torque[-1]
    assert found["rocker_rotation_rad"][2] == answer.bodies["rocker"][-1, 2]
    assert found["coupler_y_m"][3] - found["coupler_y_m"][2] == pytest.approx(0.02, rel=0.2)
    assert (found["stress_max_Pa"] > 0).all()


def test_designs_without_an_answer_are_rows_with_their_reason():
    """Requirement: what stops, and what a model refuses, keeps its row, without numbers and with why."""
    found = rows(
        plan("""
            case = "cross_axis_pivot"
            set.drive = { rotation_deg = 350, increments = 2 }
            settings.control_points = 4
            vary.strip.crossing_ratio = [0.05, 0.5]
        """)
    )
    assert len(found) == 2
    stopped = found["status"] == "not_converged"
    assert stopped.any()
    assert (found["reason"][stopped].str.len() > 10).all()
    assert found["torque_Nm"][stopped].isna().all()
    refused = rows(plan('case = "cross_axis_pivot"\nvary.scene.effects = ["bending,stretching", "gravity"]'))
    assert refused["status"][0] == "converged"
    assert refused["status"][1] != "converged"
    assert refused["reason"][1]


def test_a_fault_at_one_design_is_told_in_its_row(monkeypatch):
    """Requirement: an error that nobody foresaw costs its own design only."""
    asked = plan(GRID)
    real = points.answer_static

    def faulty(design, settings):
        if design.crossing_ratio == 0.5:
            raise ZeroDivisionError("seen by nobody")
        return real(design, settings)

    monkeypatch.setattr(points, "answer_static", faulty)
    found = rows(asked)
    assert list(found["status"]).count("failed") == 4
    assert set(found["reason"]) == {"error not estimated", "ZeroDivisionError: seen by nobody"}


#: Natural curvature that the drive of the pivot undoes, so that the stress falls on the way.
UNBENT = replace(
    named_case("cross_axis_pivot"),
    rotation=0.2,
    increments=8,
    effects=Effects(names=(*DEFAULT, "pre_strain"), tables={"pre_strain": {"curvature": 3.0}}),
)


@pytest.mark.parametrize(
    "settings", [SplineSettings(control_points=6), FeSettings(elements=10)], ids=lambda s: s.model
)
def test_values_are_those_of_the_answer(settings):
    """Requirement: quantities are those of `solve`, and stress_max_Pa and its kin the largest of all states,
    also of a path that relaxes."""
    answer = answer_static(UNBENT, settings)
    found = values(PATH | WORTH | SHIFT, answer)
    stress, torque = answer.max_stress, np.abs(answer.torque)
    assert stress.max() > 1.2 * stress[-1] and torque.max() > 1.2 * torque[-1]  # the path does relax
    shift = np.hypot(*answer.centre_shift.T)
    expected = {
        "torque_max_Nm": torque.max(),
        "stress_end_Pa": stress[-1],
        "stress_max_Pa": stress.max(),
        "strain_max": validity(answer).strain,
        "stiffness_rest_Nm_per_rad": answer.stiffness[0],
        "stiffness_end_Nm_per_rad": answer.stiffness[-1],
        "stiffness_variation": np.ptp(answer.stiffness) / answer.stiffness[0],
        "centre_shift_end_m": shift[-1],
        "centre_shift_max_m": shift.max(),
    }
    assert {name: found[name] for name in expected} == pytest.approx(expected, rel=1e-9)


def drawn(text, *cuts):
    """Return the sample in pieces between the cuts, joined."""
    asked = plan(text)
    pieces = [asked.rows(a, b) for a, b in zip((0, *cuts), (*cuts, asked.points), strict=True)]
    return {key: [value for piece in pieces for value in piece[key]] for key in pieces[0]}


def test_a_grid_holds_every_combination_once():
    """Requirement: a grid is the product of its axes, the last fastest, with the ends as they are written."""
    columns = drawn(GRID)
    rows = list(zip(*columns.values(), strict=True))
    assert len(rows) == len(set(rows)) == 12
    assert rows[:4] == [(0.3, 4, 0.0), (0.3, 4, 0.01), (0.3, 6, 0.0), (0.3, 6, 0.01)]
    assert columns["strip.crossing_ratio"][-1] == 0.7


def test_a_list_runs_along_all_columns_at_once():
    """Requirement: a list takes the first of every key, then the second."""
    listed = """
        case = "cross_axis_pivot"
        sample.method = "list"
        vary.strip.crossing_ratio = [0.2, 0.4]
        vary.strip.inclination_deg = [30, 50]
    """
    assert drawn(listed) == {"strip.crossing_ratio": [0.2, 0.4], "strip.inclination_deg": [30.0, 50.0]}


@pytest.mark.parametrize("text", [GRID, RANDOM], ids=["grid", "sobol"])
def test_a_sample_does_not_depend_on_its_pieces(text):
    """Requirement: the points are the same in one piece and in several."""
    whole = drawn(text)
    assert drawn(text, 1, 5, 7) == whole


def test_random_points_are_those_of_scipy():
    """Requirement: the points are scipy's, spread over the ranges; a logarithmic one in its logarithm."""
    columns = drawn(RANDOM.replace("104\nchunk", "256\nchunk"))
    unit = qmc.Sobol(d=3, seed=0).random(256)
    assert np.allclose(columns["strip.crossing_ratio"], 0.1 + 0.8 * unit[:, 0], rtol=1e-14)
    logarithm = np.log(columns["strip.slenderness"])
    assert np.allclose(logarithm, math.log(20) + math.log(10) * unit[:, 2], rtol=1e-14)


def test_another_seed_is_another_sample():
    """Requirement: the seed counts."""
    assert drawn(RANDOM) != drawn(RANDOM.replace("chunk", "seed = 1\nchunk"))


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
EVEN = 'sample.method = "grid"'

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
    (
        {"sample": EVEN, "vary": "vary.strip.crossing_ratio = { from = 0.1, to = 0.9 }"},
        "points: got no such",
    ),
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


def test_the_good_file_is_good(tmp_path):
    """The checks above refuse the change, not the file."""
    assert sweep(plan("\n".join(GOOD.values())), tmp_path / "out", pool=within()) == 8


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
