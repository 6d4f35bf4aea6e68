"""The page in a real browser on screens of several sizes."""

import pytest

pytest.importorskip("cv2", reason="the extra `interactive` is not installed")
pytest.importorskip("uvicorn", reason="the extra `interactive` is not installed")

from studies.interactive.web.browser import Browser, executable
from studies.interactive.web.server import Server, Settings
from tests.interactive.pages import load

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(executable() is None, reason="no Chromium on the PATH"),
]


@pytest.mark.parametrize(("width", "height"), [(1366, 768), (820, 1180), (390, 844)])
def test_pivot_and_sliders_are_seen_together(width, height):
    """Requirement: on laptop, tablet and phone nothing is wider than the screen, and the picture is in sight
    while the last slider is; on a laptop with status, buttons and all sliders."""
    inside = (
        "(id => { const r = document.querySelector(id).getBoundingClientRect();"
        " return r.top >= 0 && r.bottom <= innerHeight && r.right <= innerWidth; })"
    )
    with Server(Settings(camera="none")) as hosted, Browser(width=width, height=height) as browser:
        load(browser, hosted)
        assert browser.ask("document.documentElement.scrollWidth") <= width
        if width > 1200:
            for name in ("#stage", "#status", "#release", "#record", "#moment"):
                assert browser.ask(f"{inside}('{name}')"), name
        else:
            browser.ask("document.querySelector('.slider:last-child').scrollIntoView({ block: 'center' })")
        assert browser.ask(f"{inside}('#stage')")
        assert browser.ask(f"{inside}('#sliders .slider:last-child')")


#: Smaller sides [px] of what a finger is to hit, by what it is.
TARGETS = """
const all = [...document.querySelectorAll("button, select, input:not([type=file])")];
all.filter((e) => e.offsetParent).map((e) => {
  const { width, height } = e.getBoundingClientRect();
  return [e.type, e.id || e.ariaLabel, Math.min(width, height), width];
})
"""


def test_fingers_hit_what_they_should():
    """Requirement: on a phone buttons and choices are at least 44 px high, everything else at least 24 px
    (WCAG 2.2), and a slider is as wide as the screen allows."""
    with Server(Settings(camera="none")) as hosted, Browser(width=390, height=844) as browser:
        browser.call("Emulation.setTouchEmulationEnabled", enabled=True)
        load(browser, hosted)
        targets = browser.ask(TARGETS)
    assert len(targets) > 40
    for kind, name, side, width in targets:
        assert side >= {"submit": 44.0, "select-one": 44.0}.get(kind, 24.0), name
        assert kind != "range" or name == "scrub" or width >= 300.0, name
