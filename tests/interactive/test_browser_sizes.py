"""The page in a real browser on screens of several sizes."""

import pytest

pytest.importorskip("cv2", reason="the extra `interactive` is not installed")
pytest.importorskip("uvicorn", reason="the extra `interactive` is not installed")

from studies.interactive.web.browser import Browser, executable
from studies.interactive.web.server import Hosted, Settings
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
    with Hosted(Settings(camera="none")) as hosted, Browser(width=width, height=height) as browser:
        load(browser, hosted.server)
        assert browser.ask("document.documentElement.scrollWidth") <= width
        if width > 1200:
            for name in ("#stage", "#status", "#release", "#record", "#moment"):
                assert browser.ask(f"{inside}('{name}')"), name
        else:
            browser.ask("document.querySelector('.slider:last-child').scrollIntoView({ block: 'center' })")
        assert browser.ask(f"{inside}('#stage')")
        assert browser.ask(f"{inside}('#sliders .slider:last-child')")
