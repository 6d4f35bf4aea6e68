"""The text types no number, quotes only what there is, and shows what studies draw."""

import re

import pytest

from report.build import quotable
from studies.commands import results
from studies.record.source import ROOT
from studies.registry import STUDIES, study_of
from tests.report.sources import FOLDER, SECTIONS, prose, quoted, text


@pytest.mark.parametrize("path", SECTIONS, ids=lambda path: path.name)
def test_no_number_is_typed(path):
    """But for the paper's numbered parts, mathematics and a short list of quotations there is no digit."""
    assert [line.strip() for line in prose(text(path)).splitlines() if re.search(r"\d", line)] == []


@pytest.mark.parametrize(
    ("kind", "functions"), [("facts", ("fact",)), ("holds", ("supported",)), ("listings", ("listing",))]
)
def test_what_is_given_is_quoted(kind, functions):
    """Every fact, condition and table is used by a section or a page, and every one that is used is given."""
    pages = {"listings": set(results.FINDINGS)}.get(kind, set())
    assert set().union(pages, *map(quoted, functions)) == set(quotable()[kind])


def test_every_figure_is_shown_and_referred_to():
    """What studies draw is on a page: of the report, which refers to it, or of README and docs."""
    drawn = {name for study in STUDIES for name in study_of(study).figures}
    pages = [ROOT / "README.md", *(ROOT / "docs").glob("*.md")]
    elsewhere = re.findall(r"results/figures/(\w+)\.png", "".join(map(text, pages)))
    assert quoted("plot") <= drawn <= quoted("plot") | set(elsewhere)
    assert quoted("plot") == quoted("see")


def test_every_table_is_referred_to():
    """The text refers to each of its tables."""
    assert quoted("listing") == quoted("seetable")


def test_every_figure_has_words():
    """Each figure has an alternative text of a sentence; one without ends the build."""
    for path in SECTIONS:
        source = path.read_text(encoding="utf-8")
        words = re.findall(r'#plot\("\w+",[^"]*alt: "([^"]+)"', source)
        assert len(words) == len(re.findall(r'#plot\("', source)), path.name
        assert all(len(each) > 40 and each.endswith(".") for each in words), path.name


def test_every_reference_is_cited():
    """Every entry of the references is cited by a section."""
    source = "".join(path.read_text(encoding="utf-8") for path in SECTIONS)
    entries = re.findall(r"(?m)^(\w+):$", (FOLDER / "references.yml").read_text(encoding="utf-8"))
    assert [name for name in entries if not re.search(rf"@{name}\b", source)] == []
    assert len(entries) >= 30
