"""The page in a real browser: what it saves as files, opens and keeps."""

import json
import time

import pytest

pytest.importorskip("cv2", reason="the extra `interactive` is not installed")
pytest.importorskip("uvicorn", reason="the extra `interactive` is not installed")

from studies.interactive.web.browser import executable
from tests.interactive.pages import COUNT_SOCKETS

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
    page.wait("studio.state.pose[2] > 0.08 && JSON.parse(sessionStorage.design).pose[2] > 0.08")
    page.call("Page.reload")
    time.sleep(0.5)
    page.wait("window.studio?.state?.values.width === 0.02 && studio.state.pose[2] > 0.08")


def test_video_is_recorded(page):
    """Requirement: a key begins a video of the picture, with its words, and ends it as a file."""
    page.key("f")
    page.wait("studio.view.caption && document.getElementById('video').textContent.startsWith('Stop')")
    for _ in range(4):
        page.key("ArrowUp")
    page.key("r")
    page.wait("studio.video.kept > 1000")
    page.key("f")
    page.wait("studio.saved?.name === 'pivot.webm' && studio.saved.size > 1000")
    assert not page.ask("studio.view.caption")
    assert page.ask("studio.errors") == []


def test_design_that_is_refused_ends_the_calls(hand):
    """Requirement: a kept design that the server refuses does not make the page call again and again."""
    design = {"preset": "polymer", "values": {"width": "x" * 6000}, "drive": "rotation", "pose": [0, 0, 0]}
    hand.ask(f"window.sessionStorage.setItem('design', {json.dumps(json.dumps(design))})")
    stop = "Storage.prototype.setItem = () => {};"
    counted = hand.call("Page.addScriptToEvaluateOnNewDocument", source=COUNT_SOCKETS + stop)
    hand.call("Page.reload")
    time.sleep(5.0)
    assert 1 <= hand.ask("window.sockets") <= 3
    hand.ask("sessionStorage.removeItem('design')")
    hand.call("Page.removeScriptToEvaluateOnNewDocument", **counted)
