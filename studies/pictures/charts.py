"""Curves over one axis with their units, each with its name at its end."""

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from scipy.optimize import isotonic_regression

from studies.kinds import Array

#: Colour of a level and of its name.
LEVEL = "#444444"
#: Power of ten -> prefix.
PREFIXES = {6: "M", 3: "k", 0: "", -3: "m", -6: "µ", -9: "n", -12: "p"}
#: Least distance of two names, and how far a name stays from the ends of its axis, in heights of a chart.
APART, WITHIN = 0.115, 0.03
#: Least height of an axis, in parts of the largest value; and columns of names over the width of a chart.
FLAT, NEAR = 2e-3, 20.0
#: A level further away than this many times the curves' largest value is told, not drawn.
FAR = 3.0


@dataclass(frozen=True, kw_only=True)
class Quantity:
    """What an axis shows: its name, its unit in SI, and the power of ten of the largest prefix it takes.

    factor: of a unit without prefix, such as degrees for radians; 0 for one that has prefixes.
    """

    name: str
    unit: str = ""
    highest: int = 3
    factor: float = 0.0

    def scaled(self, arrays: Iterable[Array]) -> tuple[float, str]:
        """Return the factor to the unit that suits these values, and what the axis is called."""
        if self.factor:
            return self.factor, f"{self.name} [{self.unit}]" if self.unit else self.name
        largest = max((float(np.nanmax(np.abs(each), initial=0.0)) for each in arrays), default=0.0)
        power = min(self.highest, 0)
        if largest > 0.0:
            power = max(min(PREFIXES), min(self.highest, 3 * math.floor(math.log10(largest) / 3.0)))
        return 10.0**-power, f"{self.name} [{PREFIXES[power]}{self.unit}]"


@dataclass(frozen=True, kw_only=True)
class Curve:
    """A curve: its name, x and y (S,) in SI, colour and line."""

    name: str
    x: Array
    y: Array
    colour: str
    line: Any = "-"

    @property
    def end(self) -> tuple[float, float]:
        """The last point that has a value."""
        finite = np.flatnonzero(np.isfinite(self.y))
        return float(self.x[finite[-1]]), float(self.y[finite[-1]])


@dataclass(frozen=True, kw_only=True)
class Chart:
    """Curves of one quantity over another.

    Attributes:
        level: a value that is drawn across, with its name; None for none.
        equal: whether both axes have the same scale.
    """

    x: Quantity
    y: Quantity
    curves: tuple[Curve, ...]
    level: tuple[float, str] | None = None
    equal: bool = False

    def draw(self, panel: Axes) -> None:
        """Draw the chart."""
        across, x_label = self.x.scaled(curve.x for curve in self.curves)
        up, y_label = self.y.scaled(curve.y for curve in self.curves)
        for curve in self.curves:
            panel.plot(across * curve.x, up * curve.y, color=curve.colour, linestyle=curve.line)
        panel.set(xlabel=x_label, ylabel=y_label)
        if self.equal:
            panel.set(aspect="equal")
            panel.set_adjustable("datalim")
            panel.margins(0.12)
        else:
            panel.margins(x=0.0)
            panel.ticklabel_format(useOffset=False)
            self._open(panel, up)
        if self.level is not None:
            self._level(panel, up)
        self._names(panel, across, up)

    def _open(self, panel: Axes, up: float) -> None:
        """Show what is constant but for round-off as constant."""
        known = np.concatenate([up * curve.y[np.isfinite(curve.y)] for curve in self.curves])
        least = FLAT * float(np.abs(known).max(initial=0.0))
        if len(known) and np.ptp(known) < least:
            middle = 0.5 * (known.min() + known.max())
            panel.set_ylim(middle - 0.5 * least, middle + 0.5 * least)

    def _level(self, panel: Axes, up: float) -> None:
        """Draw the level with its name, or tell it where it lies far above."""
        value, name = self.level or (0.0, "")
        largest = max(float(np.nanmax(curve.y, initial=0.0)) for curve in self.curves)
        told = f"{name} {up * value:.0f}" if up * value > 1e3 else f"{name} {up * value:.4g}"
        look: dict[str, Any] = {"ha": "left", "color": LEVEL, "fontsize": 8.0}
        if value <= FAR * largest:
            panel.axhline(up * value, color=LEVEL, linestyle="--", linewidth=1.0)
            panel.set_ylim(top=max(panel.get_ylim()[1], 1.18 * up * value))
            panel.annotate(told, (0.02, up * value), (0, 2), ("axes fraction", "data"), "offset points",
                           va="bottom", **look)  # fmt: skip
        else:
            panel.set_ylim(top=1.25 * panel.get_ylim()[1])
            panel.annotate(f"{told}, far above", (0.02, 0.97), xycoords="axes fraction", va="top", **look)

    def _names(self, panel: Axes, across: float, up: float) -> None:
        """Write the name of every curve beside its end, apart from the others."""
        named = [curve for curve in self.curves if curve.name and np.isfinite(curve.y).any()]
        ends = np.array([curve.end for curve in named]).reshape(-1, 2) * (across, up)
        look: dict[str, Any] = {"textcoords": "offset points", "fontsize": 8.0}
        if self.equal:  # the limits are known when it is drawn: names above the ends, equal ends in a row
            near = 0.03 * np.ptp(np.array(panel.dataLim.get_points()), axis=0).max()
            for k, (curve, end) in enumerate(zip(named, ends, strict=True)):
                before = int((np.hypot(*(ends[:k] - end).T) < near).sum())
                panel.annotate(curve.name, end, (8 * before, 3), ha="center", va="bottom", color=curve.colour,
                               **look)  # fmt: skip
            return
        low, high = panel.get_ylim()
        heights = (ends[:, 1] - low) / (high - low)
        begin, last = panel.get_xlim()
        column = np.round(NEAR * (ends[:, 0] - begin) / (last - begin))  # those that end together are apart
        for each in np.unique(column):
            heights[column == each] = apart(heights[column == each])
        look["bbox"] = {"facecolor": "white", "edgecolor": "none", "alpha": 0.7, "pad": 0.5}
        for curve, end, height in zip(named, ends, heights, strict=True):
            panel.annotate(curve.name, (end[0], height), (3, 0), ("data", "axes fraction"), ha="left",
                           va="center", color=curve.colour, **look)  # fmt: skip


def apart(heights: Array, gap: float = APART) -> Array:
    """Return heights (K,) [1] moved as little as it takes to be `gap` apart, in their order, within the axis.

    Least squares: of heights less their place times the gap, which must not fall.
    """
    order = np.argsort(heights, kind="stable")
    steps = gap * np.arange(len(heights))
    rising = isotonic_regression(heights[order] - steps).x if len(heights) else heights
    found = np.empty_like(heights)
    found[order] = np.clip(rising, WITHIN, max(WITHIN, 1.0 - WITHIN - steps[-1:].sum())) + steps
    return found
