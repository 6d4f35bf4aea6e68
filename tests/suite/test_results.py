"""The committed results are fresh and what README.md says; the store is tidy, whole and repeatable."""

import gc
import getpass
import json
import platform
import shutil
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.legend import Legend

from report.facts import Results
from studies.__main__ import main
from studies.commands import results
from studies.commands.results import whole
from studies.cost.openseespy import _loaded
from studies.engine import Part, Study
from studies.errors import BadInput
from studies.record import progress, style
from studies.record.files import OutputError, write_whole
from studies.record.progress import Bar, measure, silent
from studies.record.source import ROOT
from studies.record.store import RESULTS, Digits, Store, as_csv, differing, inputs
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


STUDY = "paper/example"
MODULE = "studies.answers.metrics"
CASES = ("cross_axis_pivot",)
TABLE = pd.DataFrame(
    {"model": ["b", "a", "a"], "rotation_rad": [0.5, 1 / 3, 0.25], "status": ["ok", "ok", "x"]}
)


def _save(store: Store) -> bool:
    return store.save_tables(STUDY, {"example": TABLE}, inputs(MODULE, CASES), 1.0)


def _draw() -> dict:
    with style.applied():
        page = style.page(3.0, 2.0)
        page.subplots().plot([0.0, 1.0], [0.0, 1.0], label="a line")
        return {"example": page}


@pytest.fixture
def store(tmp_path):
    """A store with one computed and drawn study."""
    store = Store(tmp_path / "results")
    _save(store)
    store.save_figures(STUDY, _draw())
    return store


def _state(store: Store) -> tuple[str, str]:
    return store.state(STUDY, inputs(MODULE, CASES))


def test_table_is_sorted_with_eight_digits():
    """A table is sorted from left to right, has 8 significant digits, and keeps failed points."""
    failed = pd.concat(
        [TABLE, pd.DataFrame({"model": ["c"], "rotation_rad": [np.nan], "status": ["failed"]})]
    )
    assert as_csv(failed).decode() == (
        "model,rotation_rad,status\na,0.25,x\na,0.33333333,ok\nb,0.5,ok\nc,,failed\n"
    )


def test_provenance_tells_the_origin_and_not_the_place(store):
    """Provenance has command, inputs, hashes, versions, machine and date, but no path, user or host."""
    text = (store.data(STUDY) / "provenance.json").read_text(encoding="utf-8")
    record = json.loads(text)
    assert {"command", "inputs", "tables", "figures", "versions", "machine", "date", "elapsed_s"} <= set(
        record
    )
    assert set(record["tables"]) == {"example.csv"}
    assert set(record["figures"]) == {"example.png", "example.svg"}
    values = [
        str(value) for part in (record, record["machine"], record["versions"]) for value in part.values()
    ]
    for secret in (str(ROOT), str(store.root), platform.node(), getpass.getuser()):
        assert secret not in values
        assert str(ROOT) not in text


def test_fresh_stale_missing(store):
    """A result is fresh until the case, the source or a file changes, and missing without its files, of which
    figures may be none."""
    assert _state(store) == ("fresh", "")
    now = inputs(MODULE, CASES)
    for part, said in (("source_sha256", "the source"), ("cases", "a case")):
        found = store.state(STUDY, now | {part: "another"})
        assert found == ("stale", f"{said} was changed")
    (store.figures / "example.png").write_bytes(b"edited")
    assert _state(store) == ("stale", "example.png was changed after it was made")
    (store.figures / "example.png").unlink()
    assert _state(store) == ("missing", "example.png does not exist")
    _save(store)
    assert _state(store) == ("missing", "no figure was drawn")
    store.save_figures(STUDY, {})
    assert _state(store) == ("fresh", "")
    assert Store(store.root / "empty").state(STUDY, {}).reason == "never run"


def test_figures_are_equal_byte_by_byte(store):
    """Drawing again gives the same bytes; a figure that a study no longer draws does not linger."""
    before = {path.name: path.read_bytes() for path in store.figures.iterdir()}
    store.save_figures(STUDY, _draw())
    assert {path.name: path.read_bytes() for path in store.figures.iterdir()} == before
    store.save_figures(STUDY, {"renamed": _draw()["example"]})
    assert sorted(path.name for path in store.figures.iterdir()) == ["renamed.png", "renamed.svg"]


def test_interrupted_file_leaves_the_former_one(tmp_path, monkeypatch):
    """When writing fails midway the former file stands and no part of the new one remains."""
    path = tmp_path / "answer.json"
    write_whole(path, b"former")

    def fail(self, target):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("pathlib.Path.replace", fail)
    with pytest.raises(OutputError, match=r"answer.json: cannot be written \(No space left on device\)"):
        write_whole(path, b"new")
    assert [item.name for item in tmp_path.iterdir()] == ["answer.json"]
    assert path.read_bytes() == b"former"


def test_an_interrupted_result_is_told(store):
    """When one table of a study cannot be written, nothing is left of its parts, and the result is stale."""
    tables = {"example": TABLE.assign(rotation_rad=0.0), "absent/b": TABLE}
    with pytest.raises(OutputError, match="cannot be written"):
        store.save_tables(STUDY, tables, inputs(MODULE, CASES), 1.0)
    assert {path.name for path in store.data(STUDY).iterdir()} == {"example.csv", "provenance.json"}
    assert _state(store) == ("stale", "example.csv was changed after it was made")


def test_figures_write_units_and_the_pivot_in_one_way():
    """Degrees are written by their sign, a pure number without a unit and the pivot of the paper's Table 1 as
    the benchmark pivot, whatever a figure calls them."""
    with style.applied():
        figure = style.page(4.0, 2.0)
        panel = figure.subplots()
        panel.set(xlabel="rotation [deg]", ylabel="error of the path / travel [1]", title="Table 1, at rest")
        style.rendered(figure, "svg")
    assert (panel.get_xlabel(), panel.get_ylabel()) == ("rotation [°]", "error of the path / travel")
    assert panel.get_title(loc="left") == "benchmark pivot, at rest"


def test_a_fresh_result_with_the_same_tables_is_not_written_again(store):
    """Nothing changes on the disk, and no figure is to be drawn."""
    files = [path for path in store.root.rglob("*") if path.is_file()]
    before = {path: path.stat().st_mtime_ns for path in files}
    assert _save(store) is False
    assert {path: path.stat().st_mtime_ns for path in files} == before


STORED = pd.DataFrame(
    [
        {"case": "a", "status": "ok", "torque_Nm": 1000.0, "error": 1e-14, "count": 3, "iterations": 27},
        {"case": "b", "status": "failed", "torque_Nm": None, "error": 0.5, "count": 4, "iterations": 20},
    ]
)


NEARLY, APART, LOOSE = 1000.0 * (1.0 + 1e-9), 1000.0 * (1.0 + 1e-3), Digits(relative=1e-2)


@pytest.mark.parametrize(
    ("column", "found", "digits", "differs"),
    [
        ("torque_Nm", NEARLY, {}, False),
        ("torque_Nm", APART, {}, True),
        ("torque_Nm", float("nan"), {}, True),
        ("error", 3e-11, {}, False),
        ("error", 3e-6, {}, True),
        ("count", 5, {}, True),
        ("iterations", 35, {}, False),
        ("status", "OK", {}, True),
        ("torque_Nm", APART, {"torque_Nm": LOOSE}, False),
        ("torque_Nm", APART, {"table.torque_Nm": LOOSE}, False),
        ("torque_Nm", APART, {"other.torque_Nm": LOOSE}, True),
        ("torque_Nm", APART, {"torque_Nm": None}, False),
        ("torque_Nm", APART, {"torque_Nm": Digits(rows="status == 'failed'")}, False),
        ("torque_Nm", APART, {"torque_Nm": Digits(rows="status == 'ok'")}, True),
    ],
)
def test_tables_are_compared_within_their_digits(column, found, digits, differs):
    """Numbers may differ by round-off, errors down to a floor, or by what a study states for a column of one
    table or of all, for all rows or some; words and whole numbers may not."""
    other = STORED.astype({column: type(found)})
    other.loc[0, column] = found
    assert differing("table", STORED, other, digits) == ([column] if differs else [])


def test_tables_of_another_shape_differ():
    """Rows that are missing and columns of another name are named."""
    assert differing("table", STORED, STORED.iloc[:1], {}) == ["1 rows, stored 2"]
    assert differing("table", STORED, STORED.rename(columns={"case": "name"}), {}) == ["case", "name"]


ASKED: list[int] = []


def squared(number):
    """A row and its neighbour in a table of its own."""
    ASKED.append(number)
    return {"squares": {"number": number, "square": number**2}, "next": [{"number": number + 1}]}


SQUARES = Study(cases=(), parts=(Part(at=lambda: (1, 2, 4), ask=squared),), figures={})
TWO_PARTS = Study(
    cases=(),
    parts=(Part(at=lambda: (1,), ask=squared, alone=True), Part(at=lambda: (2,), ask=squared)),
    figures={},
)


def test_what_must_be_alone_comes_after_all_others():
    """A study is whole as soon as its points are answered; those that must be alone are asked last."""
    one, other = f"{__name__}:SQUARES", f"{__name__}:TWO_PARTS"
    ASKED.clear()
    with ThreadPoolExecutor(1) as pool:
        found = [*whole([other, one], silent, pool)]
    assert [name for name, _, _ in found] == [one, other]
    assert ASKED == [2, 1, 2, 4, 1]
    assert all(seconds > 0.0 for _, _, seconds in found)


def test_timing_warms_up_and_counts_repeats():
    """The work runs warm_up + repeat times; collection is off while timed and then restored."""
    seen = []
    timing = measure(lambda: seen.append(gc.isenabled()) or len(seen), repeat=3, warm_up=2)
    assert seen == [True, True, False, False, False]
    assert gc.isenabled()
    assert timing.result == 5
    assert len(timing.seconds) == 3
    assert min(timing.seconds) <= timing.median <= max(timing.seconds)
    with pytest.raises(ValueError, match="got 0, expected at least 1"):
        measure(lambda: None, repeat=0)


def test_bar_shows_long_work_on_a_terminal_only(capsys, monkeypatch):
    """Work that lasts is shown on the error stream where this is a terminal, short work is not."""
    for terminal, delay, shown in ((True, 60.0, False), (False, 0.0, False), (True, 0.0, True)):
        monkeypatch.setattr(sys.stderr, "isatty", lambda terminal=terminal: terminal)
        monkeypatch.setattr(progress, "DELAY", delay)
        with Bar("work") as bar:
            bar(1, 2)
            bar(2, 2)
        captured = capsys.readouterr()
        assert captured.out == ""
        assert ("work" in captured.err) is shown
