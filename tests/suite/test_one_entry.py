"""A new quantity of a path is one entry: shown in a copy of the repository that has one more."""

import json
import os
import shutil
import subprocess
import sys

import pandas as pd
import pytest

from studies.record.source import ROOT

#: The bending moment at the first clamp.
ENTRY = """QUANTITIES = (
    Quantity(
        key="clamp_moment_Nm",
        meaning="bending moment of the first strip at its root",
        of=lambda path: path.bending_moment[:, 0, 0],
    ),
"""
KEY = "clamp_moment_Nm"
SWEEP = """
case = "cross_axis_pivot"
settings.control_points = 6
[vary]
strip.area_m2 = [1e-4, 2e-4]
[store]
quantities = ["torque_Nm", "clamp_moment_Nm"]
"""


@pytest.mark.slow
def test_a_quantity_is_one_entry(tmp_path):
    """Table, JSON, CSV, export, comparison, sweep, picture and docs have a quantity that one entry adds."""
    copy = tmp_path / "copy"
    for name in ("spline_model", "fe_reference", "studies", "docs", "report"):
        shutil.copytree(ROOT / name, copy / name)
    for name in ("README.md", "pyproject.toml"):
        shutil.copy(ROOT / name, copy)
    (copy / "results" / "reference").mkdir(parents=True)
    for name in ("data", "figures"):
        (copy / "results" / name).symlink_to(ROOT / "results" / name)
    place = copy / "studies" / "answers" / "quantities.py"
    text = place.read_text(encoding="utf-8")
    place.write_text(text.replace("QUANTITIES = (\n", ENTRY, 1), encoding="utf-8")
    (tmp_path / "sweep.toml").write_text(SWEEP, encoding="utf-8")

    def run(*words):
        """Return what a command of the copy prints."""
        env = os.environ | {"PYTHONPATH": str(copy)}
        command = [sys.executable, "-m", "studies", *words]
        return subprocess.run(
            command, cwd=tmp_path, env=env, capture_output=True, text=True, check=True
        ).stdout

    case = "cross_axis_pivot"
    run("solve", case, "--csv", "path.csv")
    answer = json.loads(run("solve", case, "--json", "-"))
    assert "clamp moment" in run("solve", case, "--plot", "path.svg")
    assert pd.read_csv(tmp_path / "path.csv")[KEY].tolist() == pytest.approx(answer[KEY])
    assert "clamp moment" in (tmp_path / "path.svg").read_text(encoding="utf-8")
    run("solve", case, "--export", "out")
    assert pd.read_csv(tmp_path / "out" / "static_states.csv")[KEY].iloc[-1] == pytest.approx(answer[KEY][-1])
    assert KEY in next((tmp_path / "out").glob("*_0020.vtu")).read_text(errors="ignore")
    assert any(line.startswith("clamp moment, end") for line in run("compare", case, case).splitlines())
    run("sweep", "sweep.toml", "--out", "swept")
    rows = pd.read_parquet(tmp_path / "swept" / "designs.parquet")
    assert (rows["status"] == "converged").all() and rows[KEY].abs().min() > 0.0
    run("readme")
    assert f"`{KEY}`" in (copy / "docs" / "data.md").read_text(encoding="utf-8")
