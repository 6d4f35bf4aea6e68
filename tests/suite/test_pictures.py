"""Pictures of answers, tables to read and panels of figures show what was solved, with nothing clipped."""

import json
import math
import re
from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
from matplotlib.text import Text

import fe_reference
import spline_model
import studies
from studies.__main__ import main
from studies.answers.adapters import answer_modes, answer_of, answer_release, answer_static
from studies.answers.settings import FeSettings, SplineSettings
from studies.cases.design import named_design
from studies.commands.columns import angle, fixed, plain, quantity, significant, table
from studies.errors import BadInput
from studies.pictures.page import picture
from studies.pictures.shown import Shown
from studies.record import style
from studies.record.panels import Axis, Curves, HeatMap, Level, Panel, sheet
from studies.record.style import BLUE, RED, Look
from tests.table_one import SIX, TABLE_ONE

SPLINE, ELEMENTS = SplineSettings(control_points=6), FeSettings(elements=4)
PIVOT, FOUR_BAR = "spring_steel_pivot", "four_bar_of_flexures"


@cache
def shown(kind):
    """What a picture shows of each kind of answer, by both models."""
    name, settings = {
        "path": (PIVOT, SPLINE),
        "path to an accuracy": (PIVOT, SplineSettings()),
        "path of elements": (PIVOT, ELEMENTS),
        "mechanism": (FOUR_BAR, SPLINE),
        "loads": ("parallel_strip_guide", SPLINE),
        "release": (PIVOT, SPLINE),
        "modes": (FOUR_BAR, ELEMENTS),
    }[kind]
    design = replace(named_design(name), increments=4)
    if kind == "release":
        answer = answer_release(design, settings, duration=5e-3, records=20)
    elif kind == "modes":
        answer = answer_modes(design, settings, count=3)
    else:
        answer = answer_static(design, settings)
    return Shown(name=kind, answer=answer, yield_strength=1.1e9), answer


SEVERAL = [
    ("path of elements",),
    ("mechanism",),
    ("release",),
    ("modes",),
    ("path", "path of elements", "mechanism"),
    ("path",) * 5,
]
KINDS = pytest.mark.parametrize(
    "kinds", [("path",), ("loads",), *(pytest.param(each, marks=pytest.mark.slow) for each in SEVERAL)]
)


@KINDS
def test_nothing_is_clipped_and_letters_have_eight_points(kinds):
    """All that is written lies within a page of 160 mm, in letters of 8 points and more."""
    figure = picture([shown(kind)[0] for kind in kinds])
    style.printed(figure, "svg")
    assert figure.get_figwidth() == pytest.approx(160.0 / 25.4)
    drawn = figure.get_tightbbox()  # of all that is visible, in inches
    width, height = figure.get_size_inches()
    assert min(drawn.x0, drawn.y0) >= 0.0
    assert drawn.x1 <= width
    assert drawn.y1 <= height
    for text in figure.findobj(Text):
        assert not text.get_text() or text.get_fontsize() >= 8.0, text.get_text()
    named = [panel.get_xlabel() + panel.get_ylabel() for panel in figure.axes if panel.get_ylabel()]
    assert named
    assert all("[" in label for label in named)


@pytest.mark.parametrize("kind", ["path", "path to an accuracy", "path of elements"])
def test_curves_are_the_answer(kind):
    """Shift, stress, energy and torque in a picture are those that the answer tells."""
    drawn, answer = shown(kind)
    assert answer.shift == pytest.approx(np.hypot(*answer.centre_shift.T), abs=1e-15)
    panels = {panel.get_ylabel().split(" [")[0]: panel for panel in picture([drawn]).axes}
    (line,) = panels["torque"].lines
    assert np.allclose(line.get_ydata(), answer.torque)
    assert {"stiffness", "centre shift", "largest stress", "energy"} < set(panels)
    assert any("yield 1100" in text.get_text() for text in panels["largest stress"].texts)


def test_an_answer_is_drawn_without_its_design():
    """An answer knows what was asked: it is drawn alone, and over another, as by model and design."""
    answer = shown("path")[1]
    assert b"svg" in style.printed(studies.plot(answer, name="alone").figure, "svg")
    assert b"svg" in style.printed(studies.overlay({"a": answer, "b": answer}).figure, "svg")
    assert answer_of(answer.solution, answer.asked.modelled).max_stress == pytest.approx(answer.max_stress)


def test_states_of_another_design_are_refused():
    """A solution and a design that do not go together are one line, in both models and between them."""
    pivot = fe_reference.cross_axis_pivot(**TABLE_ONE, elements=3)
    path = fe_reference.solve_statics(pivot, rotation=0.1, increments=1)
    with pytest.raises(fe_reference.InvalidParameter, match=r"states: got .*number of elements"):
        studies.plot(path, fe_reference.cross_axis_pivot(**TABLE_ONE, elements=4))
    splines = spline_model.cross_axis_pivot(**SIX)
    with pytest.raises(spline_model.InvalidParameter, match=r"states: got .*control points"):
        spline_model.strip_fields(splines, np.zeros((1, 5)))
    with pytest.raises(BadInput, match="got StaticSolution and Mechanism, expected"):
        studies.plot(path, splines)


def test_what_does_not_go_over_one_another_is_refused():
    """Six answers, kinds that differ, and a path of one state are one line."""
    path, motion = shown("path")[0], shown("release")[0]
    with pytest.raises(BadInput, match="got 6 of static"):
        picture([path] * 6)
    with pytest.raises(BadInput, match="got 2 of release, static"):
        picture([path, motion])
    with pytest.raises(BadInput, match="got 2 of modes"):
        picture([shown("modes")[0]] * 2)
    start = replace(path, answer=replace(path.answer, solution=SimpleNamespace(load_factor=[0.0])))
    with pytest.raises(BadInput, match="too few states"):
        picture([start])


#: Endings of pictures and how their files begin; each kind takes half a second.
BEGINS = {"svg": b"<?xml", "pdf": b"%PDF", "png": b"\x89PNG"}


@pytest.mark.parametrize(
    "kind", ["svg", *(pytest.param(each, marks=pytest.mark.slow) for each in ("pdf", "png"))]
)
def test_command_writes_a_picture_beside_its_answer(kind, tmp_path, capsys):
    """--plot writes a file of its ending and prints its name on the stream without JSON."""
    path = tmp_path / f"drawn.{kind}"
    words = ["solve", PIVOT, "--model", "fe", "--elements", "4", "--increments", "2"]
    assert main([*words, "--plot", str(path), "--json", "-"]) == 0
    assert path.read_bytes().startswith(BEGINS[kind])
    said = capsys.readouterr()
    assert json.loads(said.out)["status"] == "converged"
    assert f"{path}: the picture" in said.err


#: A pivot 1 mm long of silicon strips 20 um by 50 um, written over Table 1.
SMALL = (
    ("length_m = 0.08485281374238571", "length_m = 1e-3"),
    ("width_m = 0.01000320153681966", "width_m = 5e-5"),
    ("thickness_m = 0.0049983997439180475", "thickness_m = 2e-5"),
    ("mass_kg = 0.2", "mass_kg = 1e-7"),
    ("moment_of_inertia_kg_m2 = 0.002", "moment_of_inertia_kg_m2 = 1e-14"),
)
WORDS = {
    "solve": ["--rotation-deg", 5, "--increments", 2],
    "release": ["--rotation-deg", 5, "--duration", 1e-3, "--step", 1e-5],
    "modes": ["--count", 3],
}


@pytest.mark.parametrize("name", WORDS)
def test_small_designs_print_digits(name, case, command):
    """In every table of a pivot a millimetre long no column is zeros, and no number is zero with a sign."""
    lines = command(name, case(*SMALL), "--model", "spline", *WORDS[name]).out.splitlines()
    first = next(place for place, line in enumerate(lines) if re.fullmatch(r"[\s\-\d.e+]+", line))
    rows = [line.split() for line in lines[first:] if re.fullmatch(r"[\s\-\d.e+]+", line)]
    assert len(rows) >= 3
    if name == "solve":  # a second table stands below
        assert all(len(row) == len(rows[-1]) for row in rows[3:])
        rows = rows[:3]
    for column in zip(*rows, strict=True):
        assert any(float(cell) != 0.0 for cell in column)
        assert not [cell for cell in column if re.fullmatch(r"-0(\.0*)?", cell)]
    if name == "solve":
        units = ["deg", "um", "um", "nm", "uN", "m", "uN", "m/rad", "nJ", "MPa"]
        assert lines[first - 1].split() == units
        assert all(len(cell.replace(".", "").strip("-0")) >= 5 for cell in rows[-1][1:-1])


def test_units_say_what_is_printed():
    """The number in the heading's unit is the quantity; columns that belong together share a prefix."""
    torque, energy = quantity("N m", torque=[0.0, -1.5e-5, 2.5e-3], energy=[1e-3, 2e-3, 3e-3])
    assert (torque.unit, energy.unit) == ("mN m", "mN m")
    assert torque.cells == ("0.000000", "-0.015000", "2.500000")
    (stress,) = quantity("Pa", highest=6, digits=6, stress=[14806.12e6, 1e3])
    assert (stress.unit, stress.cells) == ("MPa", ("14806.1", "0.0"))
    (large,) = quantity("N m", torque=[18219.25])
    assert (large.unit, large.cells) == ("N m", ("18219.25",))
    assert angle([math.pi / 2, -1e-17]).cells == ("90.000", "0.000")


def test_noise_is_zero():
    """What is below the floor of the design is zero in all digits, and NaN a dash."""
    (energy,) = quantity("J", floor=1e-20, energy=[1.6e-29, -3e-25])
    assert (energy.unit, energy.cells) == ("J", ("0.0", "0.0"))
    assert (fixed(-1e-9, 4), fixed(math.nan, 4), significant(-0.0)) == ("0.0000", "-", "0")


def test_columns_are_flush_and_groups_stand_over_theirs():
    """Headings, units and rows end at the same places, and a group's name over the last of its columns."""
    places = [*quantity("m", group="crank", x=[1.0, 2.0], y=[0.5, -12.0]), angle([0.1, 0.2], group="crank")]
    lines = list(table([plain("load", ["0.5", "1.0"]), *places]))
    assert len({len(line) for line in lines}) == 1
    assert lines[0].endswith("| " + " " * (len(lines[0]) - lines[0].index("|") - 7) + "crank")
    assert all(line[lines[0].index("|")] == "|" for line in lines)


def test_a_mechanism_at_rest_prints_no_noise(command):
    """The energy of a guide that nothing loads is zero in the table, in every state."""
    from studies.cases.problem import FOLDER

    guide = FOLDER / "parallel_strip_guide.toml"
    out = command("solve", guide, "--model", "fe", "--effects=bending,stretching", "--increments", 2).out
    rows = [line.replace("|", " ").split() for line in out.splitlines()[5:8]]
    assert {row[1] for row in rows} == {"0.0"}


ROWS = pd.DataFrame(
    {
        "model": ["one", "one", "one", "other", "other"],
        "count": [3, 1, 2, 1, 2],
        "error": [1e-3, -1e-1, 0.0, 1e-2, np.nan],
    }
)
LOOKS = {
    "one": Look(label="one", colour=BLUE),
    "other": Look(label="other", colour=RED, marker="o", hollow=True),
    "absent": Look(label="absent", colour=RED),
}
COUNT, ERROR = Axis("count", "count", each=True), Axis("error", "error [1]", log=True)
CURVES = Curves(ROWS, LOOKS, by="model")


def test_curves_are_sizes_in_order_over_a_logarithmic_axis():
    """Points are joined in the order of x, errors lose their sign, and one that is nought is not drawn."""
    panel = sheet(3.0, 2.0, [[Panel(COUNT, ERROR, (CURVES,))]]).axes[0]
    one, other = panel.lines  # of what has no row, nothing is drawn
    np.testing.assert_array_equal(one.get_xdata(), [1, 2, 3])
    np.testing.assert_array_equal(one.get_ydata(), [1e-1, np.nan, 1e-3])
    assert (one.get_color(), other.get_markerfacecolor()) == (BLUE, "none")
    assert (panel.get_yscale(), list(panel.get_xticks())) == ("log", [1, 2, 3])


@pytest.mark.parametrize(("axis", "drawn"), [
    (replace(ERROR, factor=10.0), [1.0, np.nan, 1e-2]),
    (Axis("error", "", factor=100.0), [-10.0, 0.0, 0.1]),
])  # fmt: skip
def test_axis_scales_and_floors(axis, drawn):
    """An axis has its own unit, and a floor where it is logarithmic."""
    rows = ROWS[ROWS["model"] == "one"].sort_values("count")
    np.testing.assert_allclose(axis.of(rows), drawn)


def test_names_run_from_the_top():
    """What has names in place of numbers stands beside them, the first on top."""
    names = Axis("model", "", names=("other", "one"))
    panel = sheet(3.0, 2.0, [[Panel(ERROR, names, (Curves(ROWS, LOOKS["one"]),))]]).axes[0]
    assert [each.get_text() for each in panel.get_yticklabels()] == ["other", "one"]
    assert set(panel.lines[0].get_ydata()) == {0, 1}
    bottom, top = panel.get_ylim()
    assert bottom > top


def test_sheet_shares_equal_axes_and_names_everything_once():
    """Panels with the same axis share it; its name and every curve's stand once on the page."""
    panel, other = Panel(COUNT, ERROR, (CURVES, Level(1e-2))), replace(ERROR, label="other")
    rows = [[replace(panel), replace(panel)], [replace(panel, y=other) for _ in range(2)]]
    page = sheet(4.0, 4.0, rows, columns=("a", "b"), legend=2)
    assert [each.get_xlabel() for each in page.axes] == ["", "", "count", "count"]
    assert [each.get_ylabel() for each in page.axes] == ["error [1]", "", "other", ""]
    assert [each.get_title(loc="left") or each.get_title() for each in page.axes] == ["a", "b", "", ""]
    assert [each.get_text() for each in page.legends[0].get_texts()] == ["one", "other"]
    assert page.axes[0].get_shared_y_axes().joined(*page.axes[:2])
    assert not page.axes[0].get_shared_y_axes().joined(page.axes[0], page.axes[2])


def test_heat_map_has_exponents_and_crosses():
    """A square has the decimal exponent of its value, or a cross; a panel in two places fills both."""
    rows = pd.DataFrame({"x": [1, 2, 2], "y": [1, 1, 2], "error": [1e-3, np.nan, 1e-7]})
    heat = Panel(Axis("x", "x"), Axis("y", "y"), (HeatMap(rows=rows, column="error", limits=(1e-9, 1.0)),))
    curves = Panel(COUNT, ERROR, (CURVES,))
    page = sheet(4.0, 3.0, [[heat, heat], [curves, replace(curves)]], heights=(1, 2), colours="error")
    assert [each.get_text() for each in page.axes[0].texts] == ["-3", "x", "-7"]
    assert [each.get_ylabel() for each in page.axes] == ["y", "error [1]", "error [1]", "error"]
