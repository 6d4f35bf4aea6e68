"""What the tests in a browser share: opening the page, choosing in it, and scripts that look at it."""

import base64
import json
import math
import time
from pathlib import Path


def script(name: str) -> str:
    """Return a script that looks at the page or changes it, by its name in the folder `scripts`."""
    path = Path(__file__).with_name("scripts") / f"{name}.js"
    return path.read_text(encoding="utf-8").rstrip()


#: Collects, for two rounds of the film, the burned-in number of each picture that is shown and its state.
WATCH = script("seen")


def load(browser, server):
    """Open the page and wait for its first state."""
    begin = time.monotonic()
    browser.open(server.address)
    browser.wait("window.studio?.drawn ? true : false", 20.0)
    return time.monotonic() - begin


def reloaded(browser):
    """Load the page again and wait for the first state of the new one."""
    browser.ask("window.former = true")
    browser.call("Page.reload")
    browser.wait("!window.former && window.studio?.drawn ? true : false")


def chosen(browser, name, value):
    """Choose a value of the list, or type it into the box, of that id."""
    browser.ask(
        f"(e => {{ e.value = {json.dumps(value)}; e.dispatchEvent(new Event('change')); }})"
        f"(document.getElementById('{name}'))"
    )


def typed(browser, label, value):
    """Type a value into the box, or move the slider, of that label."""
    browser.ask(
        f"(e => {{ e.value = '{value}'; e.dispatchEvent(new Event('change')); }})"
        f"(document.querySelector(\"input[aria-label='{label}']\"))"
    )


def turned(browser, degrees):
    """Hold the body at rest, then turn it by the keyboard, five degrees a key."""
    browser.key("0")
    browser.wait("studio.state.mode === 'held' && studio.state.pose[2] === 0")
    for _ in range(degrees // 5):
        browser.key("ArrowUp")
    browser.wait(f"Math.abs(studio.state.pose[2] - {math.radians(degrees)}) < 1e-9")


#: Keeps the page busy most of the time, and codes what is kept of a picture late: a busy machine.
BUSY = script("busy")
#: Counts the sockets that a page opens.
COUNT_SOCKETS = script("sockets")
#: Where the body is on the page [px].
BODY = script("body")
#: Turn of the pointer about the ground's clamps' centre from one place on the page to another.
ANGLE = script("angle")
#: The least contrast of a text to its background on the page (WCAG 2), and where.
CONTRAST = script("contrast")


def drag(browser, places):
    """Press the mouse at the first place [px], move through the others and release at the last."""
    left = {"button": "left", "buttons": 1, "clickCount": 1}
    (x, y), *others = places
    browser.call("Input.dispatchMouseEvent", type="mouseMoved", x=x, y=y)
    browser.call("Input.dispatchMouseEvent", type="mousePressed", x=x, y=y, **left)
    for x, y in others:
        browser.call("Input.dispatchMouseEvent", type="mouseMoved", x=x, y=y, button="left", buttons=1)
    browser.call("Input.dispatchMouseEvent", type="mouseReleased", x=x, y=y, button="left", clickCount=1)


def touch(browser, kind, points):
    """Send a touch event, "touchStart", "touchMove" or "touchEnd", with the fingers' places [px]."""
    fingers = [{"x": x, "y": y, "id": k} for k, (x, y) in enumerate(points)]
    browser.call("Input.dispatchTouchEvent", type=kind, touchPoints=fingers)


def picture(browser, quality=None):
    """Return a PNG of the page as it is shown, or a JPEG of that quality."""
    kind = {} if quality is None else {"format": "jpeg", "quality": quality}
    return base64.b64decode(browser.call("Page.captureScreenshot", **kind)["data"])


def canvas(browser, name):
    """Return a PNG of the canvas with that id, pixel by pixel."""
    data = browser.ask(f"document.getElementById({json.dumps(name)}).toDataURL('image/png')")
    return base64.b64decode(data.partition(",")[2])
