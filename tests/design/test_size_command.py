"""The command that sizes a pivot: its answer, its refusals, and what it says where nothing fits."""

import json

import pytest

from studies.__main__ import main
from studies.cases.problem import FOLDER
from tests.exchange.test_data_page import described

CASE = str(FOLDER / "cross_axis_pivot.toml")
QUICK = ("--objective", "centre-shift", "--rotation-deg", "45", "--aspect", "0.5", "--starts", "1")


@pytest.mark.slow
def test_answer(capsys):
    """The table compares case, optimum and finite elements and lists the starts."""
    assert main(["size", CASE, *QUICK]) == 0
    out = capsys.readouterr().out
    assert "times less than the case's" in out
    assert "in FE" in out and "held back by, with prices: " in out
    assert "no design" not in out


def test_json(tmp_path):
    """The JSON holds the optimum with both models' answers, the bounds and every start."""
    path = tmp_path / "sized.json"
    assert main(["size", CASE, *QUICK, "--json", str(path)]) == 0
    found = json.loads(path.read_text())
    optimum, case = found["optimum"], found["case"]
    assert optimum["spline"]["largest_centre_shift_m"] < 0.5 * case["largest_centre_shift_m"]
    stiffness = optimum["spline"]["stiffness_Nm_per_rad"]
    assert stiffness == pytest.approx(case["stiffness_Nm_per_rad"], rel=1e-6)
    assert optimum["finite_elements"]["max_stress_Pa"] <= 1.01 * found["allowable_stress_Pa"]
    assert len(found["starts"]) == 1 and found["starts"][0]["optimum"] == 1
    active = [key for each in optimum["active"] for key in each]
    assert set(described("## JSON of `size`")) == {
        *found, *case, *optimum, *found["starts"][0], *active, *optimum["spline"], *optimum["finite_elements"]
    }  # fmt: skip


@pytest.mark.slow
def test_no_design_meets_the_constraints(capsys):
    """A stress that nothing meets ends with code 3, the starts, and how far they missed."""
    assert main(["size", CASE, *QUICK, "--max-stress-MPa", "1"]) == 3
    out, err = capsys.readouterr()
    assert "no optimum from 1 starts: no design here meets the constraints (worst by" in err
    assert "times less" not in out


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ([CASE], "size: the following arguments are required: --objective"),
        ([CASE, "--objective", "shift"], "argument --objective: invalid choice: 'shift'"),
        ([CASE, *QUICK, "--width-mm", "20:5"], "--width-mm: got 20:5, expected LOW:HIGH with 0 < LOW < HIGH"),
        ([CASE, *QUICK, "--crossing-ratio", "0.5:1.5"], "expected LOW:HIGH with 0 < LOW < HIGH < 1"),
        ([CASE, *QUICK, "--inclination-deg", "10"], "--inclination-deg: got 10, expected LOW:HIGH"),
        ([CASE, *QUICK, "--rotation-deg", "0"], "drive.rotation_deg: got 0, expected a range to size for"),
        ([CASE, *QUICK, "--rotation-deg", "400"], "--rotation-deg: got 400.0, expected a number from -360"),
        (
            [CASE, *QUICK, "--max-stress-MPa", "-1"],
            "--max-stress-MPa: got -1, expected a finite number above 0",
        ),
        (["nowhere.toml", *QUICK], "nowhere.toml: cannot be read"),
        ([CASE, *QUICK, "--json", "/nowhere/x.json"], "/nowhere/x.json: cannot be written"),
    ],
)
def test_bad_input_in_one_line(arguments, message, capsys):
    """Every bad input ends with code 2 and one line."""
    assert main(["size", *arguments]) == 2
    err = capsys.readouterr().err
    assert message in err and err.count("\n") == 1


@pytest.mark.parametrize(
    ("addition", "message"),
    [
        ("[strip]", "strip.section_depth_m: got 0.005, expected none"),
    ],
)
def test_cases_that_cannot_be_sized(addition, message, tmp_path, capsys):
    """Loads, and sections that are not rectangles, are refused in one line."""
    text = (FOLDER / "cross_axis_pivot.toml").read_text()
    path = tmp_path / "case.toml"
    if addition == "[strip]":
        path.write_text(text.replace("[strip]", "[strip]\nsection_depth_m = 0.005"))
    else:
        path.write_text(text + "\n" + addition + "\n")
    assert main(["size", str(path), *QUICK]) == 2
    err = capsys.readouterr().err
    assert message in err and err.count("\n") == 1
