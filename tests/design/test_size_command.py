"""The command that sizes a pivot: its answer, its refusals, and what it says where nothing fits."""

import json
from pathlib import Path

import pytest

from studies.__main__ import main
from studies.cases.design import document_of
from studies.cases.problem import named_case
from studies.design.question import Question
from tests.exchange.test_files import described

FINDS = Path(__file__).parent.parent / "suite" / "finds"
CASE = "cross_axis_pivot"
QUICK = ("--objective", "centre-shift", "--rotation-deg", "45", "--aspect", "0.5", "--starts", "1")


def test_answer(tmp_path, capsys):
    """The table compares case, optimum and finite elements and lists the starts; the JSON holds the optimum
    with both models' answers, the bounds and every start."""
    path = tmp_path / "sized.json"
    assert main(["size", CASE, *QUICK, "--json", str(path)]) == 0
    out = capsys.readouterr().out
    assert "times less than the case's" in out and "no design" not in out
    assert "in FE" in out and "held back by, with prices: " in out
    found = json.loads(path.read_text())
    optimum, case = found["optimum"], found["case"]
    assert optimum["spline"]["largest_centre_shift_m"] < 0.5 * case["largest_centre_shift_m"]
    stiffness = optimum["spline"]["stiffness_Nm_per_rad"]
    assert stiffness == pytest.approx(case["stiffness_Nm_per_rad"], rel=1e-6)
    assert optimum["finite_elements"]["max_stress_Pa"] <= 1.01 * found["allowable_stress_Pa"]
    assert len(found["starts"]) == 1 and found["starts"][0]["optimum"] == 1
    active = [key for each in optimum["active"] for key in each]
    assert set(described("## JSON of `size`")) - {"travel_m"} == {
        *found, *case, *optimum, *found["starts"][0], *active, *optimum["spline"], *optimum["finite_elements"]
    }  # fmt: skip


@pytest.mark.slow
def test_no_design_meets_the_constraints(capsys):
    """A stress that nothing meets ends with code 3, the starts, and how far they missed."""
    assert main(["size", CASE, *QUICK, "--max-stress-MPa", "1"]) == 3
    out, err = capsys.readouterr()
    assert "no optimum from 1 starts; nearest, start 0: no design here meets the constraints: " in err
    assert "expected the wanted 505.5 N m/rad" in err and "expected at most 1 MPa" in err
    assert "times less" not in out


def test_a_case_without_an_answer_says_why(capsys):
    """A case that tips over under its weight before the body turns ends with code 3 and one line."""
    assert main(["size", str(FINDS / "heavy_pivot.toml"), *QUICK[:2]]) == 3
    told = capsys.readouterr().err
    assert "the case itself has no answer over the range: limit point at 44.9" in told
    assert told.count("\n") == 1


@pytest.mark.slow
def test_optimum_as_a_case_file_with_what_is_held(tmp_path, capsys):
    """Under a load the optimum is written as a case, with dimensions held, stiffness and stress as asked."""
    path = tmp_path / "best.toml"
    given = ("--objective", "centre-shift", "--starts", "6", "--out", str(path))
    held = ("--free=strip.length_m=0.3", "--free=strip.inclination_deg=45", "--free=strip.width_m=0.05")
    held += ("--max-stress-MPa", str(0.5e-6 * named_case("large_steel_pivot").yield_strength))
    assert main(["size", "large_steel_pivot", *given, *held]) == 0
    out, err = capsys.readouterr()
    assert (
        "under applied_force" in out
        and "held as asked: strip.length_m, strip.inclination_deg, strip.width_m" in out
    )
    assert f"{path}: the optimum as a case file" in err
    case, best = named_case("large_steel_pivot"), named_case(path)
    assert (best.length, best.width) == (pytest.approx(0.3), pytest.approx(0.05))
    assert best.effects == case.effects
    sized, own = (
        Question.of("case", document_of(each), objective="centre-shift").answers().quantities
        for each in (best, case)
    )
    assert sized["centre-shift"] < 0.5 * own["centre-shift"]
    assert sized["stiffness"] == pytest.approx(own["stiffness"], rel=2e-6)
    assert sized["stress"] <= 0.5 * best.yield_strength * (1.0 + 1e-6)
