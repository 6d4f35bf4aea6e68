"""The text types no number, quotes only what there is, as the tables have it, with its digits."""

import re

import pytest

from report.build import quotable
from report.forms import count, decade, degrees, percent, seconds, signed_percent, significant, times, unit
from studies.commands import results
from studies.record.source import ROOT
from studies.record.store import Store
from studies.registry import STUDIES, study_of
from studies.stability.verdict import COLUMNS, DEFAULT
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


@pytest.mark.parametrize(
    ("written", "expected"),
    [
        (significant(0.0), "0"),
        (significant(0.0996), "0.10"),
        (significant(1033.01, 4), "1033"),
        (significant(3.21e-5), "3.2 × 10⁻⁵"),
        (significant(1.4574e10, 3), "1.46 × 10¹⁰"),
        (decade(2e-4), "2 × 10⁻⁴"),
        (decade(0.1), "10⁻¹"),
        (percent(0.0053026), "0.53 %"),
        (percent(-5.6e-6), "−5.6 × 10⁻⁶"),
        (percent(4.3204), "432 %"),
        (signed_percent(0.91), "+91 %"),
        (times(26.18), "26 ×"),
        (count(863), "863"),
        (count(1000000), "1 000 000"),
        (seconds(0.021314), "21 ms"),
        (seconds(7.3e-5), "73 µs"),
        (seconds(5e-9), "5.0 ns"),
        (degrees(1.57079632679), "90°"),
        (unit("GPa", 3, 1e-9)(206e9), "206 GPa"),
    ],
)
def test_number_is_written_as_it_should(written, expected):
    """Digits, minus signs, powers of ten and units come out as a reader expects them."""
    assert written.replace("\u00a0", " ").replace("\u202f", " ") == expected


def test_part_of_a_whole_is_no_count():
    """What is counted is whole."""
    with pytest.raises(ValueError, match=r"2\.5 is not a whole number"):
        count(2.5)


def _stored(study, name):
    return Store().load_tables(study)[name]


def test_default_is_counted_by_itself():
    """Requirement: cases of the default are those with its settings; settings that vary are counted apart."""
    assert DEFAULT not in set(_stored("stability/axial_modes", "outcomes")["model"])
    assert COLUMNS[DEFAULT].control_points is None


def test_families_state_their_criterion(content):
    """Requirement: criterion and tolerance stand beside the outcomes of every family."""
    for row in content["listings"]["families"]["rows"]:
        assert re.search(r"%|10[⁻¹²]", row[1]), row[0]


@pytest.mark.parametrize("fact", ["locking.torque", "locking.stiffness", "elements.twenty.torque"])
def test_readme_and_report_print_the_same_numbers(content, fact):
    """Requirement: what README.md says of the paper's choices is what the report says, digit by digit."""
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    assert content["facts"][fact].replace("\u00a0", " ") in readme
