"""The committed results are fresh, can be drawn again, reproduce, and are what README.md says."""

import importlib.metadata
import json
import shutil
from hashlib import sha256

import numpy as np
import pandas as pd
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.legend import Legend

from studies.__main__ import main
from studies.asking import answered
from studies.commands import readme
from studies.errors import BadInput
from studies.paper import formulations
from studies.record import style
from studies.record.source import ROOT
from studies.record.store import Store, as_csv, same
from studies.registry import STUDIES, study_of
from studies.stability.family import DEFAULT, DIGITS


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
    state = Store().state(name, module=STUDIES[name], cases=study_of(name).cases)
    assert (state.kind, state.reason) == ("fresh", "")


@pytest.mark.slow
@pytest.mark.parametrize("name", STUDIES)
def test_stored_tables_draw_the_stored_figures(name):
    """With the same libraries the committed tables give the committed vector figures byte by byte."""
    store = Store()
    record = store.record(name)
    for library in ("matplotlib", "numpy", "pandas"):
        if record["versions"][library] != importlib.metadata.version(library):
            pytest.skip(f"drawn with {library} {record['versions'][library]}")
    with style.applied():
        figures = study_of(name).draw(store.load_tables(name))
    drawn = {
        f"{title}.svg": sha256(style.rendered(page, "svg")).hexdigest() for title, page in figures.items()
    }
    assert drawn == {file: digest for file, digest in record["figures"].items() if file.endswith(".svg")}


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


def test_stored_paths_reproduce():
    """Computed again, the paths of Fig 4 are those stored, to the digits that round-off leaves."""
    name = "paper/fig04_trajectory"
    stored = Store().load_tables(name)["paths"]
    computed = answered(study_of(name))["paths"].sort_values(list(stored.columns)).reset_index(drop=True)
    assert list(computed["formulation"]) == list(stored["formulation"])
    for column in ("rotation_rad", "com_x_m", "com_y_m"):
        np.testing.assert_allclose(computed[column], stored[column], rtol=0.0, atol=1e-10)


def test_every_formulation_has_its_look_and_its_meaning():
    """Each formulation of the paper's figures has a colour of its own and says what it is."""
    names = {*formulations.SETTINGS, formulations.REFINED}
    assert names == set(style.LOOKS) == set(formulations.MEANING)
    colours = [look.colour for look in style.LOOKS.values()]
    assert len(colours) == len(set(colours))


def test_findings_say_what_their_numbers_say():
    """Each finding of Figs 3 to 5 is a sentence with number and verdict, for every formulation."""
    for study in ("fig03_snapshots", "fig04_trajectory", "fig05_stiffness"):
        found = Store().load_tables(f"paper/{study}")["findings"]
        splines = {name for name, setting in formulations.SETTINGS.items() if setting.model == "spline"}
        assert set(found["formulation"]) == splines
        assert set(found["holds"]) <= {"yes", "no"}
        for row in found.to_dict("records"):
            verdict = "the claim holds." if row["holds"] == "yes" else "the claim does not hold."
            assert row["sentence"].startswith(f"{row['formulation']}: {row['quantity']} is ")
            assert row["sentence"].endswith(verdict)


@pytest.mark.parametrize("page", readme.BLOCKS, ids=lambda page: page.name)
def test_pages_agree_with_the_results(page):
    """The tables of README.md and of docs/findings.md are those of the stored results."""
    text = page.read_text(encoding="utf-8")
    assert readme._rewritten(page, Store()) == text
    for name in readme.BLOCKS[page]:
        begin, end = readme._marks(name)
        assert text.index(begin) < text.index("|---|", text.index(begin)) < text.index(end)


def test_no_outcome_of_a_hard_case_is_a_slip_of_the_code():
    """A wrong outcome is an answer, never an exception of Python; and the default has none, as is said."""
    said = (ROOT / "docs" / "findings.md").read_text(encoding="utf-8")
    for study in (each for each in STUDIES if each.startswith("stability/")):
        outcomes = Store().load_tables(study)["outcomes"]
        assert not outcomes["reason"].astype(str).str.contains(r"^\w*Error: ").any(), study
        wrong = outcomes[(outcomes["model"] == DEFAULT) & (outcomes["outcome"] == "wrong")]
        assert ("The default is nowhere wrong" in said) and wrong.empty, study


def test_pages_are_not_written_without_results_or_marks(tmp_path, monkeypatch):
    """Without results, or without the marks, nothing is written and the reason is one line."""
    page = readme.ROOT / "README.md"
    with pytest.raises(
        BadInput, match=r"control_points: got no stored tables, expected those of `make figures`"
    ):
        readme._rewritten(page, Store(tmp_path))
    bare = tmp_path / "BARE.md"
    bare.write_text("no marks", encoding="utf-8")
    monkeypatch.setitem(readme.BLOCKS, bare, readme.BLOCKS[page])
    with pytest.raises(BadInput, match=r"BARE\.md: got no marks, expected <!-- agreement: written by"):
        readme._rewritten(bare, Store())


def test_stored_tables_are_tidy():
    """Every committed table is sorted and rounded as the store writes it: nothing was edited by hand."""
    for study in STUDIES:
        for name, table in Store().load_tables(study).items():
            stored = (Store().data(study) / f"{name}.csv").read_bytes()
            assert as_csv(pd.DataFrame(table)) == stored, f"{study}/{name}"


@pytest.mark.parametrize(
    ("column", "found", "equal"),
    [
        ("iterations", 592, True),
        ("iterations", 700, False),
        ("energy_gain", 3e-14, True),
        ("energy_gain", 3e-9, False),
        ("error", 0.0123456789, True),
        ("error", 0.012345671, True),
        ("error", 0.012346, False),
        ("error", float("nan"), False),
        ("halvings", 1, False),
        ("outcome", "wrong", False),
    ],
)
def test_verify_knows_round_off(column, found, equal):
    """Columns that state their digits are held to these, balances to a floor, and all else to the letter."""
    table = {"case": "a", "outcome": "right", "error": 0.01234567, "iterations": 591, "halvings": 0}
    stored = pd.DataFrame([{**table, "energy_gain": 1e-15}, {**table, "case": "b", "error": None}])
    other = stored.astype({column: type(found)})
    other.loc[0, column] = found
    assert same(stored, stored, DIGITS)
    assert same(stored, other, DIGITS) == equal
    assert not same(stored, other, {})
    assert not same(stored, stored.iloc[:1], DIGITS)
    assert not same(stored, stored.rename(columns={"case": "name"}), DIGITS)


@pytest.mark.slow
def test_a_study_that_comes_out_equal_is_fresh_again(tmp_path, capsys):
    """Where code was changed and every table comes out as stored, the result stands; with another it is
    named and stays stale."""
    name = "convergence/elements"
    store, module = Store(tmp_path), STUDIES[name]
    shutil.copytree(Store().data(name), store.data(name))
    shutil.copytree(Store().figures, store.figures)
    cases = study_of(name).cases

    def changed(**given):
        record = store.record(name) | given
        (store.data(name) / "provenance.json").write_text(json.dumps(record), encoding="utf-8")

    words = ["verify", name, "--results", str(tmp_path), "--processes", "1"]
    old = {"cases": store.record(name)["inputs"]["cases"], "source_sha256": "of other code"}
    changed(inputs=old)
    assert main(words) == 0
    assert store.state(name, module=module, cases=cases).kind == "fresh"
    table = store.data(name) / "limits.csv"
    table.write_bytes(table.read_bytes().replace(b"corotational", b"corotated", 1))
    assert main(words) == 1
    assert capsys.readouterr().err.endswith("convergence/elements: differs: limits\n")
    assert store.state(name, module=module, cases=cases).kind == "stale"
