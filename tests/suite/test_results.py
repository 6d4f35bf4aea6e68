"""The committed results are fresh, can be drawn again, reproduce, and are what README.md says."""

import shutil
import sys
from pathlib import Path

import pandas as pd
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.legend import Legend

from report.facts import Results
from studies.__main__ import main
from studies.commands import results
from studies.cost.openseespy import _loaded
from studies.errors import BadInput
from studies.record import style
from studies.record.source import ROOT
from studies.record.store import RESULTS, Store, as_csv, inputs
from studies.registry import STUDIES, study_of

#: A study of half a second.
NAME = "convergence/elements"


@pytest.mark.parametrize("name", STUDIES)
def test_study_declares_its_figures_and_its_cases(name):
    """What a study declares is what is stored of it: figures, and cases that are there."""
    study, record = study_of(name), Store().record(name)
    assert {file.rpartition(".")[0] for file in record["figures"]} == set(study.figures)
    assert list(study.cases) == list(record["inputs"]["cases"])
    folders = (ROOT / "studies" / "cases", ROOT / "studies")
    assert all(any((folder / f"{case}.toml").is_file() for folder in folders) for case in study.cases)


@pytest.mark.parametrize("name", STUDIES)
def test_stored_result_is_fresh(name):
    """No committed result was made by other code or from another case than those of today."""
    state = Store().state(name, inputs(STUDIES[name], study_of(name).cases))
    assert (state.kind, state.reason) == ("fresh", "")


@pytest.mark.slow
@pytest.mark.parametrize("name", STUDIES)
def test_legends_stand_on_their_page(name):
    """No entry of a legend is cut by the edge of its figure."""
    store = Store()
    with style.applied():
        for title, page in study_of(name).draw(store.load_tables(name)).items():
            style.rendered(page, "svg")  # which settles the layout and writes the words
            renderer = FigureCanvasAgg(page).get_renderer()
            for entry in (entry for legend in page.findobj(Legend) for entry in legend.get_texts()):
                box, said = entry.get_window_extent(renderer), (title, entry.get_text())
                assert page.bbox.contains(*box.min) and page.bbox.contains(*box.max), said


def test_figure_names_are_unique():
    """No study overwrites the figure of another one."""
    names = [name for study in STUDIES for name in Store().record(study)["figures"]]
    assert len(names) == len(set(names))


@pytest.mark.parametrize("page", results.BLOCKS, ids=lambda page: page.name)
def test_pages_agree_with_the_results(page):
    """The tables of README.md and of docs/findings.md are those of the stored results."""
    text = page.read_text(encoding="utf-8")
    assert results._rewritten(page, Results(Store(), allow_stale=True)) == text
    for name in results.BLOCKS[page]:
        begin, end = f"<!-- {name}: ", f"<!-- end of {name} -->"
        assert text.index(begin) < text.index("|---|", text.index(begin)) < text.index(end)


def test_pages_are_not_written_without_results_or_marks(tmp_path, monkeypatch):
    """Without results, or without the marks, nothing is written and the reason is one line."""
    page = results.ROOT / "README.md"
    with pytest.raises(BadInput, match=r"control_points: got no stored result, expected a fresh result"):
        results._rewritten(page, Results(Store(tmp_path)))
    bare = tmp_path / "BARE.md"
    bare.write_text("no marks", encoding="utf-8")
    monkeypatch.setitem(results.BLOCKS, bare, results.BLOCKS[page])
    with pytest.raises(BadInput, match=r"BARE\.md: got no marks, expected <!-- agreement: written by"):
        results._rewritten(bare, Results(Store(), allow_stale=True))


def test_stored_tables_are_tidy():
    """Every committed table is sorted and rounded as the store writes it: nothing was edited by hand."""
    for study in STUDIES:
        for name, table in Store().load_tables(study).items():
            stored = (Store().data(study) / f"{name}.csv").read_bytes()
            assert as_csv(pd.DataFrame(table)) == stored, f"{study}/{name}"


@pytest.mark.slow
def test_verify_renews_what_is_the_same_and_names_what_differs(tmp_path, capsys):
    """A stale result that is reproduced is marked as fresh; one whose table was edited is named."""
    store, now = Store(tmp_path), inputs(STUDIES[NAME], study_of(NAME).cases)
    shutil.copytree(Store().data(NAME), store.data(NAME))
    shutil.copytree(Store().figures, store.figures)
    store.renew(NAME, now | {"source_sha256": "of other code"})
    words = ["verify", NAME, "--results", str(store.root), "--processes", "1"]
    assert (store.state(NAME, now).kind, main(words), store.state(NAME, now).kind) == ("stale", 0, "fresh")
    path = store.data(NAME) / "meshes.csv"
    table = pd.read_csv(path)
    table.assign(error_torque=1.001 * table["error_torque"]).to_csv(path, index=False)
    assert main(words) == 1
    assert capsys.readouterr().err.endswith(f"{NAME}: differs: meshes (error_torque)\n")


#: Studies that hold the suite against the other codes.
BESIDE_PEERS = ("cost/codes",)


def files_in(folder: Path) -> dict[str, bytes]:
    """Return the content of all files below a folder."""
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def test_results_stay_without_the_other_codes(tmp_path, monkeypatch, capsys):
    """Where Exudyn and OpenSees are not there, the studies beside them keep every byte, so that pages and
    report stay true, and each says in a line what to install."""
    for study in BESIDE_PEERS:
        shutil.copytree(RESULTS / "data" / study, tmp_path / "data" / study)
    before = files_in(tmp_path)
    _loaded.cache_clear()  # a code that was asked for before in this process is remembered
    for name in [loaded for loaded in sys.modules if loaded.partition(".")[0] in ("exudyn", "openseespy")]:
        monkeypatch.setitem(sys.modules, name, None)
    for name in ("exudyn", "openseespy"):
        monkeypatch.setitem(sys.modules, name, None)
    assert main(["run", *BESIDE_PEERS, "--results", str(tmp_path)]) == 0
    assert capsys.readouterr().err.splitlines() == [
        f"{study}: left as it is: it needs exudyn, openseespy: python -m pip install '.[peers]'"
        for study in BESIDE_PEERS
    ]
    assert files_in(tmp_path) == before
