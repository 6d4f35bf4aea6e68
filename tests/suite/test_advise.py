"""The adviser: the cheapest setting of every model that meets an error."""

import json
import math
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from studies.__main__ import main
from studies.baselines.answer import BaselineFailed, SolvedPath
from studies.baselines.variant import Baseline, grid
from studies.cases.problem import FOLDER, named_case
from studies.commands import advise as command
from studies.errors import BadInput
from studies.work_precision import advice, series
from studies.work_precision.equal_error import cheapest, coarsest, kept
from studies.work_precision.limits import path_errors

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


def test_cheapest_at_equal_error():
    """At each error the fastest setting of every series is found, and its time over the spline's."""
    table = rows([[1e-1, 1e-3, 1e-5], [1e-2, 1e-3]], names=("spline", "b"), slow=10.0)
    found = cheapest(table, columns=["error_x"], rank="rank", targets=(1e-2, 1e-4))
    loose, tight = found.iloc[:2].set_index("series"), found.iloc[2:].set_index("series")
    assert (loose.loc["spline", "setting"], loose.loc["b", "setting"]) == ("spline1", "b0")
    assert loose.loc["b", "ratio"] == 10.0 / 2.0
    assert tight.loc["spline", "setting"] == "spline2"
    assert tight.loc["b", "setting"] == "" and math.isnan(tight.loc["b", "ratio"])


def test_a_model_that_cannot_says_so_with_its_best():
    """Of a series that does not reach the error the best setting stands, and that it does not meet it."""
    found = advice._chosen(rows([[1e-1, 1e-3], [1e-2, 3e-2], [math.nan]]), ["error_x"], 5e-3)
    assert found["setting"].tolist() == ["a1", "b0", "c0"]
    assert found["meets"].tolist() == [True, False, False]


def exact_path(problem, offset=0.0):
    """A made-up path of the problem, off by `offset` of its own size."""
    turns = np.linspace(0.0, problem.rotation, problem.increments + 1)
    return SolvedPath(
        status="converged",
        message="",
        rotation=turns,
        centre=np.column_stack((np.sin(turns), turns)) * (1.0 + offset),
        torque=turns * (1.0 + offset),
        stiffness=np.ones_like(turns),
        max_stress=turns * (1.0 + 2.0 * offset),
        solve_s=1e-3 / max(offset, 1e-9),
        wall_s=1.0,
        work={},
    )


def test_errors_of_a_path_relate_to_its_reference():
    """A path one per cent too large has that error everywhere but in what it does not scale."""
    problem = named_case("cross_axis_pivot")
    found = path_errors(exact_path(problem, 0.01), exact_path(problem))
    assert found["error_torque"] == pytest.approx(0.01, rel=1e-9)
    assert found["end_trajectory"] == pytest.approx(0.01, rel=1e-9)
    assert found["error_stiffness"] == 0.0
    assert (found["error_stress"], found["end_stress"]) == pytest.approx((0.02, 0.02), rel=1e-9)
    silent = path_errors(replace(exact_path(problem), max_stress=None), exact_path(problem))
    assert math.isnan(silent["error_stress"]) and silent["error_torque"] == 0.0
    stopped = replace(exact_path(problem), status="not_converged")
    assert all(math.isnan(value) for value in path_errors(stopped, exact_path(problem)).values())


def test_a_baseline_that_refuses_is_a_row():
    """A pivot outside of a surrogate's range is an answer that stopped, with the reason."""

    class Refusing(Baseline):
        def static_path(self, *_, **__):
            raise BadInput("pin joint: got this, expected that")

    (variant,) = grid(Refusing(model="pin joint"), "pin joint")
    path = variant.path(named_case("cross_axis_pivot"), 1)
    assert variant.setting == "closed form"
    assert (path.status, path.message) == ("not_converged", "pin joint: got this, expected that")


def test_static_advice_as_json(capsys, monkeypatch):
    """The command advises on Table 1: the spline and the elements meet 1e-2, the pin joint does not."""
    wanted = ("linear pivot", "pin joint", "four-bar")
    own = [each for each in series.own_paths(range(4, 7)) if each.series in (series.SPLINE, series.ELEMENTS)]
    others = [each for each in series.other_paths() if each.series in wanted]
    monkeypatch.setattr(series, "own_paths", lambda counts: own)
    monkeypatch.setattr(series, "other_paths", lambda: others)
    assert main(["advise", CASE, "--accuracy", "1e-2", "--json", "-"]) == 0
    document = json.loads(capsys.readouterr().out)
    found = {row["model"]: row for row in document["models"]}
    assert set(found) == {"spline", series.ITSELF, "finite elements", *wanted}
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


@pytest.mark.slow
def test_dynamic_advice_as_a_table(capsys, monkeypatch):
    """The command with --dynamic prints each model's setting, errors of rotation and frequency, and time."""
    monkeypatch.setattr(advice, "REFERENCE", (6, 5))
    monkeypatch.setattr(advice, "PERIODS", 1.0)
    small = [each for each in series.own_swings() if each.series == series.IMPLICIT][8:11]

    class Failing(Baseline):
        def release(self, *_, **__):
            raise BaselineFailed("it blew up")

    monkeypatch.setattr(series, "own_swings", lambda *_: small)
    monkeypatch.setattr(series, "other_swings", lambda *_: grid(Failing(model="failing"), "failing"))
    assert main(["advise", CASE, "--accuracy", "0.1", "--dynamic"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[2].split()[:4] == ["model", "setting", "rotation", "frequency"]
    assert any(line.startswith("spline, energy-consistent") and " ms" in line for line in lines)
    assert any(line.startswith("failing") and line.endswith("it blew up") for line in lines)


def test_no_model_meets_an_impossible_error(capsys, monkeypatch):
    """Where no model meets the error the exit code says so, and the best of each is still told."""

    class Coarse(Baseline):
        def path(self, problem, *_, **__):
            return exact_path(problem, 0.5)

    coarse = Coarse(model="spline")
    monkeypatch.setattr(series, "own_paths", lambda counts: grid(coarse, series.SPLINE))
    monkeypatch.setattr(advice, "spline", coarse)
    monkeypatch.setattr(series, "other_paths", list)
    assert main(["advise", CASE, "--accuracy", "1e-9"]) == 3
    streams = capsys.readouterr()
    assert "no model meets 1e-09 here" in streams.err
    assert "its best" in streams.out


def test_uncertain_references_are_told():
    """When a reference is too coarse for the wanted error, the table says that the verdict is not certain."""
    found = advice._chosen(rows([[1e-4]]), ["error_x"], 1e-3).assign(uncertainty=5e-4)
    lines = list(command._readable(named_case("cross_axis_pivot"), found, ["error_x"], 1e-3))
    assert "not certain" in lines[-1]
