"""How long a picture takes from the camera to the screen.

    python -m tests.interactive.latency

It is measured in Chromium: from when its camera, a film, takes a picture until it is drawn with its state.
Pictures a second are those of the demo film in its first pass.
"""

import tempfile
import time
from pathlib import Path

import numpy as np

from studies.interactive.tracking.films import demo_film, encoded
from studies.interactive.web.browser import Browser
from studies.interactive.web.server import Server, Settings, warm_up
from tests.interactive.films import PERIOD, film
from tests.interactive.pages import load, script

#: Keeps in the page the milliseconds from each picture's capture until it is drawn with its state.
WATCH = script("ways")


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


def main():
    """Print the median and the 95th percentile of the whole way, and the rate."""
    warm_up()
    ways, shown = browsed()
    rate = (len(shown) - 1) / (shown[-1] - shown[0])
    print(f"{len(ways)} pictures [ms]: {np.median(ways):.1f}, {np.percentile(ways, 95):.1f}; {rate:.1f} Hz")


if __name__ == "__main__":
    main()
