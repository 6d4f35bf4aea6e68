"""The printable sheet: both markers where they sit on the pivot, cut lines, words, and a ruler."""

import io

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from studies.interactive.pivot.design import SIDE, Placing, build
from studies.interactive.pivot.presets import PRESETS
from studies.interactive.tracking.painter import MARGIN
from studies.interactive.tracking.planar import BITS, cells

#: A4, and the pivot's origin on it [mm].
PAGE = (210.0, 297.0)
ORIGIN = (75.0, 122.0)
RULER = 100.0


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
    pivot = build(PRESETS["polymer"].values())
    placing = Placing.of(pivot)
    clamps = 1e3 * pivot.clamp_points + ORIGIN
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
    _words(axes)
    return figure


def _marker(axes: Axes, number: int, centre: np.ndarray, words: str, side: int) -> None:
    """One marker with its white margin, cut line and words, all in millimetres."""
    size = 1e3 * SIDE
    bit = size / BITS
    left, top = centre[0] - size / 2, centre[1] + size / 2
    for row, lights in enumerate(cells(number)):
        for column, light in enumerate(lights):
            if not light:
                # a hair wider than the bit, so that no viewer draws a gap between neighbours
                place = (left + column * bit, top - (row + 1) * bit)
                axes.add_patch(
                    Rectangle(place, bit, bit, facecolor="black", edgecolor="black", linewidth=0.05)
                )
    half = size / 2 + MARGIN * bit
    cut = Rectangle((centre[0] - half, centre[1] - half), 2 * half, 2 * half, fill=False, edgecolor="#888888")
    cut.set(linewidth=0.6, linestyle=(0, (2, 2)))
    axes.add_patch(cut)
    axes.text(centre[0] + half + 4, centre[1], words, rotation=90, ha="center", va="center", fontsize=8)
    axes.plot(
        [centre[0]] * 2,
        [centre[1] + side * half, centre[1] + side * (half - 3)],
        color="black",
        linewidth=0.8,
    )


def _ruler(axes: Axes, x: float, y: float) -> None:
    """A ruler of RULER millimetres."""
    axes.plot([x, x + RULER], [y, y], color="black", linewidth=0.8)
    for k in range(int(RULER) + 1):
        high = 5.0 if k % 10 == 0 else 3.5 if k % 5 == 0 else 2.0
        axes.plot([x + k, x + k], [y, y + high], color="black", linewidth=0.4)
        if k % 10 == 0:
            axes.text(x + k, y + 6, str(k), ha="center", fontsize=7)
    axes.text(x + RULER + 3, y, "mm", fontsize=8)


def _words(axes: Axes) -> None:
    lines = (
        "Markers of the interactive pivot",
        f"Print at 100 %. If the ruler measures L mm, the side is {1e3 * SIDE:.0f} L / 100 mm: type it in.",
        "Glue both flat, upright and in one plane, so far apart as they stand here; dashed: the strips.",
    )
    for k, line in enumerate(lines):
        axes.text(20, PAGE[1] - 12 - 5.5 * k, line, fontsize=11 if k == 0 else 8)
