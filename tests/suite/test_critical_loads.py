"""Critical loads, one verdict in table, JSON and exit code; what is not resolved, and where a path ends."""

import json
import math
import re

import pytest

from studies.answers.adapters import answer_static
from studies.answers.settings import FeSettings, SplineSettings
from studies.cases.design import as_toml, read_design
from tests.goldens.answers import document_of
from tests.suite.refused import FINDS

#: Right value: shooting on a stretchable Kirchhoff rod [N].
SHALLOW_ARCH = 6.281928
MODELS = ("spline", "fe")


@pytest.mark.parametrize("held", [[], ["--held"]])
def test_a_limit_point_is_a_critical_load(held, answered):
    """Requirement: the snap-through of a shallow arch is a critical load, exit 0, in both models, also where
    the crown's rotation is held, which it does not use."""
    for model in MODELS:
        answer = answered("critical-load", FINDS / "shallow_arch.toml", "--model", model, *held)
        assert (answer["kind"], answer["status"]) == ("limit point", "converged")
        assert answer["critical_load_N"] == pytest.approx(SHALLOW_ARCH, rel=1e-6)
        assert answer["relative_error"] < 1e-5


@pytest.mark.parametrize(("name", "share"), [("heavy_payload", 0.4521), ("heavy_pivot", 0.4490)])
def test_stability_at_zero_force_is_checked_first(name, share, answered):
    """Requirement: a design that its own weight tips over bears no force, with the share of the weight; its
    path has the same message, although the body has not turned yet."""
    for model in MODELS:
        words = [FINDS / f"{name}.toml", "--model", model]
        answer = answered("critical-load", *words)
        assert (answer["kind"], answer["critical_load_N"]) == ("unstable at zero force", 0.0)
        assert answer["weight_share"] == pytest.approx(share, rel=1e-3)
        answer = answered("solve", *words)
        assert "released, it tips over" in answer["message"] and f"{100.0 * share:.3g}" in answer["message"]
        (point,) = answer["critical_points"]
        assert (point["kind"], point["load_factor"], point["rotation_rad"]) == ("limit point", 0.0, 0.0)


@pytest.mark.parametrize("model", ["spline", "fe"])
@pytest.mark.parametrize("asked", ["solve", "modes"])
def test_weight_that_buckles_the_strips_is_no_bad_input(asked, model, command, tmp_path):
    """An arch that snaps under 43 % of its weight ends every command with exit code 3, in both models."""
    arch = (FINDS / "shallow_arch.toml").read_text().partition("[scene]")[0]
    heavy = tmp_path / "heavy_arch.toml"
    heavy.write_text(arch.replace("mass_kg = 0", "mass_kg = 1.5") + '[scene]\neffects = ["+gravity"]\n')
    outcome = command(asked, heavy, "--model", model)
    assert outcome.code == 3
    assert "limit point" in outcome.err and "of weight" in outcome.err.replace("the weight", "weight")


@pytest.mark.slow
def test_strips_in_a_row_are_loaded_by_what_the_weakest_bears(answered):
    """Requirement: a chain of long strips and one that is 500 times shorter is not loaded by the Euler
    load of the short one: both models have the force at which it turns by 5 degrees."""
    words = ["critical-load", FINDS / "mixed_lengths.toml", "--model"]
    forces = [answered(*words, model)["rotation_5_deg_N"] for model in MODELS]
    assert forces[0] == pytest.approx(forces[1], rel=1e-6)


def test_a_limit_point_that_coarse_meshes_do_not_have(answered):
    """Requirement: meshes of 20 and 40 elements turn past a limit that finer ones have at 4.43734 N; both
    models find it, and the rotation there."""
    words = [FINDS / "late_limit_pivot.toml", "--force-direction-deg", -112.145]
    for model in MODELS:
        answer = answered("critical-load", *words, "--model", model)
        assert answer["kind"] == "limit point"
        assert answer["critical_load_N"] == pytest.approx(4.43734, rel=1e-5)
        assert answer["rotation_rad"] == pytest.approx(-1.592645, rel=1e-3)
        assert answer["rotation_error_rad"] < 2e-3


def test_the_rotation_at_a_critical_load_is_that_of_its_point(answered):
    """Requirement: both models have the rotation at the critical load itself, not at a state nearby."""
    words = ["critical-load", FINDS / "clamped_mechanism.toml", "--model"]
    found = [answered(*words, model) for model in MODELS]
    spline, fe = (answer["rotation_rad"] for answer in found)
    assert spline == pytest.approx(fe, rel=1e-3)
    assert all(0.0 < answer["rotation_error_rad"] < 1e-3 * abs(fe) for answer in found)


@pytest.mark.parametrize("name", ["soft_column_pivot", "rolled_up_twice"])
def test_too_few_control_points_are_not_physics(name):
    """Requirement: a path that stops for lack of control points is not resolved, does not buckle, is cut."""
    answer = answer_static(read_design(FINDS / f"{name}.toml"), SplineSettings(control_points=8))
    assert answer.status == "not_converged"
    assert answer.message.startswith("not resolved with 8 control points")
    assert "buckles" not in answer.message
    assert "take segments = 2" in answer.message
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


@pytest.mark.slow
def test_a_spline_that_stops_says_where_it_buckled(command, tmp_path):
    """Pressed far beyond its critical load, the spline stops with a message: the force, and a model that may
    continue."""
    path = tmp_path / "pressed.toml"
    text = (FINDS / "pressed_pivot.toml").read_text(encoding="utf-8")
    turned = text.replace("rotation_deg = 0", "rotation_deg = 0.01").replace("-20e3", "-1e9")
    path.write_text(turned, encoding="utf-8")
    outcome = command("solve", path)
    assert outcome.code == 3
    assert re.search(r"lost its stability before, first at load factor \S+ \(force \d+ N\)", outcome.err)
    assert "--model fe may go further" in outcome.err


def test_what_a_converged_path_passed_is_told(command, tmp_path):
    """A path that reached its end says what it passed, in the table and in JSON, with the load factor."""
    path, column = tmp_path / "column.toml", document_of("column")
    column["effects"]["applied_force"]["force_N"] = [-4, 0]
    path.write_text(as_toml(column), encoding="utf-8")
    words = ["solve", path, "--model", "spline"]
    answer = json.loads(command(*words, "--json", "-").out)
    outcome = command(*words)
    assert (outcome.code, outcome.err, answer["status"]) == (0, "", "converged")
    assert answer["message"]
    assert answer["message"] in outcome.out
    (point,) = answer["critical_points"]
    euler = (math.pi / 2) ** 2  # one end free, EI and L one
    assert point["kind"] == "bifurcation"
    assert point["force_N"] == pytest.approx(euler, rel=1e-3)
    assert point["rotation_rad"] is None
    assert point["load_factor"] == pytest.approx(euler / 4.0, rel=1e-3)
    assert f"bifurcation: load factor {point['load_factor']:.6g}" in outcome.out


@pytest.mark.slow
def test_a_mesh_that_is_lost_in_round_off_is_told_shortly(command):
    """Requirement: of the dozens of critical points that round-off makes, a message names the first few."""
    words = ("--model", "fe", "--elements", 80, "--accuracy", 1e-5)
    outcome = command("solve", FINDS / "mixed_lengths.toml", *words)
    assert outcome.code == 3
    assert "not resolved with" in outcome.err and " more, stops at" in outcome.err
    assert len(outcome.err) < 600
