"""The pages: none empty, nothing outside the margins; outline, metadata and fingerprint of the file."""

import numpy as np
import pypdfium2 as pdfium
import pytest

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
