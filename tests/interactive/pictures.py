"""Pictures of the page for its description: what is on the screen, by number.

python -m tests.interactive.pictures docs/pictures
"""

import json
import sys
import time
from pathlib import Path

from studies.interactive.tracking.films import demo_film
from studies.interactive.web.browser import Browser
from studies.interactive.web.server import Server, Settings, warm_up
from tests.interactive.pages import picture, script, typed

#: What the numbers stand at, from 1 on.
PARTS = (
    *("#stage", "#status", "#release", "#scrub", "#csv", "#preset", "#sliders", "#drive", "#numbers"),
    *(".gauge", "#moment", "#energy"),
)
#: Puts a number at the left of each part.
NUMBERED = script("numbered")
#: Frame of the demo film that is shown, and quality of a picture with a camera's noise in it.
FRAME, QUALITY = 68, 70
#: What is typed where.
TYPED = (("strip thickness in mm", 0.6), ("load, downward in N", 0.1), ("rotation in °", 40))


def main(folder: Path) -> None:
    """Write the pictures, as a laptop and a phone show the page."""
    warm_up()
    source = demo_film()
    with Server(Settings(camera="none")) as hosted:
        with Browser(width=1366, height=768) as browser:
            _open(browser, hosted.address)
            for name, value in TYPED:
                typed(browser, name, value)
            browser.wait("studio.state.critical !== null")  # a row of the numbers, above the next part
            time.sleep(1.0)
            browser.ask(f"{NUMBERED}({json.dumps(PARTS)})")
            _take(browser, folder / "interactive_hand.png")
        with Browser(width=390, height=844) as browser:
            browser.call("Emulation.setTouchEmulationEnabled", enabled=True)
            _open(browser, hosted.address)
            typed(browser, "rotation in °", 30)
            _take(browser, folder / "interactive_phone.png")
    film = Server(Settings(camera="film", source=source))
    with film as hosted, Browser(width=1366, height=768) as browser:
        _open(browser, hosted.address)
        browser.wait(f"studio.drawn.seq >= {FRAME}", 120.0)
        _take(browser, folder / "interactive_camera.jpg")


def _open(browser: Browser, address: str) -> None:
    browser.open(address)
    browser.wait("window.studio?.drawn ? true : false")
    browser.wait("studio.curve")


def _take(browser: Browser, path: Path) -> None:
    time.sleep(1.0)  # plots are drawn, and what was typed is answered
    path.write_bytes(picture(browser, None if path.suffix == ".png" else QUALITY))
    print(f"{path}: {path.stat().st_size / 1e3:.0f} kB")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
