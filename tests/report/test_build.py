"""A build ends in one line where the results do not give what the report says, and leaves the former file."""

import copy
import shutil
import subprocess
import sys

import pytest

import report.build
from report.build import FAILED, main, typeset
from report.facts import Fact, ReportError, Results, Stored, table
from report.forms import percent
from studies.record.source import ROOT
from studies.record.store import RESULTS, Store
from tests.report.sources import OneTable

FIG04 = "paper/fig04_trajectory"


@pytest.fixture
def changed(tmp_path, monkeypatch):
    """A copy of the results that may be spoilt, which the build then reads."""
    root = tmp_path / "results"
    shutil.copytree(RESULTS, root)
    monkeypatch.setattr(report.build, "Store", lambda: Store(root))
    return root


def _refused(capsys, output, *more):
    """Return the one line that a build says, having checked that the former file is untouched."""
    output.write_bytes(b"former")
    assert main(["-o", str(output), *more]) == FAILED
    assert output.read_bytes() == b"former"
    assert [path.name for path in output.parent.glob(".*")] == []
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    return said


@pytest.mark.parametrize(
    ("spoilt", "spoil", "got"),
    [
        (f"data/{FIG04}/summary.csv", lambda path: path.write_bytes(b"a\n"), "a stale result ("),
        (f"data/{FIG04}", shutil.rmtree, "no stored result"),
        ("figures/fig04_trajectory.svg", lambda path: path.unlink(), "fig04_trajectory.svg does not exist"),
    ],
    ids=["changed", "never run", "no figure"],
)
def test_what_is_not_fresh_ends_the_build(spoilt, spoil, got, changed, tmp_path, capsys):
    """One line names an edited table, a study that was never run or a figure that is gone, and the remedy."""
    spoil(changed / spoilt)
    said = _refused(capsys, tmp_path / "out.pdf", *(["--allow-stale"] if "stale" not in got else []))
    assert got in said and "expected a fresh result: `python -m studies run" in said


def test_stale_results_pass_when_allowed(changed):
    """Stale results are taken when asked for, and named."""
    path = changed / "data" / FIG04 / "findings.csv"
    path.write_text(path.read_text(encoding="utf-8") + "\n", encoding="utf-8")
    results = Results(Store(changed), allow_stale=True)
    results.table(FIG04, "summary")
    assert results.stale == {FIG04: "findings.csv was changed after it was made"}


@pytest.mark.parametrize(
    ("columns", "reason"),
    [
        ({"formulation": ["a"], "value": [float("nan")]}, "nan is no number to write"),
        ({"formulation": ["a"], "value": [float("inf")]}, "inf is no number to write"),
        ({"formulation": ["b"], "value": [1.0]}, "no row with formulation = a"),
        ({"formulation": ["a", "a"], "value": [1.0, 2.0]}, "2 rows"),
        ({"formulation": ["a"], "other": [1.0]}, "no column value"),
    ],
)
def test_number_that_is_not_there_is_refused(columns, reason):
    """A fact that is no number, or not one number, is named with its table."""
    given = Stored("study", "table").at("value", percent, formulation="a")
    with pytest.raises(ReportError, match=rf"^name: .*{reason}.*\(study/table\)$"):
        given.given("name", OneTable(**columns))


def test_condition_and_table_without_their_data_are_refused():
    """A condition or table that asks for what is not there is named."""
    missing = OneTable(a=[1])
    lost = Fact(made=lambda r: Stored("", "").value(r, "b"), form=bool, said="some words")
    with pytest.raises(ReportError, match=r"^name: no column b.* \(some words\)$"):
        lost.given("name", missing)
    with pytest.raises(ReportError, match=r"^name: got no rows"):
        Fact(made=lambda r: iter([["a"]]), form=table).given("name", missing)


@pytest.mark.parametrize(
    ("holds", "formulations", "expected"),
    [
        (["yes", "yes", "no"], ("a", "b"), True),
        (["yes", "no", "yes"], ("a", "b"), False),
        (["yes", "yes", "no"], (), False),
        (["yes", "yes", "yes"], (), True),
    ],
)
def test_condition_is_that_of_all_findings(holds, formulations, expected):
    """A condition holds where all findings on the claim do; others do not count, a missing one is named."""
    table = OneTable(
        claim=["Fig 5: x"] * 3 + ["Fig 6: y"], formulation=["a", "b", "c", "a"], holds=[*holds, "no"]
    )
    condition = Stored("study", "findings").found("Fig 5", *formulations)
    assert condition.given("name", table) is expected
    with pytest.raises(ReportError, match=r"^name: 0 findings on 'Fig 7' \(study/findings\)$"):
        Stored("study", "findings").found("Fig 7").given("name", table)
    with pytest.raises(ReportError, match=r"^name: 1 findings on 'Fig 5'"):
        Stored("study", "findings").found("Fig 5", "a", "d").given("name", table)


def test_unsupported_sentence_ends_the_build(content):
    """A sentence whose condition fails is not printed: its name is said in one line."""
    spoilt = copy.deepcopy(content)
    spoilt["holds"]["fig05.locks"] = False
    with pytest.raises(ReportError, match=r"no longer support the sentence fig05\.locks$") as caught:
        typeset(spoilt)
    assert "\n" not in str(caught.value)


#: What sections quote, and a name of each kind.
QUOTED = {
    "facts": "suite.version",
    "figures": "fig04_trajectory",
    "listings": "claims",
    "holds": "fig04.holds",
}


@pytest.mark.parametrize("kind", ["facts", *(pytest.param(each, marks=pytest.mark.slow) for each in QUOTED)])
def test_unknown_name_ends_the_build(content, kind):
    """What a section quotes and nothing gives is named in one line."""
    spoilt = copy.deepcopy(content)
    del spoilt[kind][QUOTED[kind]]
    with pytest.raises(ReportError, match=rf"got the unknown \w+ {QUOTED[kind]}") as caught:
        typeset(spoilt)
    assert "\n" not in str(caught.value)


@pytest.mark.slow
def test_build_is_quick_and_the_same_every_time(tmp_path):
    """Two builds in processes of their own are equal byte by byte, and neither loads a model."""
    builds = []
    for seed in ("1", "2"):
        path = tmp_path / f"{seed}.pdf"
        words = ["-X", "importtime", "-m", "report.build", "--allow-stale", "-o", str(path)]
        done = subprocess.run(
            [sys.executable, *words], cwd=ROOT, env={"PYTHONHASHSEED": seed, "PYTHONPATH": str(ROOT)},
            capture_output=True, text=True, check=True, timeout=30,
        )  # fmt: skip
        loaded = {line.rpartition("|")[2].strip().partition(".")[0] for line in done.stderr.splitlines()}
        assert not loaded & {"numba", "spline_model", "fe_reference"}
        builds.append(path.read_bytes())
    assert builds[0] == builds[1]
