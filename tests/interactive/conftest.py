"""A server without pictures, and its page in a browser, for the tests of a module."""

import pytest


@pytest.fixture(scope="module")
def server():
    """A server without pictures."""
    pytest.importorskip("cv2", reason="the extra `interactive` is not installed")
    pytest.importorskip("uvicorn", reason="the extra `interactive` is not installed")
    from studies.interactive.web.server import Server, Settings

    with Server(Settings(camera="none")) as hosted:
        yield hosted


@pytest.fixture(scope="module")
def hand(server):
    """A page without a camera, and its browser."""
    from studies.interactive.web.browser import Browser
    from tests.interactive.pages import load

    with Browser() as browser:
        load(browser, server)
        yield browser


@pytest.fixture
def page(hand):
    """The same page at rest, with nothing held against it."""
    from tests.interactive.pages import chosen

    hand.ask("document.activeElement.blur()")
    for key in ("Escape", "l", "0"):
        hand.key(key)
    chosen(hand, "preset", "polymer")
    chosen(hand, "drive", "rotation")
    hand.wait("studio.state.mode === 'held' && studio.state.displacement[2] === 0")
    hand.wait("studio.state.drive === 'rotation' && studio.state.preset === 'polymer'")
    # the note is of the preset's own values: what a former test changed is back
    hand.wait("document.getElementById('preset-note').textContent !== ''")
    return hand
