"""Pictures of answers show what was solved, at the width of a page, with nothing clipped."""

import json
from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest
from matplotlib.text import Text

import fe_reference
import spline_model
import studies
from studies.__main__ import main
from studies.answers.adapters import answer_modes, answer_of, answer_release, answer_static
from studies.answers.settings import FeSettings, SplineSettings
from studies.cases.design import named_design
from studies.errors import BadInput
from studies.pictures.page import picture
from studies.pictures.shown import Shown
from studies.record import style
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


@pytest.mark.parametrize(("kind", "begin"), [("svg", b"<?xml"), ("pdf", b"%PDF"), ("png", b"\x89PNG")])
def test_command_writes_a_picture_beside_its_answer(kind, begin, tmp_path, capsys):
    """--plot writes a file of its ending and prints its name on the stream without JSON."""
    path = tmp_path / f"drawn.{kind}"
    words = ["solve", PIVOT, "--model", "fe", "--elements", "4", "--increments", "2"]
    assert main([*words, "--plot", str(path), "--json", "-"]) == 0
    assert path.read_bytes().startswith(begin)
    said = capsys.readouterr()
    assert json.loads(said.out)["status"] == "converged"
    assert f"{path}: the picture" in said.err
