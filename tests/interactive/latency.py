"""How long a picture takes to become a state of the pivot, and which part of it how much.

    python -m tests.interactive.latency [PICTURES]
    python -m tests.interactive.latency browser

The first sends one picture of 640 x 480 px at a time over the loopback, each as soon as the state of the last
has come. The second is the whole way in Chromium: from when its camera, a film, takes a picture until it is
drawn with its state; and the pictures a second of the demo film in its first pass.
"""

import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from studies.interactive.tracking.films import demo_film, encoded
from studies.interactive.web import protocol
from studies.interactive.web.browser import Browser
from studies.interactive.web.server import Server, Settings, warm_up
from tests.interactive.films import PERIOD, film
from tests.interactive.pages import load, script
from tests.interactive.sockets import answer, opened

#: Parts of the way through the server that it times itself; the rest is the sending's, the loopback's, the
#: threads' and this client's.
PARTS = ("track", "solve")
#: Keeps in the page the milliseconds from each picture's capture until it is drawn with its state.
WATCH = script("ways")


def measured(count):
    """Milliseconds (count, 4) of `count` pictures: the parts, the rest, and the whole."""
    pictures = [picture.tobytes() for picture in film(frames=PERIOD, samples=3)]
    states, wholes = [], []
    with Server(Settings(camera="browser")) as hosted, opened(hosted) as socket:
        for k in range(count):
            head = protocol.HEADER.pack(protocol.PICTURE, 1, k, 640, 480, 40.0 * k)
            begin = time.perf_counter()
            socket.send(head + pictures[k % PERIOD])
            while (state := answer(socket))["seq"] != k:
                pass
            wholes.append(1e3 * (time.perf_counter() - begin))
            states.append(state)
    parts, whole = [[s["track_ms"], s["solve_ms"]] for s in states], np.array(wholes)
    return np.column_stack((parts, whole - np.sum(parts, axis=1), whole))


def browsed(seconds=20.0):
    """Milliseconds (P,) of the whole way of pictures in a browser, and times (F,) [s] at which frames of the
    demo film are drawn in its first pass."""
    with tempfile.TemporaryDirectory() as folder:
        camera = Path(folder) / "film.mjpeg"
        camera.write_bytes(b"".join(map(encoded, film(frames=PERIOD, samples=3))))
        with Server(Settings(camera="browser")) as hosted, Browser(film=camera) as browser:
            browser.call("Page.addScriptToEvaluateOnNewDocument", source=WATCH)
            load(browser, hosted)
            time.sleep(seconds)
            ways = browser.ask("window.ways")
    with Server(Settings(camera="film", source=demo_film())) as hosted, Browser() as browser:
        load(browser, hosted)
        browser.wait("studio.state.seq >= 290", 600.0)
        shown = browser.ask("studio.ring.states.filter((s) => s.track_ms !== undefined).map((s) => s.at)")
    return np.array(ways), np.array(shown)


def main(*words):
    """Print the median and the 95th percentile of each part, or of the whole way in a browser."""
    warm_up()
    if words == ("browser",):
        ways, shown = browsed()
        rate = (len(shown) - 1) / (shown[-1] - shown[0])
        print(
            f"{len(ways)} pictures [ms]: {np.median(ways):.1f}, {np.percentile(ways, 95):.1f}; {rate:.1f} Hz"
        )
        return
    rows = measured(*map(int, words or ("250",)))
    print(f"{len(rows)} pictures [ms]: median and 95th percentile")
    for name, column in zip((*PARTS, "rest", "whole"), rows.T, strict=True):
        print(f"{name:8}{np.median(column):8.2f}{np.percentile(column, 95):8.2f}")


if __name__ == "__main__":
    main(*sys.argv[1:])
