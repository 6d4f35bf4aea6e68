"""Critical loads by the command, one verdict in table, JSON and exit code; and what is not resolved."""

import json
from pathlib import Path

import pytest

from studies.__main__ import main
from studies.answers.adapters import answer_static
from studies.answers.settings import FeSettings, SplineSettings
from studies.cases.design import read_design

FINDS = Path(__file__).parent / "finds"
#: Right value: shooting on a stretchable Kirchhoff rod [N].
SHALLOW_ARCH = 6.281928


def asked(capsys, name, *words):
    """Return exit code, JSON and error stream of the command."""
    code = main(["critical-load", str(FINDS / f"{name}.toml"), "--json", "-", *words])
    out, err = capsys.readouterr()
    return code, json.loads(out), err


def test_a_limit_point_is_a_critical_load(capsys):
    """Requirement: the snap-through of a shallow arch is a critical load, exit 0, in both models."""
    code, found, err = asked(capsys, "shallow_arch", "--model", "spline,fe")
    assert (code, err) == (0, "")
    for answer in found["answers"]:
        assert (answer["kind"], answer["status"]) == ("limit point", "converged")
        assert answer["critical_load_N"] == pytest.approx(SHALLOW_ARCH, rel=1e-6)
        assert answer["relative_error"] < 1e-5


@pytest.mark.parametrize(("name", "share"), [("heavy_payload", 0.4521), ("heavy_pivot", 0.4490)])
def test_stability_at_zero_force_is_checked_first(name, share, capsys):
    """Requirement: a design that its own weight tips over bears no force, with the share of the weight."""
    code, found, err = asked(capsys, name, "--model", "spline,fe")
    assert (code, err) == (0, "")
    for answer in found["answers"]:
        assert (answer["kind"], answer["critical_load_N"]) == ("unstable at zero force", 0.0)
        assert answer["weight_share"] == pytest.approx(share, rel=1e-3)


def test_the_former_name_prints_the_new_one(capsys):
    """Requirement: `capacity` still works and prints the new name on the error stream."""
    assert main(["capacity", str(FINDS / "heavy_pivot.toml")]) == 0
    assert capsys.readouterr().err == "studies: capacity is now called critical-load\n"


@pytest.mark.parametrize("name", ["soft_column_pivot", "rolled_up_twice"])
def test_too_few_control_points_are_not_physics(name):
    """Requirement: a path that stops for lack of control points is not resolved, buckles nowhere, is cut."""
    answer = answer_static(read_design(FINDS / f"{name}.toml"), SplineSettings(control_points=8))
    assert answer.status == "not_converged"
    assert answer.message.startswith("not resolved with 8 control points")
    assert "buckles" not in answer.message
    assert "bspline with 35 control points" in answer.message
    assert answer.critical_points == ()


def test_more_points_are_tried_by_itself():
    """Requirement: without a number a strip that Bezier points do not resolve is rolled up twice."""
    answer = answer_static(read_design(FINDS / "rolled_up_twice.toml"), SplineSettings())
    assert answer.converged
    assert answer.rotation[-1] == pytest.approx(12.566370614359172, rel=1e-3)


def test_few_elements_are_not_physics():
    """Requirement: a limit point that a mesh of twice the elements has elsewhere is not resolved."""
    answer = answer_static(read_design(FINDS / "shallow_arch.toml"), FeSettings(elements=4))
    assert answer.message.startswith("not resolved with 4 elements")
    assert answer.critical_points == ()
