"""What the tests in a browser share: opening the page, choosing in it, and scripts that look at it."""

import base64
import json
import math
import time

#: Collects, for two rounds of the film, the burned-in number of each picture that is shown and its state.
WATCH = """
window.seen = new Map();
const small = Object.assign(document.createElement("canvas"), { width: 96, height: 12 }).getContext("2d");
const watch = () => {
  if (studio.picture && studio.drawn?.seq === studio.state.seq) {
    small.drawImage(studio.picture, 0, 0);
    const data = small.getImageData(0, 6, 96, 1).data;
    let number = 0;
    for (let bit = 0; bit < 16; bit++) if (data[4 * (3 + 6 * bit)] > 127) number += 2 ** bit;
    window.seen.set(studio.state.seq, { number, marker: studio.state.placing.marker, codes:
    studio.state.warnings.map((w) => w.code),
      sight: studio.state.sight.state });
  }
  requestAnimationFrame(watch);
};
watch();
"""


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
BUSY = """
const coded = OffscreenCanvas.prototype.convertToBlob;
OffscreenCanvas.prototype.convertToBlob = async function (...words) {
  await new Promise((done) => setTimeout(done, 140));
  return coded.apply(this, words);
};
setInterval(() => { const end = performance.now() + 90; while (performance.now() < end); }, 130);
"""
#: Counts the sockets that a page opens.
COUNT_SOCKETS = """
window.sockets = 0;
window.WebSocket = class extends WebSocket {
  constructor(...words) { super(...words); window.sockets += 1; }
};
"""
#: Where the body is on the page [px].
BODY = """
(() => { const s = studio.state, box = studio.view.canvas.getBoundingClientRect();
  const [u, v] = studio.view.to(s.pose[0], s.pose[1]);
  const [width, height] = studio.view.size;
  return [box.left + u / width * box.width, box.top + v / height * box.height]; })()
"""
#: Turn of the pointer about the ground's clamps' centre from one place on the page to another.
ANGLE = """
((x0, y0, x1, y1) => { const s = studio.state.placing.clamps, v = studio.view;
  const c = [(s[0][0][0] + s[1][0][0]) / 2, (s[0][0][1] + s[0][1][1]) / 2];
  const [p, q] = [v.from(x0, y0), v.from(x1, y1)].map(([a, b]) => Math.atan2(b - c[1], a - c[0]));
  return q - p; })
"""
#: The least contrast of a text to its background on the page (WCAG 2), and where.
CONTRAST = """
(() => {
  const linear = (x) => (x / 255 <= 0.03928 ? x / 255 / 12.92 : ((x / 255 + 0.055) / 1.055) ** 2.4);
  const light = (c) => 0.2126 * linear(c[0]) + 0.7152 * linear(c[1]) + 0.0722 * linear(c[2]);
  const parse = (text) => text.match(/[\\d.]+/g).map(Number);
  const back = (e) => {
    for (; e; e = e.parentElement) {
      const colour = parse(getComputedStyle(e).backgroundColor);
      if (colour.length < 4 || colour[3] > 0) return colour;
    }
    return [255, 255, 255];
  };
  const worded = (e) => [...e.childNodes].some((n) => n.nodeType === 3 && n.textContent.trim());
  const shown = [...document.querySelectorAll("body *")].filter((e) => worded(e) && e.offsetParent
    && !e.closest(":disabled"));
  const found = shown.map((e) => {
    const pair = [light(parse(getComputedStyle(e).color)), light(back(e))];
    const ratio = (Math.max(...pair) + 0.05) / (Math.min(...pair) + 0.05);
    return [ratio, e.id || e.textContent.trim().slice(0, 20)];
  });
  return found.sort((p, q) => p[0] - q[0])[0];
})()
"""


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
