"""Fig 7 of the paper: the interactive environment in a browser, its frame rate and solve time.

The demo film drives it; the paper drives its pivot at 25 pictures a second. What is measured here depends on
the machine and on what else it does; the snapshots are the page's own canvas.
"""

import base64
import io
import time
from collections.abc import Callable, Hashable, Iterator
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
from studies.record import style

#: The paper's pictures a second.
PAPER_RATE = 25.0
#: Frames of the film at which a snapshot is taken, the body let go, and caught.
HELD, RELEASED, CAUGHT = 68, 76, 130
#: The swing is taken when the body has turned past this to the other side [rad].
SWUNG = -0.5
#: Frames that are watched, after those in which the film is drawn for the first time.
WATCHED = 300
#: What is kept of the canvas, as parts of its width and height, the size of a stored snapshot [px] and its
#: colours: three of them stay below the size of a figure.
PART, SIZE, COLOURS = (0.20, 0.15, 0.80, 0.85), (320, 280), 64
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
    """Yield three snapshots: held, swinging after the release, caught again."""
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
        begin = time.perf_counter()
        call()
        took = 1e3 * (time.perf_counter() - begin)
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
        mechanics.release(np.zeros(3), session.solver, session.sweeps)
        for k in range(WATCHED):
            yield timed("four steps", repeat, k, partial(mechanics.advance, STEPS_A_FRAME))


def _figure(tables: Tables) -> Figure:
    """Draw the snapshots above the times."""
    page = style.page(7.2, 4.6)
    grid = page.add_gridspec(2, 6, height_ratios=(1.15, 1.0))
    for k, row in enumerate(tables["snapshots"].sort_values("frame").to_dict("records")):
        _snapshot(page.add_subplot(grid[0, 2 * k : 2 * k + 2]), row, "abc"[k])
    _rate(page.add_subplot(grid[1, :3]), tables["frames_times"])
    times = page.add_subplot(grid[1, 3:])
    _times(times, tables["frames_times"], tables["alone_times"])
    # below the axes: the curves need all of them
    page.legend(
        *times.get_legend_handles_labels(), loc="outside lower center", ncols=3, title="95 % of the frames in"
    )
    return page


def _snapshot(panel: Axes, row: dict[Hashable, Any], letter: str) -> None:
    with Image.open(io.BytesIO(base64.b64decode(row["png_base64"]))) as picture:
        panel.imshow(np.asarray(picture.convert("RGB")), interpolation="none")
    panel.set_title(f"({letter}) {row['label']}, {np.degrees(row['rotation_rad']):.0f}°")
    panel.axis("off")


def _rate(panel: Axes, frames: pd.DataFrame) -> None:
    """Pictures shown a second, over one second each, beside the paper's."""
    at = np.sort(frames["at_s"].to_numpy())
    seconds = np.arange(1.0, at[-1])
    rate = [np.count_nonzero((at > s - 1.0) & (at <= s)) for s in seconds]
    panel.step(seconds, rate, where="mid", color=style.BLUE, label="shown in the browser")
    panel.axhline(PAPER_RATE, color=style.BLACK, linestyle="--", label="the paper's 25 Hz")
    panel.set(xlabel="time [s]", ylabel="pictures a second [Hz]", ylim=(0.0, 40.0))
    mean = (len(at) - 1) / (at[-1] - at[0])
    panel.set_title(f"(d) frame rate, mean {mean:.1f} Hz")
    panel.legend(loc="lower right")


def _times(panel: Axes, frames: pd.DataFrame, alone: pd.DataFrame) -> None:
    """Share of the frames that take less than a time: solver alone, and in the loop without and with the
    search for the markers."""
    best = alone.groupby(["preset", "work", "frame"], sort=True)["time_ms"].min().reset_index()
    looks = {"polymer": style.BLUE, "table-1": style.RED}
    for (preset, work), rows in best.groupby(["preset", "work"], sort=True):
        line = "-" if work == "pose" else "--"
        name = {"polymer": "polymer", "table-1": "Table 1"}[str(preset)]
        _share(panel, rows["time_ms"], f"{name}, {work}", looks[str(preset)], line)
    _share(panel, frames["solve_ms"], "in the loop, solving", style.GREY, ":")
    _share(panel, frames["track_ms"] + frames["solve_ms"], "and finding the markers", style.BLACK, "-")
    panel.axvline(1.0, color=style.BLACK, linewidth=0.8)
    panel.axvline(1e3 / PAPER_RATE, color=style.BLACK, linewidth=0.8, linestyle="--")
    panel.set(xscale="log", xlabel="time a frame [ms]", ylabel="share of frames [1]", xlim=(0.03, 300.0))
    panel.set_title("(e) time a frame; lines at 1 ms and 40 ms")


def _share(panel: Axes, times: pd.Series, label: str, colour: str, line: str) -> None:
    ordered = np.sort(times.to_numpy())
    share = np.arange(1, len(ordered) + 1) / len(ordered)
    late = float(np.percentile(ordered, 95.0))
    panel.step(ordered, share, where="post", color=colour, linestyle=line, label=f"{label}: {late:.2g} ms")


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
