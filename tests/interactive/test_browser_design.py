"""The page in a real browser: the design shaped by hand, loads, and pictures that are kept."""

import time

import numpy as np
import pytest

pytest.importorskip("cv2", reason="the extra `interactive` is not installed")
pytest.importorskip("uvicorn", reason="the extra `interactive` is not installed")

from studies.interactive.web.browser import PATIENCE, Browser, executable
from studies.interactive.web.server import Server, Settings
from tests.interactive.films import film
from tests.interactive.pages import canvas, load, turned, typed
from tests.interactive.test_browser_film import pixels

pytestmark = [pytest.mark.slow, pytest.mark.skipif(executable() is None, reason="no Chromium on the PATH")]


#: Where a clamp of a strip's end is on the page [px], and what is dragged of the design.
CLAMP = "studio.view.page(...studio.view.clamp(studio.state, {strip}, {end}))"
DESIGN = "['length', 'inclination', 'crossing_ratio'].map((name) => studio.state.values[name])"


@pytest.mark.parametrize("degrees", [0, 25])
@pytest.mark.parametrize(
    ("strip", "end", "way"), [(0, 0, (-25, 0)), (1, 1, (-15, 12))], ids=["ground", "body"]
)
def test_clamps_are_dragged(page, strip, end, way, degrees):
    """Requirement: a clamp that is dragged stays under the pointer, to 2 px, length, inclination and crossing
    following it and nothing else."""
    turned(page, degrees)
    before, others = page.ask(DESIGN), page.ask("studio.state.values.thickness")
    page.key("e")
    clamp, left = CLAMP.format(strip=strip, end=end), {"button": "left", "buttons": 1, "clickCount": 1}
    at = np.array(page.ask(clamp))
    for k, kind in enumerate(("mousePressed", *["mouseMoved"] * 20)):
        x, y = at + np.array(way) * k / 20
        page.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, **left)
    page.wait(f"(([u, v]) => Math.hypot(u - {x}, v - {y}) < 2)({clamp})")
    page.call("Input.dispatchMouseEvent", type="mouseReleased", x=x, y=y, **left)
    page.key("e")
    after = page.ask(DESIGN)
    assert np.abs(np.subtract(after, before)).min() > 1e-4
    assert page.ask("studio.state.values.thickness") == others


def test_scrubbing_shows_the_pictures():
    """Requirement: back in the last minute the picture of that moment is shown under the strips, of the same
    size, for less than 20 kB a picture; a film offers no list of cameras."""
    made = film(frames=12, samples=2)
    with Server(Settings(camera="film", source=made)) as hosted, Browser() as browser:
        load(browser, hosted)
        browser.wait("studio.ring.states.filter((s) => s.small).length > 12")
        browser.key("[")
        browser.wait("document.getElementById('when').textContent.endsWith('s ago')")
        end = time.monotonic() + PATIENCE
        while (
            not 120.0 < np.median(pixels(canvas(browser, "stage"))) < 180.0
        ):  # the table's grey, no empty grid
            assert time.monotonic() < end
        assert browser.ask("studio.view.size") == [640, 480]
        assert 0 < browser.ask("studio.ring.small.blob.size") < 20000
        assert browser.ask("document.getElementById('camera-row').hidden")  # a film has no camera to choose


def test_centres_of_a_swing_stay_together(page):
    """Requirement: the path of the centre of rotation that is drawn of a release stays within a third of the
    strips' length: where the body all but stands, and has no centre, none is drawn."""
    page.ask("document.getElementById('stage').focus()")
    turned(page, 40)
    page.key("r")
    page.wait("studio.state.steps > 300")
    page.key(" ")
    page.wait("studio.state.paused")
    drawn = np.array(page.ask("studio.ring.centres"))
    length = page.ask("studio.state.values.length")
    assert len(drawn) > 20
    assert np.ptp(drawn, axis=0).max() < length / 3.0


def test_another_design_begins_its_own_plots(page):
    """Requirement: states and centres of a former design are not drawn as those of the present one."""
    turned(page, 30)
    page.wait("studio.ring.centres.length > 3")
    typed(page, "strip width in mm", "17")
    page.wait("studio.state.values.width === 0.017")
    same = "studio.ring.states.filter((s) => s.design === studio.ring.current.design)"
    assert 0 < page.ask("studio.ring.centres.length") <= page.ask(f"{same}.length")
    assert page.ask(f"{same}.length") < page.ask("studio.ring.length")


def test_page_explains_what_is_drawn(page):
    """Requirement: the help names everything that is drawn, and the page links to the marker sheet it
    serves."""
    page.key("?")
    page.wait("document.getElementById('shortcuts').open")
    legend = page.ask("document.getElementById('legend').textContent")
    for word in ("stress", "centre of rotation", "ground marker", "load", "clamps", "standard deviation"):
        assert word in legend
    page.key("Escape")
    fetched = page.ask(
        "fetch(document.querySelector('a[download]').href).then(async (answer) =>"
        " [answer.status, (await answer.text()).slice(0, 5)])"
    )
    assert fetched == [200, "%PDF-"]
