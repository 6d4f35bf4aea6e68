"""Convergence: the command's errors, orders and counts, and the study of the error estimate."""

import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from studies.answers.adapters import answer_static
from studies.answers.settings import SplineSettings
from studies.cases.problem import named_case
from studies.convergence import error_estimate
from studies.record.store import Store
from tests import gates


def test_a_section_without_stress_is_refined(command, tmp_path):
    """Requirement: where no stress is known, neither its error nor that of its reference is drawn."""
    case = Path(__file__).parent / "finds" / "half_circle.toml"
    words = ["converge", case, "--control-points", "4:8", "--elements", "5:40", "--out", tmp_path / "out"]
    outcome = command(*words)
    assert outcome.code == 0 and "stress nan" not in outcome.out
    assert (tmp_path / "out" / "convergence.png").is_file()


def test_table_folder_orders_and_counts(command, case, tmp_path):
    """The table has a row for every count, order 2 for the elements, and the counts for three accuracies; the
    folder holds both tables and the figure, and what was there before."""
    folder = tmp_path / "out"
    folder.mkdir()
    (folder / "mine.txt").write_text("keep")
    path = case(("rotation_deg = 90", "rotation_deg = 30"), ("increments = 20", "increments = 3"))
    words = ["converge", path, "--control-points", "4:6", "--elements", "5:40", "--out", folder]
    outcome = command(*words)
    assert outcome.code == 0
    rows = {
        int(line.split()[0]): line.split() for line in outcome.out.splitlines() if re.match(r" +\d", line)
    }
    assert set(rows) == {4, 5, 6, 10, 20, 40}
    assert [float(cell) for cell in rows[40][2:9:2]] == pytest.approx([2.0] * 4, abs=0.1)
    assert rows[40][9] == "converged"
    assert re.search(r"trajectory and torque +1e-03 +1e-04 +1e-06\n", outcome.out)
    assert len(re.findall(r"\nelements +\d+ +\d+ +> 40\n", outcome.out)) == 2
    assert 0.0 < float(re.search(r"uncertainty: .*, stress (\S+)\n", outcome.out)[1]) < 1e-6
    names = {"control_points.csv", "elements.csv", "convergence.png", "convergence.svg", "mine.txt"}
    assert {path.name for path in folder.iterdir()} == names
    assert (folder / "mine.txt").read_text() == "keep"
    elements = pd.read_csv(folder / "elements.csv")
    assert list(elements["elements"]) == [5, 10, 20, 40]
    assert (elements["error_torque"] > 0.0).all()


def test_the_stress_has_an_estimate_of_its_own():
    """The estimate of the largest stress is not below its error; half a dozen points by curvature are."""
    case = named_case("titanium_pivot")
    exact = answer_static(case, SplineSettings(control_points=16)).max_stress
    estimate = answer_static(case, SplineSettings()).estimate["stress"]

    def optimism(**grid):
        stress = answer_static(case, SplineSettings(**grid)).max_stress
        return np.abs(stress - exact).max() / exact.max() / estimate

    gates.hold("spline_stress_accuracy_optimism", optimism)


def test_estimates_of_all_designs_are_within_their_band():
    """Over 36 designs and six accuracies: 0.3 to 10 for 90 %, none below a third."""
    tables = Store().load_tables("convergence/error_estimate")
    rows = tables["estimates"]
    assert rows["design"].nunique() >= 30
    least = rows["accuracy"] == rows["accuracy"].min()  # there stresses may end at round-off, with a message
    assert (rows.loc[~least, "status"] == "converged").all()
    assert (rows.loc[least, "status"] == "converged").mean() > 0.9
    statics, stress = rows[rows["counts"]], tables["stress"].query("counts")
    assert statics["effectivity"].between(*error_estimate.BAND).mean() >= error_estimate.SHARE
    # the points are chosen for the stiffness of the body too, so that estimates of stress are cautious
    assert stress["effectivity"].min() >= error_estimate.BAND[0]
    assert (stress["true_error"] <= stress["accuracy"]).all()
    gates.check("spline_stress_accuracy_optimism", (1.0 / stress["effectivity"]).max())
    gates.check("spline_accuracy_request", (statics["true_error"] / statics["accuracy"]).max())
    gates.check("spline_accuracy_effectivity", np.log(statics["effectivity"]).abs().max())
