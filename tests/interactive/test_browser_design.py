"""The page in a real browser: designs shaped by hand, files, screens, answers of the commands."""

import json
import math
import time

import numpy as np
import pytest

pytest.importorskip("cv2", reason="the extra `interactive` is not installed")
pytest.importorskip("uvicorn", reason="the extra `interactive` is not installed")

from studies.answers.adapters import answer_release
from studies.answers.critical import critical_load
from studies.answers.metrics import swing_frequency
from studies.answers.settings import SplineSettings
from studies.interactive.presets import PRESETS
from studies.interactive.web.browser import PATIENCE, Browser, executable
from studies.interactive.web.server import Server, Settings
from tests.interactive.films import film
from tests.interactive.pages import COUNT_SOCKETS, canvas, chosen, load, reloaded, script, turned, typed
from tests.interactive.test_browser_film import pixels

pytestmark = [pytest.mark.slow, pytest.mark.skipif(executable() is None, reason="no Chromium on the PATH")]


#: Where a clamp of a strip's end is on the page [px], and what is dragged of the design.
CLAMP = "studio.view.page(...studio.view.clamp(studio.state, {strip}, {end}))"
DESIGN = "['length', 'inclination', 'crossing_ratio'].map((name) => studio.state.values[name])"


@pytest.mark.parametrize("degrees", [0, 25])
@pytest.mark.parametrize(
    ("strip", "end", "way"), [(0, 0, (-25, 0)), (1, 1, (-15, 12))], ids=["ground", "body"]
)
def test_clamps_are_dragged(page, strip, end, way, degrees):
    """Requirement: a clamp that is dragged stays under the pointer, to 2 px, length, inclination and crossing
    following it and nothing else."""
    turned(page, degrees)
    before, others = page.ask(DESIGN), page.ask("studio.state.values.thickness")
    page.key("e")
    clamp, left = CLAMP.format(strip=strip, end=end), {"button": "left", "buttons": 1, "clickCount": 1}
    at = np.array(page.ask(clamp))
    for k, kind in enumerate(("mousePressed", *["mouseMoved"] * 20)):
        x, y = at + np.array(way) * k / 20
        page.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, **left)
    page.wait(f"(([u, v]) => Math.hypot(u - {x}, v - {y}) < 2)({clamp})")
    page.call("Input.dispatchMouseEvent", type="mouseReleased", x=x, y=y, **left)
    page.key("e")
    after = page.ask(DESIGN)
    assert np.abs(np.subtract(after, before)).min() > 1e-4
    assert page.ask("studio.state.values.thickness") == others


def test_scrubbing_shows_the_pictures():
    """Requirement: back in the last minute the picture of that moment is shown under the strips, of the same
    size, for less than 20 kB a picture; a film offers no list of cameras."""
    made = film(frames=12, samples=2)
    with Server(Settings(camera="film", source=made)) as hosted, Browser() as browser:
        load(browser, hosted)
        browser.wait("studio.ring.states.filter((s) => s.small).length > 12")
        browser.key("[")
        browser.wait("document.getElementById('when').textContent.endsWith('s ago')")
        end = time.monotonic() + PATIENCE
        while (
            not 120.0 < np.median(pixels(canvas(browser, "stage"))) < 180.0
        ):  # the table's grey, no empty grid
            assert time.monotonic() < end
        assert browser.ask("studio.view.size") == [640, 480]
        assert 0 < browser.ask("studio.ring.small.blob.size") < 20000
        assert browser.ask("document.getElementById('camera-row').hidden")  # a film has no camera to choose


def test_centres_of_a_swing_stay_together(page):
    """Requirement: the path of the centre of rotation that is drawn of a release stays within a third of the
    strips' length: where the body all but stands, and has no centre, none is drawn."""
    page.ask("document.getElementById('stage').focus()")
    turned(page, 40)
    page.key("r")
    page.wait("studio.state.steps > 300")
    page.key(" ")
    page.wait("studio.state.paused")
    drawn = np.array(page.ask("studio.ring.centres"))
    length = page.ask("studio.state.values.length")
    assert len(drawn) > 20
    assert np.ptp(drawn, axis=0).max() < length / 3.0


def test_another_design_begins_its_own_plots(page):
    """Requirement: states and centres of a former design are not drawn as those of the present one."""
    turned(page, 30)
    page.wait("studio.ring.centres.length > 3")
    typed(page, "strip width in mm", "17")
    page.wait("studio.state.values.width === 0.017")
    same = "studio.ring.states.filter((s) => s.design === studio.ring.current.design)"
    assert 0 < page.ask("studio.ring.centres.length") <= page.ask(f"{same}.length")
    assert page.ask(f"{same}.length") < page.ask("studio.ring.length")


def test_page_explains_what_is_drawn(page):
    """Requirement: the help names everything that is drawn, and the page links to the marker sheet it
    serves."""
    page.key("?")
    page.wait("document.getElementById('shortcuts').open")
    legend = page.ask("document.getElementById('legend').textContent")
    for word in ("stress", "centre of rotation", "ground marker", "load", "clamps", "standard deviation"):
        assert word in legend
    page.key("Escape")
    fetched = page.ask(
        "fetch(document.querySelector('a[download]').href).then(async (answer) =>"
        " [answer.status, (await answer.text()).slice(0, 5)])"
    )
    assert fetched == [200, "%PDF-"]


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
    reloaded(hand)  # a page without the counter, whose storage keeps what it is given


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


#: Rotation of the release [rad], and simulated time that is compared [s].
START, DURATION = math.radians(30), 4.0
#: Simulated time, rotation and energy of the states since the release.
SWING = """
studio.ring.states.filter((s) => s.mode === "released" && s.simulated > 0).map((s) => [
  s.simulated, s.pose[2], s.energy.strain + s.energy.kinetic])
"""


def test_release_is_that_of_the_command(page):
    """Requirement: a release on the page has the frequency of `release` to 0.2 %, and its energy, at all
    times, to 2 % of that at the start."""
    turned(page, round(math.degrees(START)))
    page.key("r")
    page.wait(f"studio.state.simulated > {DURATION}", 90.0)
    time, rotation, energy = np.unique(page.ask(SWING), axis=0).T
    kept = time <= DURATION
    time, rotation, energy = time[kept], rotation[kept], energy[kept]
    options = {"duration": DURATION, "start": START, "records": 400}
    known = answer_release(PRESETS["polymer"].design, SplineSettings(), **options)
    at = np.array([0.0, *time])
    stored = known.strain_energy + known.kinetic_energy
    frequency = swing_frequency(at, np.array([START, *rotation])).value
    assert frequency == pytest.approx(known.swing.value, rel=2e-3)
    assert np.abs(energy - np.interp(time, known.time, stored)).max() <= 0.02 * stored[0]


@pytest.mark.parametrize("preset", PRESETS)
def test_buckling_load_is_that_of_the_command(page, preset):
    """Requirement: the load beyond which the page says "unstable" is that of `critical-load` to 1 %, and so
    is the one that it names."""
    chosen(page, "preset", preset)
    page.wait(f"studio.state.preset === '{preset}'")
    force = critical_load(PRESETS[preset].design, SplineSettings(), direction=-math.pi / 2).force
    unstable = "studio.state.warnings.some((w) => w.code === 'unstable')"
    for part, said in ((0.99, "!"), (1.01, "")):
        typed(page, "load, downward in N", part * force)
        page.wait(f"Math.abs(studio.state.values.load - {part * force}) < {1e-3 * force} && {said}{unstable}")
    assert page.wait("studio.state.critical") == pytest.approx(force, rel=0.01)
    typed(page, "load, downward in N", 0)
    page.wait("studio.state.values.load === 0")
