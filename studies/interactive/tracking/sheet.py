"""The printed sheet: both markers where they sit on the pivot, cut lines, words, and a ruler; and a camera's
constants from views of it, with how uncertain they are."""

import io
from collections.abc import Iterable, Iterator, Sequence

import cv2
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from studies.errors import BadInput
from studies.interactive.design import PRINTED, SIDE, Placing
from studies.interactive.presets import PRESETS
from studies.interactive.tracking.edges import Picture
from studies.interactive.tracking.planar import BITS, CORNERS, MARGIN, Camera, cells
from studies.interactive.tracking.tracker import Tracker
from studies.kinds import Array

#: A4, and the pivot's origin on it [mm].
PAGE = (210.0, 297.0)
ORIGIN = (75.0, 122.0)
RULER = 100.0
#: Corners (8, 2) of both markers of the printed sheet [m], as long as it is not cut.
SHEET = (np.array([(0.0, 0.0), PRINTED[:2]])[:, None] + SIDE * CORNERS).reshape(8, 2)
#: How much the outlines of two views differ at least once moved, turned and scaled onto one another, and the
#: part of the focal length that it may be uncertain by.
APART, SURE = 0.02, 0.01


def sheet() -> bytes:
    """Return the sheet as PDF, the same bytes every time."""
    stream = io.BytesIO()
    page().savefig(stream, format="pdf", metadata={"CreationDate": None, "Producer": None, "Creator": None})
    return stream.getvalue()


def page() -> Figure:
    """Return the sheet as a figure of A4 whose axes count millimetres."""
    figure = Figure(figsize=(PAGE[0] / 25.4, PAGE[1] / 25.4))
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set(xlim=(0, PAGE[0]), ylim=(0, PAGE[1]), aspect="equal")
    axes.axis("off")
    placing = Placing(PRESETS["polymer"].design)
    clamps = 1e3 * placing.clamps + ORIGIN
    for strip in clamps:
        axes.plot(*strip.T, color="#999999", linewidth=0.8, linestyle=(0, (4, 3)))
    for end, word in ((0, "ground"), (1, "moving body")):
        axes.plot(*clamps[:, end].T, color="#666666", linewidth=2.0)
        x, y = clamps[:, end].mean(axis=0)
        axes.text(x, y + (2.0 if end == 0 else -4.5), word, ha="center", fontsize=7, color="#444444")
    ground = 1e3 * placing.ground + ORIGIN
    moving = ground + 1e3 * placing.rest[:2]
    _marker(axes, 0, ground, "GROUND (marker 0): glue to what stands still", -1)
    _marker(axes, 1, moving, "MOVING (marker 1): glue to the body that turns", 1)
    _ruler(axes, 30.0, 24.0)
    lines = (
        "Markers of the interactive pivot",
        f"Print at 100 %. If the ruler measures L mm, the side is {1e3 * SIDE:.0f} L / 100 mm: type it in.",
        "Glue both flat, upright and in one plane, so far apart as they stand here; dashed: the strips.",
    )
    for k, line in enumerate(lines):
        axes.text(20, PAGE[1] - 12 - 5.5 * k, line, fontsize=11 if k == 0 else 8)
    return figure


def _marker(axes: Axes, number: int, centre: np.ndarray, words: str, side: int) -> None:
    """One marker with its white margin, cut line and words, all in millimetres."""
    size = 1e3 * SIDE
    bit = size / BITS
    across, up = (each + size * np.linspace(-0.5, 0.5, BITS + 1) for each in centre)
    dark = np.ma.masked_where(cells(number), np.zeros((BITS, BITS)))
    # a hair wider than the bit, so that no viewer draws a gap between neighbours
    axes.pcolormesh(across, up[::-1], dark, cmap="gray", edgecolors="face", linewidth=0.05)
    half = size / 2 + MARGIN * bit
    corners = centre + half * np.array([(-1, -1), (1, -1), (1, 1), (-1, 1), (-1, -1)])
    axes.plot(*corners.T, color="#888888", linewidth=0.6, linestyle=(0, (2, 2)))
    x, y = centre
    axes.text(x + half + 4, y, words, rotation=90, ha="center", va="center", fontsize=8)
    axes.vlines(x, y + side * (half - 3), y + side * half, color="black", linewidth=0.8)


def _ruler(axes: Axes, x: float, y: float) -> None:
    """A ruler of RULER millimetres."""
    axes.hlines(y, x, x + RULER, color="black", linewidth=0.8)
    marks = np.arange(RULER + 1)
    high = np.select([marks % 10 == 0, marks % 5 == 0], [5.0, 3.5], 2.0)
    axes.vlines(x + marks, y, y + high, color="black", linewidth=0.4)
    for k in marks[::10]:
        axes.text(x + k, y + 6, f"{k:.0f}", ha="center", fontsize=7)
    axes.text(x + RULER + 3, y, "mm", fontsize=8)


def views(pictures: Iterable[Picture], count: int) -> Iterator[tuple[Array, tuple[int, int]]]:
    """Yield the corners (8, 2) [px] of both markers, and width and height, of those pictures that show them
    from another side than all before, `count` of them at most."""
    tracker, known = Tracker(), list[Array]()
    for k, picture in enumerate(pictures):
        event = tracker.see(picture, float(k))
        if event["do"] != "seen" or event["state"] != "found" or "blurred" in event["faults"]:
            continue
        corners = np.reshape(event["quads"], (8, 2))
        if all(_unlike(corners, other) > APART for other in known):
            known.append(corners)
            yield corners, (picture.shape[1], picture.shape[0])
        if len(known) == count:
            return


def _unlike(corners: Array, other: Array) -> float:
    """Return the part of one outline that no shift, turn and scale takes to the other."""
    z, w = (each @ [1.0, 1.0j] for each in (corners - corners.mean(axis=0), other - other.mean(axis=0)))
    return float(np.linalg.norm(z - w * np.vdot(w, z) / np.vdot(w, w)) / np.linalg.norm(z))


def calibrated(pictures: Sequence[Array], size: tuple[int, int]) -> tuple[Camera, Camera, float]:
    """Return the camera that saw the sheet's corners as (8, 2) [px] in three views or more, the standard
    deviations of its constants, and the residual (rms) of the corners [px].

    Args:
        size: width and height of the pictures [px].

    Raises:
        BadInput: fewer than three views, or such that do not tell the focal length to a part of SURE.
    """
    if len(pictures) < 3:
        raise BadInput(f"views: got {len(pictures)}, expected at least 3 of the sheet at different tilts")
    flat = [np.column_stack((SHEET, np.zeros(8))).astype(np.float32)] * len(pictures)
    seen = [np.asarray(view, dtype=np.float32)[:, None] for view in pictures]
    flags = cv2.CALIB_FIX_K2 | cv2.CALIB_FIX_K3 | cv2.CALIB_ZERO_TANGENT_DIST
    rms, matrix, lens, _, _, sd, *_ = cv2.calibrateCameraExtended(
        flat, seen, size, np.eye(3), np.zeros(5), flags=flags
    )
    (fx, _, cx), (_, fy, cy), _ = matrix.tolist()
    k1, k2 = np.ravel(lens)[:2].tolist()
    spread = Camera(**dict(zip(("fx", "fy", "cx", "cy", "k1", "k2"), np.ravel(sd)[:6].tolist(), strict=True)))
    if not spread.fx < SURE * fx:
        raise BadInput(
            f"views: got a focal length of {fx:.0f} ± {spread.fx:.0f} px, expected it to {100 * SURE:g} %: "
            "tilt the sheet more, to all sides, near to the camera"
        )
    return Camera(fx=fx, fy=fy, cx=cx, cy=cy, k1=k1, k2=k2), spread, float(rms)
