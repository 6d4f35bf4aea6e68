"""Fig 7 of the paper: the interactive environment in a browser, its frame rate and solve time.

The demo film drives it; the paper drives its pivot at 25 pictures a second. What is measured here depends on
the machine and on what else it does; the snapshots are the page's own canvas.
"""

import base64
import io
from collections.abc import Callable, Hashable, Iterator, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from PIL import Image

from studies.engine import Answer, Part, Study, Tables, absent, lacking
from studies.interactive.presets import PRESETS, STEPS_A_FRAME
from studies.interactive.session import Session
from studies.record.panels import Axis, Curves, Drawn, Level, Panel, sheet
from studies.record.progress import measure
from studies.record.style import BLACK, BLUE, GREY, RED, Look

#: The paper's pictures a second.
PAPER_RATE = 25.0
#: Frames of the film at which a snapshot is taken, the body released, and re-clamped.
HELD, RELEASED, CAUGHT = 68, 76, 130
#: The swing is taken when the body has turned past this to the other side [rad].
SWUNG = -0.5
#: Frames that are watched, after those in which the film is drawn for the first time.
WATCHED = 300
#: What is kept of the canvas, as parts of its width and height, the size of a stored snapshot [px] and its
#: colours: three of them stay below the size of a figure.
PART, SIZE, COLOURS = (0.20, 0.15, 0.80, 0.85), (320, 280), 64
#: Looks of the frames that are shown, and of the times of a frame: by preset and work, and in the loop.
SHOWN = Look(label="_shown", colour=BLUE)
SOLVING, FINDING = "in the loop, solving", "and finding the markers"
TIMES = {
    (preset, work): Look(label=f"{name}, {work}", colour=colour, line=line)
    for preset, name, colour in (("polymer", "polymer", BLUE), ("table-1", "Table 1", RED))
    for work, line in (("four steps", "--"), ("pose", "-"))
} | {
    SOLVING: Look(label=SOLVING, colour=GREY, line=":"),
    FINDING: Look(label=FINDING, colour=BLACK),
}
#: Repeats of the solver alone.
REPEATS = 3


def _missing() -> str:
    """Return what this machine lacks to compute the study, or nothing."""
    packages = lacking("interactive", absent(("cv2", "starlette", "uvicorn", "websockets")))
    if packages:
        return packages
    from studies.interactive.web.browser import NAMES, executable

    return "" if executable() else f"it needs a browser (no {NAMES[0]} on the PATH)"


def _browsed() -> Answer:
    """Return snapshots, and the frames as they were shown."""
    from studies.interactive.tracking.films import demo_film
    from studies.interactive.web.browser import Browser
    from studies.interactive.web.server import Server, Settings, warm_up

    warm_up()  # no picture waits for a compiler
    source = demo_film()
    shots = source.shots()
    for _ in range(WATCHED):  # draw the film before it is timed
        next(shots)
    with Server(Settings(camera="film", source=source)) as hosted, Browser() as browser:
        browser.open(hosted.address)
        browser.wait("window.studio?.drawn ? true : false", 60.0)
        snapshots = list(_snapshots(browser))
        browser.wait(f"studio.state.seq >= {WATCHED}", 120.0)
        return {"snapshots": snapshots, "frames_times": browser.ask(FRAMES)}


#: Asks the page for the frames of the film that it showed.
FRAMES = """
studio.ring.states.filter((s) => s.track_ms !== undefined).map((s, k, all) => ({
  frame: s.seq, mode: s.mode, at_s: s.at - all[0].at, solve_ms: s.solve_ms, track_ms: s.track_ms,
  iterations: s.iterations }))
"""


#: Whether the state on the page is one of the film's frames, not the answer to a key.
FRAME = "studio.state.track_ms !== undefined"


def _snapshots(browser: Any) -> Iterator[dict[str, Any]]:
    """Yield three snapshots: held, moving after the release, re-clamped."""
    swung = f"{FRAME} && studio.state.mode === 'released' && studio.state.pose[2] < {SWUNG}"
    caught = f"{FRAME} && studio.state.mode === 'held'"
    shots = {"held": (HELD, ""), "released": (RELEASED, swung), "caught": (CAUGHT, caught)}
    for label, (frame, state) in shots.items():
        browser.wait(f"studio.drawn.seq >= {frame}", 60.0)
        if state:
            browser.key("r")
            browser.wait(state, 60.0)
        yield _taken(browser, label)


def _taken(browser: Any, label: str) -> dict[str, Any]:
    """Return what the page shows now."""
    from studies.interactive.tracking.films import rotation

    state = browser.ask("({ ...studio.state, canvas: document.getElementById('stage').toDataURL() })")
    return {
        "label": label,
        "frame": state["seq"],
        "mode": state["mode"],
        "rotation_rad": state["pose"][2],
        "film_rotation_rad": rotation(state["seq"]),
        "stress_of_yield": state["stress"]["of_yield"],
        "png_base64": _small(state["canvas"]),
    }


def _small(canvas: str) -> str:
    """Return the middle of a canvas as a small PNG of few colours, without the noise of its picture."""
    import cv2

    with Image.open(io.BytesIO(base64.b64decode(canvas.partition(",")[2]))) as picture:
        smooth = cv2.bilateralFilter(np.asarray(picture.convert("RGB")), 9, 40.0, 5.0)
    clean = Image.fromarray(np.asarray(smooth, dtype=np.uint8))
    width, height = clean.size
    box = tuple(round(part * side) for part, side in zip(PART, (width, height) * 2, strict=True))
    small = clean.crop(box).resize(SIZE, Image.Resampling.LANCZOS)  # type: ignore[arg-type]
    stream = io.BytesIO()
    few = small.quantize(COLOURS, method=Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE)
    few.save(stream, "png", optimize=True)
    return base64.b64encode(stream.getvalue()).decode()


def _alone(preset: str) -> Iterator[dict[str, Any]]:
    """Yield times of the solvers of one design without a browser: poses of the film, then frames of a
    swing."""

    def timed(work: str, repeat: int, frame: int, call: Callable[[], Any]) -> dict[str, Any]:
        took = 1e3 * measure(call, repeat=1, warm_up=0).median
        return {"preset": preset, "work": work, "repeat": repeat, "frame": frame, "time_ms": took}

    from studies.interactive.tracking.films import rotation

    for repeat in range(REPEATS):
        session = Session(preset)
        session.feed({"do": "drive", "by": "rotation", "t": 0.0})
        mechanics = session.mechanics
        rng = np.random.default_rng(repeat)
        for k in range(WATCHED):
            mechanics.turn(rotation(k))
            pose = mechanics.snapshot.pose + rng.normal(0.0, (3e-5, 3e-5, 4e-4))
            yield timed("pose", repeat, k, partial(mechanics.hold, pose))
        mechanics.turn(1.0)
        mechanics.release(np.zeros(3))
        for k in range(WATCHED):
            yield timed("four steps", repeat, k, partial(mechanics.advance, STEPS_A_FRAME))


def _figure(tables: Tables) -> Figure:
    """Draw the snapshots above the times."""
    shots = tables["snapshots"].sort_values("frame").to_dict("records")
    taken: list[Drawn] = [partial(_snapshot, row, letter) for row, letter in zip(shots, "abc", strict=True)]
    rate, times = _rate(tables["frames_times"]), _times(tables["frames_times"], tables["alone_times"])
    rows: list[Sequence[Drawn]] = [[panel for panel in taken for _ in range(2)], [rate] * 3 + [times] * 3]
    return sheet(7.2, 4.6, rows, heights=(1.15, 1.0), legend=3)


def _snapshot(row: dict[Hashable, Any], letter: str, panel: Axes) -> None:
    with Image.open(io.BytesIO(base64.b64decode(row["png_base64"]))) as picture:
        panel.imshow(np.asarray(picture.convert("RGB")), interpolation="none")
    panel.set_title(f"({letter}) {row['label']}, {np.degrees(row['rotation_rad']):.0f}°")
    panel.axis("off")


def _rate(frames: pd.DataFrame) -> Panel:
    """Return pictures shown a second, over one second each, beside the paper's."""
    at = np.sort(frames["at_s"].to_numpy())
    seconds = np.arange(1.0, at[-1])
    rate = [np.count_nonzero((at > s - 1.0) & (at <= s)) for s in seconds]
    shown = Curves(pd.DataFrame({"at_s": seconds, "rate_Hz": rate}), SHOWN, more={"drawstyle": "steps-mid"})
    return Panel(
        Axis("at_s", "time [s]"),
        Axis("rate_Hz", "pictures a second [Hz]", limits=(0.0, 40.0)),
        (shown, Level(PAPER_RATE, words="the paper's 25 Hz", line="--")),
        title=f"(d) frame rate in the browser, mean {(len(at) - 1) / (at[-1] - at[0]):.1f} Hz",
    )


def _times(frames: pd.DataFrame, alone: pd.DataFrame) -> Panel:
    """Return the share of the frames that take less than a time: solver alone, and in the loop without and
    with the search for the markers."""
    best = alone.groupby(["preset", "work", "frame"])["time_ms"].min()
    times: dict[Any, pd.Series] = dict(list(best.groupby(["preset", "work"])))
    times |= {SOLVING: frames["solve_ms"], FINDING: frames["track_ms"] + frames["solve_ms"]}
    curves = []
    for key, look in TIMES.items():
        ordered = np.sort(times[key].to_numpy())
        rows = pd.DataFrame({"time_ms": ordered, "share": np.arange(1, len(ordered) + 1) / len(ordered)})
        told = replace(look, label=f"{look.label}: {np.percentile(ordered, 95.0):.2g} ms")
        curves.append(Curves(rows, told, more={"drawstyle": "steps-post"}))
    limits = (Level(each, f"{each:g} ms", upright=True, line="--") for each in (1.0, 1e3 / PAPER_RATE))
    return Panel(
        Axis("time_ms", "time a frame [ms]", log=True, limits=(0.03, 300.0)),
        Axis("share", "share of frames [1]"),
        (*curves, *limits),
        title="(e) time of a frame; legend: 95th percentile",
    )


STUDY = Study(
    cases=("polymer_pivot", "cross_axis_pivot"),
    parts=(
        Part(ask=_browsed, alone=True),
        Part(at=lambda: PRESETS, ask=lambda preset: {"alone_times": _alone(preset)}, alone=True),
    ),
    varying=("snapshots",),
    figures={"fig07_interactive": _figure},
    missing=_missing,
)
