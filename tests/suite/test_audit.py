"""`audit`: what effects are worth, and a cheapest scene that is right and solves less; `advise`: which model.

What a scene costs is counted here, not timed: an audit is told Newton iterations in place of seconds.
"""

import dataclasses
import json
import math

import pandas as pd
import pytest

from studies.answers.settings import SplineSettings
from studies.cases.design import named_design
from studies.cases.problem import FOLDER
from studies.cost import tried
from studies.cost.tried import cheapest, kept
from studies.effects import audit as module
from studies.effects import scenes
from studies.effects.audit import prices
from tests.suite.refused import FINDS

TOLERANCE = 1e-3


@pytest.fixture
def brief(monkeypatch):
    """Audits of a part of a swing, timed once."""
    monkeypatch.setattr(scenes, "SWINGS", 0.2)
    monkeypatch.setattr(module, "ROUNDS", 1)


@pytest.mark.slow
@pytest.mark.usefixtures("brief")
def test_audit_of_a_mechanism_without_a_drive(command):
    """A guide that follows its load has no torque and no swing, and is judged by path and first mode."""
    case = FOLDER / "parallel_strip_guide.toml"
    found = json.loads(command("audit", case, "--effects=-strip_inertia", "--json", "-").out)
    rows = {row["dropped"][0]: row for row in found["rows"]}
    assert rows["applied_force"]["trajectory"] == pytest.approx(1.0, rel=0.05)
    assert rows["gravity"]["trajectory"] > 1e-2
    assert all(row["torque"] is None and row["swing_frequency"] is None for row in found["rows"])
    assert "applied_force" in found["cheapest"]["effects"]
    for name in ("cantilever_with_body", "polymer_pivot"):  # which have no golden, as they hang on round-off
        assert "cheape" in command("audit", FOLDER / f"{name}.toml").out


@pytest.mark.slow
@pytest.mark.usefixtures("brief")
def test_audit_of_what_rests(command):
    """A mechanism that rests under its loads, so that nothing moves after its release, is audited by path."""
    case = FINDS / "clamped_mechanism.toml"
    found = json.loads(command("audit", case, "--json", "-").out)
    assert found["rows"] and found["cheapest"]["effects"]


def test_audit_of_what_is_not_stable(command, tmp_path):
    """A design that does not stand at rest is exit code 3, and says why."""
    text = (FOLDER / "parallel_strip_guide.toml").read_text(encoding="utf-8")
    path = tmp_path / "heavy.toml"
    path.write_text(text.replace("mass_kg = 0.1", "mass_kg = 10"), encoding="utf-8")
    result = command("audit", path)
    assert (result.code, result.out) == (3, "")
    assert result.err.startswith(
        "studies: not converged: the full scene: the first natural frequency at rest is -"
    )


@pytest.mark.usefixtures("brief")
def test_weight_that_makes_a_design_unstable_is_a_finding(monkeypatch):
    """The polymer pivot, which its weight would tip over, is audited without it, and a row says why."""
    monkeypatch.setattr(scenes, "SWINGS", 0.05)
    found = module.audit(named_design("polymer_pivot"), SplineSettings(control_points=6), 1e-3)
    assert "gravity" not in found.full.effects.names
    row = found.rows[-1]
    assert (row.label, row.status) == ("with gravity", "unstable")
    assert row.reason == "the first natural frequency at rest is -1.017 Hz"
    assert row.largest == math.inf


def test_what_planar_beams_leave_out_is_priced():
    """Table 1's wide clamps, flat sections, roots and shear change its answers by what theory says."""
    found = {row["effect"]: row for row in prices(named_design("cross_axis_pivot"))}
    assert list(found) == ["clamped_width", "anticlastic", "root_compliance", "all three", "shear"]
    root = 2.0 * 0.416 * 0.005 / (0.06 * math.sqrt(2.0))
    assert found["root_compliance"]["stiffness"] == pytest.approx(1.0 / (1.0 + root) - 1.0, rel=2e-3)
    assert found["clamped_width"]["stiffness"] == pytest.approx(0.0082, abs=1e-4)
    assert found["anticlastic"]["stiffness"] == pytest.approx(0.0, abs=1e-8)
    assert found["shear"]["torque"] == pytest.approx(-0.0024, abs=1e-5)
    assert all(
        row["first_mode"] == pytest.approx(0.5 * row["stiffness"], rel=0.1, abs=3e-5)
        for row in found.values()
    )


def test_what_has_no_price_says_why():
    """Inextensible strips are unknown to the elements: the row of shear has a reason, the others have
    prices."""
    design = named_design("cross_axis_pivot")
    rigid = dataclasses.replace(
        design, effects=design.effects.renamed(["bending", "inextensible", "body_inertia"])
    )
    rows = {row["effect"]: row for row in prices(rigid)}
    assert (rows["shear"]["status"], rows["anticlastic"]["status"]) == ("refused", "converged")
    assert "got 'inextensible'" in rows["shear"]["reason"]
    assert math.isnan(rows["shear"]["largest"])


CASE = str(FOLDER / "cross_axis_pivot.toml")


def rows(errors):
    """A table of one group a list, each with its errors from coarse to fine, the finer ones slower."""
    table = [
        {"group": name, "family": "", "fineness": float(k), "setting": f"{name}{k}", "status": "converged"}
        | {"torque": error, "whole_s": 2.0**k}
        for name, values in zip("ab", errors, strict=True)
        for k, error in enumerate(values)
    ]
    return pd.DataFrame(table)


def test_an_error_by_luck_does_not_count():
    """A coarse setting that is better than the finer ones has the error that these keep; one that is coarser
    than a failure has none."""
    table = rows([[1e-5, 1e-2, 1e-3], [1e-2, math.nan, 1e-4]])
    assert kept(table, ["torque"]).tolist() == [1e-2, 1e-2, 1e-3, math.inf, math.inf, 1e-4]
    assert cheapest(table, ["torque"], 2e-3)["setting"].tolist() == ["a2", "b2"]
    assert cheapest(table, ["torque"], 1e-6)["meets"].tolist() == [False, False]


@pytest.fixture
def few(monkeypatch):
    """Models that are quick to try: few settings of spline and elements, and closed forms."""
    models = ("spline", "finite elements", "linear pivot", "pin joint", "four-bar")
    chosen = [
        each
        for each in tried.paths()
        if each.model.name in models and each.theory == "material" and each.columns["fineness"] <= 40.0
    ]
    monkeypatch.setattr(tried, "paths", lambda: chosen)


@pytest.mark.usefixtures("few")
def test_static_advice_as_json(command):
    """The command advises on Table 1: spline and elements meet 1e-2, by whole calls; no surrogate does."""
    document = json.loads(command("advise", CASE, "--accuracy", "1e-2", "--json", "-").out)
    found = {row["model"]: row for row in document["models"]}
    assert set(found) == {tried.SPLINE, tried.ITSELF, tried.ELEMENTS, tried.SURROGATE}
    for name in (tried.SPLINE, tried.ITSELF, tried.ELEMENTS):
        row = found[name]
        assert row["meets"]
        assert 0.0 < row["error_torque"] <= 1e-2
        assert 0.0 < row["solve_s"] < row["whole_s"]
        assert row["reference_uncertainty"] < 1e-4
        assert 0.0 < row["error_stress"] < 0.03
        assert row["reference_uncertainty_stress"] < 1e-4
    assert not found[tried.SURROGATE]["meets"]
    assert found[tried.SURROGATE]["error_stress"] is None


@pytest.mark.usefixtures("few")
def test_no_model_meets_an_impossible_error(case, command):
    """Where no model meets the error the exit code is 1, the best of each is printed, and that verdicts are
    not certain where a reference is too coarse for them."""
    path = case(("increments = 20", "increments = 4"))
    outcome = command("advise", path, "--accuracy", "1e-13")
    assert outcome.code == 3
    assert "no model meets 1e-13 here" in outcome.err
    *lines, last = outcome.out.splitlines()
    assert len([line for line in lines if line.endswith("does not meet it: its best")]) == 4
    assert last.endswith("not certain")
