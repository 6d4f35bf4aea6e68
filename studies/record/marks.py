"""Marks of panels beside their curves: levels, words, heat maps, and how uncertain a reference is."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm

from studies.record.panels import Axis

#: Colour of levels, and of the words beside them.
MARK = "#444444"
#: What words beside a mark stand on, so that curves behind them do not disturb.
BACKGROUND = {"facecolor": "white", "edgecolor": "none", "pad": 0.5, "alpha": 0.85}


@dataclass(frozen=True)
class Level:
    """A line across a panel, or up where `upright`: a bound, what the paper has, a number to compare with.

    Attributes:
        words: beside it.
        place: of the words over the line [of the width, or height]: beyond one half they end there, at 1 they
            stand beside the panel.
    """

    at: float
    words: str = ""
    colour: str = MARK
    line: str = "-"
    upright: bool = False
    place: float = 0.01

    def draw(self, panel: Axes, x: Axis, y: Axis) -> None:
        """Draw the level."""
        line = panel.axvline if self.upright else panel.axhline
        line(self.at, color=self.colour, linestyle=self.line, linewidth=0.9, label="_")
        if self.words:
            panel.annotate(self.words, fontsize=8, color=self.colour, bbox=BACKGROUND, **self._placed())

    def _placed(self) -> dict[str, Any]:
        """Return where the words stand, as of `Axes.annotate`."""
        if self.upright:
            place: dict[str, Any] = {"xy": (self.at, self.place), "xycoords": ("data", "axes fraction")}
            return place | {"xytext": (0, 4), "textcoords": "offset points", "ha": "center", "va": "bottom"}
        place = {"xy": (self.place, self.at), "xycoords": ("axes fraction", "data")}
        if self.place >= 1.0:
            return place | {"xytext": (2, 0), "textcoords": "offset points", "ha": "left", "va": "center"}
        side = "right" if self.place > 0.5 else "left"
        return place | {"xytext": (0, 2), "textcoords": "offset points", "ha": side, "va": "bottom"}


@dataclass(frozen=True, kw_only=True)
class HeatMap:
    """A column of a table over two integer columns: squares with the decimal exponent of the value.

    Attributes:
        limits: values of the lowest and the highest colour, in the unit of the column. A value that is not
            finite is a cross.
    """

    rows: pd.DataFrame
    column: str
    limits: tuple[float, float]

    def draw(self, panel: Axes, x: Axis, y: Axis) -> None:
        """Draw the squares."""
        grid = self.rows.pivot(index=y.column, columns=x.column, values=self.column)
        panel.pcolormesh(grid.columns, grid.index, grid, norm=LogNorm(*self.limits), cmap="viridis")
        panel.grid(False)
        dark = float(np.sqrt(self.limits[0] * self.limits[1]))
        for across, up, value in self.rows[[x.column, y.column, self.column]].itertuples(index=False):
            text = f"{np.log10(value):.0f}" if np.isfinite(value) else "x"
            colour = "white" if value < dark else "black"
            panel.text(across, up, text, ha="center", va="center", fontsize=7.5, color=colour)


@dataclass(frozen=True)
class Doubt:
    """How uncertain the reference is that errors are held against [of the axis y]: shaded below."""

    level: float

    def draw(self, panel: Axes, x: Axis, y: Axis) -> None:
        """Shade what lies below."""
        panel.set_ylim(bottom=self.level / 10.0)
        panel.axhspan(self.level / 1e3, self.level, color="#eeeeee", zorder=0)
        panel.annotate(
            "uncertainty of the reference", (0.98, self.level), (0, -3), ("axes fraction", "data"),
            "offset points", ha="right", va="top", fontsize=8, color="#666666",
            bbox=BACKGROUND | {"facecolor": "#eeeeee"},
        )  # fmt: skip
