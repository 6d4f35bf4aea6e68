"""The page in a real browser without a window and without a camera: mouse, touch and keys."""

import re
import time

import pytest

pytest.importorskip("cv2", reason="the extra `interactive` is not installed")
pytest.importorskip("uvicorn", reason="the extra `interactive` is not installed")

from studies.interactive.mechanics import Mechanics
from studies.interactive.web.browser import executable
from tests.interactive.pages import ANGLE, BODY, CONTRAST, chosen, drag, script, touch, typed

pytestmark = [pytest.mark.slow, pytest.mark.skipif(executable() is None, reason="no Chromium on the PATH")]


def test_drag_turns_the_body(page):
    """Requirement: 60 mouse events turn the body by the pointer's angle, exact to 0.05 mm at the body, and an
    answer comes within 60 ms."""
    page.ask("studio.trips = []")
    x, y = page.ask(BODY)
    way = [(x - 2 * k, y + 0.3 * k) for k in range(61)]
    wanted = page.ask(f"{ANGLE}({way[0][0]}, {way[0][1]}, {way[-1][0]}, {way[-1][1]})")
    drag(page, way)
    page.wait(f"Math.abs(studio.state.pose[2] - {wanted}) * 0.03 < 5e-5")
    known = page.ask("studio.trips.length")
    for k in range(10):
        page.key("ArrowLeft")
        page.wait(f"studio.trips.length > {known + k}")
    trips = page.ask("studio.trips")
    assert min(trips) <= 60.0  # the least of them: a loaded machine delays the others


def test_touch_moves_with_two_fingers(page):
    """Requirement: two fingers move and turn the body where the hand holds its whole pose."""
    chosen(page, "drive", "pose")
    page.wait("studio.state.drive === 'pose'")
    x, y = page.ask(BODY)
    touch(page, "touchStart", [(x - 60, y), (x + 60, y)])
    for k in range(1, 6):
        touch(page, "touchMove", [(x - 60, y + k), (x + 60, y - k)])
    page.wait("Math.abs(studio.state.pose[2] - 2 * 5 / 120) < 0.005")
    touch(page, "touchEnd", [])


def test_swipe_beside_the_body_leaves_it(page):
    """Requirement: a finger that moves beside the body does not turn it; on the body it does."""
    for beside, turns in ((150, False), (0, True)):
        x, y = page.ask(BODY)
        touch(page, "touchStart", [(x + beside, y - beside)])
        for k in range(1, 6):
            touch(page, "touchMove", [(x + beside - 4 * k, y - beside)])
        touch(page, "touchEnd", [])
        page.ask("new Promise((done) => setTimeout(done, 200))")
        assert (page.ask("studio.state.displacement[2]") != 0) == turns


def test_keyboard_alone_does_everything(page):
    """Requirement: turn, move, release, pause, catch, export, list of keys and scrubbing need no mouse."""
    for _ in range(6):
        page.key("ArrowLeft")
    page.wait("Math.abs(studio.state.pose[2] - 6 * Math.PI / 180) < 1e-9")
    page.key("ArrowUp")
    page.wait("Math.abs(studio.state.pose[2] - 11 * Math.PI / 180) < 1e-9")
    page.key("r")
    page.wait("studio.state.mode === 'released' && studio.state.steps > 8")
    page.key(" ")
    page.wait("studio.state.paused")
    page.key("[")
    assert page.ask("document.getElementById('when').textContent").endswith("s ago")
    page.key("l")
    assert page.ask("document.getElementById('when').textContent") == "live"
    page.key("r")
    page.wait("studio.state.mode === 'held'")
    page.key("c")
    saved = page.wait("studio.saved?.name === 'pivot.csv' && studio.saved.text")
    header, *rows = saved.strip().split("\n")
    assert header.startswith("time_s,mode,simulated_s,x_m,y_m,rotation_rad,force_x_N")
    assert len(rows) > 10
    assert {len(row.split(",")) for row in rows} == {len(header.split(","))}
    page.key("p")
    page.wait("studio.saved.name === 'pivot.png' && studio.saved.size > 1000")
    page.key("?", shift=True)
    page.wait("document.getElementById('shortcuts').open")
    assert page.ask("document.querySelectorAll('#keys tr').length") >= 15
    page.key("Escape")
    assert page.ask("studio.errors") == []


def test_everything_is_reached_by_tab(page):
    """Requirement: the tabulator reaches picture and every button, each with a focus that is seen and a
    name."""
    page.ask("document.body.focus()")
    reached = set()
    for _ in range(70):
        page.key("Tab")
        reached.add(page.ask("document.activeElement.id"))
    wanted = "stage release reset csv png save open preset drive"
    assert set(wanted.split()) - reached == set()
    page.call("Accessibility.enable")
    nodes = page.call("Accessibility.getFullAXTree")["nodes"]
    roles = {"button", "slider", "spinbutton", "combobox", "checkbox", "application"}
    nameless = [
        node["role"]["value"]
        for node in nodes
        if not node.get("ignored") and node["role"]["value"] in roles and not node["name"]["value"]
    ]
    assert nameless == []


def test_contrast_is_enough(page):
    """Requirement: every text has a contrast of at least 4.5 to 1 (WCAG AA), in the dark, in the light and in
    the user's own colours, and of 7 to 1 (AAA) for who asks for more."""
    for name, value, wanted in (
        ("prefers-color-scheme", "dark", 4.5),
        ("prefers-color-scheme", "light", 4.5),
        ("prefers-contrast", "more", 7.0),
        ("forced-colors", "active", 4.5),
    ):
        page.call("Emulation.setEmulatedMedia", features=[{"name": name, "value": value}])
        least, where = page.ask(CONTRAST)
        assert least >= wanted, (value, where)
    page.call("Emulation.setEmulatedMedia", features=[])


def test_slow_motion_says_so(page, monkeypatch):
    """Requirement: a motion that cannot keep up says on the picture how slow it runs."""
    advance = Mechanics.advance

    def slow(mechanics, steps):
        time.sleep(0.03 * steps)
        return advance(mechanics, steps)

    monkeypatch.setattr(Mechanics, "advance", slow)
    page.key("ArrowUp")
    page.key("r")
    text = page.wait("document.getElementById('pace').textContent")
    assert re.search(r"runs at 0\.\d+ of real time", text)
    page.key("0")
    page.wait("!document.getElementById('pace').textContent")


#: Elements of the page that take the focus, by what they are.
FOCUSED = {
    "slider": "input[aria-label='strip thickness, slider']",
    "list": "#drive",
    "box": "#shape",
    "button": "#csv",
    "scrubber": "#scrub",
}


@pytest.mark.parametrize("element", FOCUSED)
def test_keys_work_wherever_the_focus_is(page, element):
    """Requirement: R releases and catches, and M chooses what is prescribed, while a slider, a list, a box or
    a button has the focus."""
    page.ask(f'document.querySelector("{FOCUSED[element]}").focus()')
    page.key("m")
    page.wait("studio.state.drive === 'pose'")
    page.key("r")
    page.wait("studio.state.mode === 'released'")
    page.key("r")
    page.wait("studio.state.mode === 'held'")
    assert page.ask(f'document.activeElement === document.querySelector("{FOCUSED[element]}")')


def test_keys_are_letters_in_a_text_field(page):
    """Requirement: in a box for numbers no key does anything else."""
    page.ask("document.querySelector(\"input[aria-label='strip width in mm']\").focus()")
    page.key("r")
    page.key("ArrowUp")
    page.ask("new Promise((done) => setTimeout(done, 200))")
    assert page.ask("studio.state.mode") == "held"
    assert page.ask("studio.state.displacement[2]") == 0
    typed(page, "strip width in mm", "10")  # an arrow steps the number, which a letter may have emptied
    page.wait("studio.state.values.width === 0.01")


@pytest.mark.parametrize("name", ["silicon_pivot", "large_steel_pivot", "cantilever_with_body"])
def test_picture_fits_every_design(page, name):
    """Requirement: a design of 1 mm, of 0.3 m, or with one strip fills the picture, whatever it is; it can be
    zoomed and fitted again, and no number is infinite."""
    chosen(page, "preset", name)
    page.wait(f"studio.state.preset === '{name}' && studio.drawn.t === studio.state.t")
    size = "Math.hypot(...[0, 1].map((i) => view.to(...ends[0])[i] - view.to(...ends[1])[i])) / view.size[1]"
    length = (
        f"(() => {{ const view = studio.view, ends = studio.state.placing.clamps[0]; return {size}; }})()"
    )
    fitted = page.ask(length)
    assert 0.2 < fitted < 0.7
    page.key("+")
    assert page.ask(length) == pytest.approx(1.25 * fitted)
    page.key("h")
    assert page.ask(length) == pytest.approx(fitted)
    assert not re.search("Infinity|NaN|undefined|null", page.ask("document.body.textContent"))


def test_unstable_load_is_named_on_the_page(page):
    """Requirement: beyond its critical load the page shows a message with the load, the negative
    stiffness, and that contact is not modelled; released, the body does not fall through the ground, and the
    page gives the reason."""
    typed(page, "load, downward in N", "0.4")
    text = page.wait("(t => /critical load/.test(t) && t)(document.getElementById('faults').textContent)")
    assert re.search(r"Unstable under this load.*Contact.*not modelled.*283 mN.*stiffness -", text)
    typed(page, "load, downward in N", "1.4")
    page.wait("studio.state.values.load === 1.4")
    page.key("ArrowLeft")
    page.key("r")
    page.wait("/fell to the ground/.test(document.getElementById('faults').textContent)")
    assert page.ask("studio.state.paused && studio.state.pose[1] > 0")
    page.key("0")
    typed(page, "load, downward in N", "0")
    page.wait("studio.state.values.load === 0")


def test_parameters_are_typed_in_their_units(page):
    """Requirement: a value typed in its unit reaches the session in SI; one beyond the slider's ends is named
    and taken back."""
    typed(page, "strip thickness in mm", "0.8")
    page.wait("Math.abs(studio.state.values.thickness - 8e-4) < 1e-12")
    typed(page, "strip thickness in mm", "8000")
    said = page.ask("document.getElementById('note').textContent")
    assert said == "strip thickness: from 0.0001 to 1000 mm."
    assert page.ask("document.querySelector(\"input[aria-label='strip thickness in mm']\").value") == "0.8"


#: Drags a slider to and fro, 60 steps a second, for two seconds, and on until fifteen states have come of it;
#: tells how many have, after 45 s at most.
SLIDE = script("slide")


def test_sliders_are_live(page):
    """Requirement: the pivot follows a slider while it is dragged, the former design's curve staying as a
    ghost."""
    ratio = "studio.curve.moment[1] / studio.curve.rotation[1] / studio.state.stiffness"
    page.wait(f"Math.abs({ratio} - 1) < 0.05")  # the curve is that of this design
    moment = page.ask("studio.curve.moment.at(-1)")
    assert page.ask(SLIDE) >= 15
    page.wait("studio.curve.moment.at(-1) > 2 * studio.ghost.moment.at(-1)")
    assert page.ask("studio.ghost.moment.at(-1)") == moment
    page.wait(
        "studio.state.values.thickness === JSON.parse(sessionStorage.design ?? 'null')?.values.thickness"
    )


def test_body_is_grasped_by_pointing(page):
    """Requirement: a click on another body of a mechanism holds it; a drag then moves it, and the others
    follow."""
    chosen(page, "preset", "four_bar_of_flexures")
    page.wait("studio.state.poses.length === 3")
    x, y = page.ask("studio.view.page(studio.state.poses[1][0] + 0.02, studio.state.poses[1][1])")
    drag(page, [(x, y)])
    page.wait("studio.state.placing.body === 1 && studio.state.drive === 'pull'")
    drag(page, [(x, y), (x + 20, y), (x + 40, y)])
    page.wait("studio.state.poses[1][0] > 0.055 && studio.state.poses[0][2] < -0.05")
    assert page.ask("studio.errors") == []


def test_no_word_outlives_what_it_is_of(page):
    """Requirement: the note of a preset is shown for its own values alone; an error is gone with the next
    change, whether the page or the server found it, and so is that of a server that was away."""
    note, error = (f"document.getElementById('{name}').textContent" for name in ("preset-note", "note"))
    assert page.ask(note) == "swings about once a second, in real time"
    typed(page, "strip width in mm", "12")
    page.wait(f"studio.state.values.width === 0.012 && {note} === ''")
    typed(page, "strip thickness in mm", "8000")
    page.wait(f"{error}.startsWith('strip thickness: from')")
    typed(page, "strip width in mm", "10")
    page.wait(f"studio.state.values.width === 0.01 && {note} !== '' && {error} === ''")
    chosen(page, "preset", "titanium_pivot")
    page.wait(f"studio.state.preset === 'titanium_pivot' && {note} === ''")
    page.ask("studio.send({ do: 'parameter', name: 'length', value: 70 })")
    page.wait(f"{error}.startsWith('length: got 70000')")
    page.key("ArrowUp")
    page.wait(f"studio.state.pose[2] > 0 && {error} === ''")
    shown = page.ask("studio.socket.socket.close(), studio.shown")
    page.wait(f"{error}.startsWith('The server does not answer')")
    page.wait(f"{error} === '' && studio.shown > {shown + 2} && studio.state.preset === 'titanium_pivot'")


def test_comma_is_a_decimal_point(page):
    """Requirement: a number that is typed with a comma is not read without it."""
    page.ask(
        "(e => { e.focus(); e.select(); })(document.querySelector(\"input[aria-label='body mass in g']\"))"
    )
    for key in "0,6":
        page.key(key)
    page.key("Enter")
    page.wait("Math.abs(studio.state.values.body_mass - 0.6e-3) < 1e-12")


def test_release_while_scrubbing_goes_live(page):
    """Requirement: a release while an earlier state is shown goes back to the live state first."""
    page.wait("studio.ring.length > 6")
    page.key("[")
    page.wait("!studio.ring.live")
    page.key("r")
    page.wait("studio.ring.live && studio.state.mode === 'released'")
    page.key("r")
    page.wait("studio.state.mode === 'held'")
