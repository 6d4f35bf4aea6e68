"""The notebook of the designer's hour runs, and is stored without outputs."""

import json

import matplotlib
import pytest

from studies.record.source import ROOT

NOTEBOOK = ROOT / "docs" / "designers_hour.ipynb"


@pytest.mark.slow
def test_notebook_runs_and_its_design_meets_the_requirement(monkeypatch, tmp_path, capsys):
    """Requirement: all cells run in order; their assertions hold for a design that is not the first one."""
    matplotlib.use("agg")
    monkeypatch.chdir(tmp_path)
    cells = [cell for cell in json.loads(NOTEBOOK.read_text("utf-8"))["cells"] if cell["cell_type"] == "code"]
    assert len(cells) >= 8
    names: dict[str, object] = {}
    for cell in cells:
        assert (cell["outputs"], cell["execution_count"]) == ([], None), "clear the outputs before a commit"
        exec("".join(cell["source"]), names)
    assert names["ratio"] != 0.5
    assert names["path"].stiffness[0] == pytest.approx(names["STIFFNESS"], rel=0.02)
    assert "torque of the finite elements" in capsys.readouterr().out
