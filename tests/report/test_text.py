"""The text types no number, quotes only what there is, as the tables have it, with its digits."""

import re

import numpy as np
import pypdfium2 as pdfium
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


#: Of a page of A4 [pt]: nothing is nearer to the edge than the running lines leave.
CLEAR = 40.0
#: Share of the page that at least is not white.
LEAST_INK = 0.005
A4 = (595.3, 841.9)


def _pages(pdf, scale):
    """Yield the pages as grey pictures, 0 black to 255 white."""
    document = pdfium.PdfDocument(pdf)
    try:
        for page in document:
            yield page.render(scale=scale, grayscale=True).to_numpy().squeeze()
    finally:
        document.close()


def _faults(picture, scale):
    """Return what is wrong with the picture of a page."""
    ink = picture < 200
    faults = [] if ink.mean() > LEAST_INK else [f"ink on {ink.mean():.4f} of the page"]
    clear = round(CLEAR * scale)
    inside = np.zeros_like(ink)
    inside[clear:-clear, clear:-clear] = True
    return faults + (["ink outside the margins"] if (ink & ~inside).any() else [])


def test_pages_are_filled_and_keep_their_margins(pdf):
    """Every page renders, has ink on it, and none near its edges."""
    faults = {number: _faults(page, 0.5) for number, page in enumerate(_pages(pdf, 0.5), start=1)}
    assert len(faults) > 10
    assert {number: found for number, found in faults.items() if found} == {}


def _filled(picture):
    """Return how far down between the margins a page has ink [1], without header and footer."""
    rows = np.flatnonzero((picture < 200).any(axis=1))
    top, bottom = 0.09 * len(picture), 0.925 * len(picture)
    inside = rows[(rows > top) & (rows < bottom)]
    return 0.0 if not inside.size else (inside[-1] - top) / (bottom - top)


@pytest.mark.slow
def test_pages_are_filled_and_few(pdf):
    """No page ends above two thirds of its height, but for the last of the part and of the supplement, and
    neither is longer than a reader bears: twelve pages before the references, and twenty in all."""
    document = pdfium.PdfDocument(pdf)
    try:
        pages = {mark.get_title(): mark.get_dest().get_index() for mark in document.get_toc()}
    finally:
        document.close()
    supplement = next(page for title, page in pages.items() if title.startswith("S1"))
    short = [n for n, page in enumerate(_pages(pdf, 0.5), start=1) if _filled(page) < 2.0 / 3.0]
    length = len(list(_pages(pdf, 0.1)))
    assert set(short) <= {supplement, length}
    assert pages["References"] <= 12
    assert length <= 20


def test_file_says_what_it_is(content, pdf):
    """Title, date and fingerprint stand in the metadata; the outline has every section; pages are A4."""
    document = pdfium.PdfDocument(pdf)
    try:
        facts = document.get_metadata_dict()
        titles = [bookmark.get_title() for bookmark in document.get_toc()]
        sizes = {tuple(round(length, 1) for length in page.get_size()) for page in document}
    finally:
        document.close()
    assert facts["Title"].startswith("Validation of the dynamic-spline")
    assert f"fingerprint {content['fingerprint']}" in facts["Keywords"]
    assert content["date"].replace("-", "") in facts["CreationDate"]
    assert sizes == {A4}
    for part in (
        "For a designer",
        "Formulation",
        "paper's claims",
        "costs",
        "Hard cases",
        "Limits",
        "Misprints",
        "Provenance",
    ):
        assert any(part in title for title in titles), part
