"""The page in a real browser: what it saves as files, opens and keeps, and screens of several sizes."""

import json
import time

import pytest

pytest.importorskip("cv2", reason="the extra `interactive` is not installed")
pytest.importorskip("uvicorn", reason="the extra `interactive` is not installed")

from studies.interactive.web.browser import Browser, executable
from studies.interactive.web.server import Server, Settings
from tests.interactive.pages import COUNT_SOCKETS, load, reloaded, script

pytestmark = [pytest.mark.slow, pytest.mark.skipif(executable() is None, reason="no Chromium on the PATH")]


def give(browser, name, text):
    """Choose a file with that text in the file input of that id."""
    browser.ask(
        f"(text => {{ const d = new DataTransfer(); d.items.add(new File([text], 'file'));"
        f"const f = document.getElementById('{name}'); f.files = d.files;"
        f"f.dispatchEvent(new Event('change')); }})({json.dumps(text)})"
    )


def test_design_is_saved_opened_and_kept(page):
    """Requirement: the design is saved as a case file and opened from one, and a page that is loaded again
    goes on with design and pose."""
    page.key("k")
    text = page.wait("studio.saved?.name === 'pivot.toml' && studio.saved.text")
    give(page, "case", text.replace("width_m = 0.01", "width_m = 0.02"))
    page.wait("studio.state.preset === 'own' && studio.state.values.width === 0.02")
    page.key("ArrowUp")
    page.wait("studio.state.pose[2] > 0.08 && JSON.parse(sessionStorage.design ?? 'null')?.pose[2] > 0.08")
    reloaded(page)
    page.wait("studio.state.values.width === 0.02 && studio.state.pose[2] > 0.08")


def test_design_that_is_refused_ends_the_calls(hand):
    """Requirement: a kept design that the server refuses does not make the page call again and again."""
    design = {"preset": "polymer", "values": {"width": "x" * 6000}, "drive": "rotation", "pose": [0, 0, 0]}
    hand.ask(f"window.sessionStorage.setItem('design', {json.dumps(json.dumps(design))})")
    stop = "Storage.prototype.setItem = () => {};"
    counted = hand.call("Page.addScriptToEvaluateOnNewDocument", source=COUNT_SOCKETS + stop)
    hand.ask("window.former = true")
    hand.call("Page.reload")
    hand.wait("!window.former && window.sockets >= 1")
    time.sleep(5.0)
    assert hand.ask("window.sockets") <= 3
    hand.ask("sessionStorage.removeItem('design')")
    hand.call("Page.removeScriptToEvaluateOnNewDocument", **counted)


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
        assert browser.ask("document.getElementById('mode').getBoundingClientRect().width") > 0
        if width > 1200:
            for name in ("#stage", "#status", "#release", "#csv", "#moment"):
                assert browser.ask(f"{inside}('{name}')"), name
        else:
            browser.ask("document.querySelector('.slider:last-child').scrollIntoView({ block: 'center' })")
        assert browser.ask(f"{inside}('#stage')")
        assert browser.ask(f"{inside}('#sliders .slider:last-child')")


#: Smaller sides [px] of what a finger is to hit, by what it is.
TARGETS = script("targets")


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
