"""Whatever command answers, it takes the control points that the accuracy needs, and says what it knows."""

import json
import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from studies.answers.adapters import answer_modes, answer_static
from studies.answers.settings import FeSettings, SplineSettings
from studies.answers.strength import strength
from studies.cases.design import read_design
from studies.cases.document import parsed
from studies.cases.problem import named_case
from studies.sweep.plan import plan_of
from studies.sweep.points import solve_chunk
from tests.suite.refused import FINDS

CLAMPED = FINDS / "clamped_mechanism.toml"
#: A pivot on which six control points are 0.5 to 0.9 % off, within what the page's sliders may set.
STEEP = {"crossing_ratio": 0.8, "inclination": math.radians(65.0)}
ACCURACY = 1e-4


def steep(**changes):
    """The steep pivot, to 75 degrees in six increments."""
    return replace(
        named_case("spring_steel_pivot"), **STEEP, rotation=math.radians(75.0), increments=6, **changes
    )


def test_what_is_not_estimated_is_named(command):
    """Requirement: with given control points or elements the errors are called not estimated, and with an
    accuracy of the elements that of the stiffness of the body alone."""
    short = ("--rotation-deg", 10, "--increments", 2)
    for more in (("--control-points", 6), ("--model", "fe")):
        lines = command("solve", "cross_axis_pivot", *short, *more).out.splitlines()
        assert "errors not estimated: --accuracy estimates them" in lines
        none = json.loads(command("solve", "cross_axis_pivot", *short, *more, "--json", "-").out)
        assert {"places", "torque", "stiffness", "energy", "stress"} < set(none["not_estimated"])
        modes = json.loads(command("modes", "cross_axis_pivot", *more, "--json", "-").out)
        assert modes["not_estimated"] == ["frequency"]
    accurate = ("--model", "fe", "--elements", 5, "--accuracy", 1e-3)
    lines = command("solve", "cross_axis_pivot", *short, *accurate).out.splitlines()
    assert "error not estimated: stiffness of the body" in lines
    compared = command("compare", "cross_axis_pivot", "titanium_pivot", *short, *accurate).out
    assert "; not estimated: frequency" in compared and "stiffness of the body" not in compared


def test_designs_without_inertia_are_compared(command):
    """Requirement: what has no inertia has no frequency; all else is compared, with what paths pass."""
    found = command("compare", FINDS / "soft_column_pivot.toml", FINDS / "mirror_pivot.toml", "--model", "fe")
    assert found.code == 0
    assert re.search(r"first frequency +Hz +- +-3\.", found.out)
    assert "errors not estimated; limit point: the body's own stiffness vanishes" in found.out


@pytest.mark.parametrize("settings", [SplineSettings(), FeSettings(elements=10)], ids=lambda s: s.model)
@pytest.mark.parametrize("increments", [1, 2, 4])
def test_yield_is_where_the_stress_is_that_of_yield(settings, increments):
    """Requirement: a path that ends at the angle of yield has the yield strength as its largest stress,
    however few increments the angle was found with."""
    design = steep(yield_strength=8e8)
    found = strength(answer_static(replace(design, increments=increments), settings)).yields
    there = answer_static(replace(design, rotation=found.rotation), settings)
    assert there.max_stress[-1] == pytest.approx(8e8, rel=1e-5)
    assert found.load_factor == pytest.approx(found.rotation / design.rotation, rel=1e-9)


def test_yield_under_loads_alone_is_solved_for():
    """Requirement: the load factor at which a mechanism without a drive yields is that of any increments."""
    design = read_design(CLAMPED)
    strips = tuple(replace(strip, yield_strength=3e6) for strip in design.strips)
    found = [
        strength(answer_static(replace(design, strips=strips, increments=count), SplineSettings())).yields
        for count in (2, 5)
    ]
    assert found[0].load_factor == pytest.approx(found[1].load_factor, rel=1e-5)
    assert found[0].error < ACCURACY


def right():
    """The steep pivot with many more control points."""
    return answer_static(steep(), SplineSettings(control_points=18))


def apart(found, good):
    """Largest relative difference of numbers by name."""
    return max(abs(found[name] / value - 1.0) for name, value in good.items())


def numbers(answer):
    """What every command prints of a path."""
    shift = np.hypot(*answer.centre_shift.T)
    return {
        "torque_Nm": answer.torque[-1],
        "stiffness_end_Nm_per_rad": answer.stiffness[-1],
        "stress_max_Pa": answer.max_stress.max(),
        "centre_shift_max_m": shift.max(),
    }


@pytest.fixture(name="pivot")
def written(tmp_path):
    """The steep pivot as a case file."""
    from studies.cases.design import as_toml, document_of

    path = tmp_path / "steep.toml"
    path.write_text(as_toml(document_of(steep()), ["A steep pivot."]))
    return path


def test_every_command_answers_one_design_to_the_accuracy(pivot, command, tmp_path):
    """Requirement: solve, compare, a sweep and export have the same design within
    1e-4 of the answer with many more control points; modes as well."""
    good = numbers(right())
    solved = json.loads(command("solve", pivot, "--json", "-").out)
    shift = np.hypot(solved["centre_shift_x_m"], solved["centre_shift_y_m"]).max()
    ends = (solved["torque_Nm"][-1], solved["stiffness_Nm_per_rad"][-1], max(solved["max_stress_Pa"]), shift)
    assert apart(dict(zip(good, ends, strict=True)), good) < ACCURACY
    compared = json.loads(command("compare", pivot, "titanium_pivot", "--json", "-").out)["designs"][0]
    keys = ("torque_Nm", "stiffness_end_Nm_per_rad", "max_stress_Pa", "largest_centre_shift_m")
    assert apart(dict(zip(good, (compared[key] for key in keys), strict=True)), good) < ACCURACY
    assert compared["estimate"]["torque"] <= ACCURACY
    row = row_of(case=str(pivot), vary={"strip": {"crossing_ratio": [STEEP["crossing_ratio"]]}})
    assert apart(row, good) < ACCURACY
    assert row["estimated_error"] <= ACCURACY and row["reason"] == ""
    outcome = command("solve", pivot, "--export", tmp_path / "out")
    assert "estimated error: trajectory" in outcome.out
    (exported,) = (tmp_path / "out").glob("static_states.csv")
    assert f"{good['torque_Nm']:.4g}"[:4] in exported.read_text()
    first, fine = (
        answer_modes(steep(), s, count=2) for s in (SplineSettings(), SplineSettings(control_points=16))
    )
    assert first.frequency == pytest.approx(fine.frequency, rel=ACCURACY)


def test_the_page_answers_one_design_to_the_accuracy(pivot):
    """Requirement: the page has moment, stiffness, stress and shift of the same design within 1e-4."""
    good, made = right(), page(pivot)
    for degrees in range(0, 76, 15):
        turn = {"do": "pose", "pose": [0.0, 0.0, math.radians(degrees)], "t": 0.04 * degrees}
        state = made.feed(turn)
    shown = {
        "torque_Nm": state["force"][2],
        "stiffness_end_Nm_per_rad": state["stiffness"],
        "stress_max_Pa": state["stress"]["max"],
        "centre_shift_max_m": state["centre_shift"],
    }
    assert apart(shown, numbers(good)) < ACCURACY
    assert state["warnings"] == []


def page(pivot):
    """A session with a design of one's own, whose hand holds the rotation alone."""
    from studies.interactive import presets
    from studies.interactive.session import Session

    made = Session("polymer")
    made.feed({"do": "preset", "name": presets.OWN, "case": parsed(pivot), "t": 0.0})
    made.feed({"do": "drive", "by": "rotation", "t": 0.0})
    return made


@pytest.fixture(name="few")
def no_more_than_eight(monkeypatch):
    """The search ends at eight control points, and asks for more than they can."""
    import spline_model.accuracy as chosen

    monkeypatch.setattr(chosen, "MOST", 8)
    monkeypatch.setattr(chosen, "MOST_SEGMENTS", 1)
    monkeypatch.setattr(chosen, "DEFAULT", 1e-7)


def test_the_page_says_that_the_accuracy_is_missed(pivot, few):
    """Requirement: where no number of control points reaches the accuracy, each state of the page has a
    warning."""
    state = page(pivot).feed({"do": "pose", "pose": [0.0, 0.0, 0.1], "t": 1.0})
    (told,) = state["warnings"]
    assert told["code"] == "coarse" and "above 1e-07 with 8 control points" in told["text"]
    assert state["control_points"] == 8


def row_of(**content):
    """The row of a sweep's file with one design."""
    given = {"case": "cross_axis_pivot", "vary": {"strip": {"crossing_ratio": [0.9]}}, **content}
    plan = plan_of("s.toml", given, Path())
    return solve_chunk(plan.task, 0, plan.rows(0, 1)).to_pylist()[0]


@pytest.mark.parametrize("content", [{"model": "fe"}, {"settings": {"control_points": 8}}], ids=str)
def test_a_row_that_nothing_estimates_says_so(content):
    """Requirement: a row of elements, or of a given number of control points, has no error but a reason."""
    row = row_of(**content)
    assert (row["status"], row["estimated_error"], row["reason"]) == (
        "converged",
        None,
        "error not estimated",
    )
