"""The adviser: the cheapest setting of every model that meets an error."""

import json
import math

import pandas as pd
import pytest

from studies.baselines.answer import BaselineFailed
from studies.baselines.variant import Baseline, grid
from studies.cases.problem import FOLDER
from studies.work_precision import advice, series
from studies.work_precision.equal_error import coarsest, kept

CASE = str(FOLDER / "cross_axis_pivot.toml")


def rows(errors, *, names="abc", slow=1.0):
    """A table of one series a name, each with its errors from coarse to fine; all but the first are slow."""
    table = [
        {"series": name, "family": "all", "setting": f"{name}{rank}", "rank": rank, "error_x": error}
        | {"solve_s": (1.0 if name == names[0] else slow) * 2.0**rank, "message": ""}
        for name, values in zip(names, errors, strict=False)
        for rank, error in enumerate(values)
    ]
    return pd.DataFrame(table)


def test_an_error_by_luck_does_not_count():
    """A coarse setting that is better than the finer ones has the error that these keep."""
    table = rows([[1e-5, 1e-2, 1e-3], [1e-2, math.nan, 1e-4]])
    assert kept(table, ["error_x"], "rank").tolist() == [1e-2, 1e-2, 1e-3, math.inf, math.inf, 1e-4]
    assert coarsest(table, ["error_x"], "rank", 2e-3)["setting"].tolist() == ["a2", "b2"]


@pytest.fixture
def few(monkeypatch):
    """Models that are quick to try: few settings of spline and elements, and closed forms."""
    wanted = ("linear pivot", "pin joint", "four-bar")
    own = [each for each in series.own_paths(range(4, 7)) if each.series in (series.SPLINE, series.ELEMENTS)]
    others = [each for each in series.other_paths() if each.series in wanted]
    monkeypatch.setattr(series, "own_paths", lambda counts: own)
    monkeypatch.setattr(series, "other_paths", lambda: others)
    return {"spline", series.ITSELF, "finite elements", *wanted}


def test_static_advice_as_json(few, command):
    """The command advises on Table 1: the spline and the elements meet 1e-2, the pin joint does not."""
    document = json.loads(command("advise", CASE, "--accuracy", "1e-2", "--json", "-").out)
    found = {row["model"]: row for row in document["models"]}
    assert set(found) == few
    assert found[series.ITSELF]["error_stress"] < 0.1 * found["spline"]["error_stress"]
    for name in ("spline", series.ITSELF, "finite elements"):
        assert found[name]["meets"]
        assert 0.0 < found[name]["error_torque"] <= 1e-2
        assert found[name]["solve_s"] > 0.0
        assert found[name]["reference_uncertainty"] < 1e-4
        assert 0.0 < found[name]["error_stress"] < 0.03
        assert found[name]["reference_uncertainty_stress"] < 1e-4
    assert found["pin joint"]["error_stress"] is None
    assert found["spline"]["setting"] == "n = 5"
    assert not found["pin joint"]["meets"] and found["pin joint"]["error_trajectory"] > 0.1


def test_no_model_meets_an_impossible_error(few, case, command):
    """Where no model meets the error the exit code says so; the best of each is told, why one refuses the
    pivot, and that verdicts are not certain where a reference is too coarse for them."""
    path = case(("crossing_ratio = 0.5", "crossing_ratio = 0.3"), ("increments = 20", "increments = 4"))
    outcome = command("advise", path, "--accuracy", "1e-12")
    assert outcome.code == 3
    assert "no model meets 1e-12 here" in outcome.err
    *lines, last = outcome.out.splitlines()
    told = [line for line in lines if line.endswith("does not meet it: its best")]
    (refused,) = [line for line in lines if line.startswith("pin joint")]
    assert len(told) >= 4
    assert "got" in refused and "expected" in refused
    assert last.endswith("not certain")


@pytest.mark.slow
def test_dynamic_advice_as_a_table(command, monkeypatch):
    """The command with --dynamic prints each model's setting, errors of rotation and frequency, and time."""
    monkeypatch.setattr(advice, "REFERENCE", (6, 5))
    monkeypatch.setattr(advice, "PERIODS", 1.0)
    small = [each for each in series.own_swings() if each.series == series.IMPLICIT][8:11]

    class Failing(Baseline):
        def release(self, *_, **__):
            raise BaselineFailed("it blew up")

    monkeypatch.setattr(series, "own_swings", lambda *_: small)
    monkeypatch.setattr(series, "other_swings", lambda *_: grid(Failing(model="failing"), "failing"))
    lines = command("advise", CASE, "--accuracy", "0.1", "--dynamic").out.splitlines()
    assert lines[2].split()[:4] == ["model", "setting", "rotation", "frequency"]
    assert any(line.startswith("spline, energy-consistent") and " ms" in line for line in lines)
    assert any(line.startswith("failing") and line.endswith("it blew up") for line in lines)
