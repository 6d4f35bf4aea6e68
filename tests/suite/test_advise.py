"""The adviser: the cheapest setting of every model that meets an error."""

import json
import math

import pandas as pd
import pytest

from studies.cases.problem import FOLDER
from studies.cost import tried
from studies.cost.tried import cheapest, kept

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
