"""What a picture shows of an answer: its name, and curves over one axis."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from scipy.optimize import isotonic_regression

from studies.answers.answer import Answer
from studies.answers.quantities import Scale
from studies.kinds import Array
from studies.record.style import Look

#: What answers over one another are called beside their curves: as many as there may be.
LETTERS = "ABCDE"


@dataclass(frozen=True, kw_only=True)
class Shown:
    """An answer as a picture shows it: its name, and a yield strength [Pa] that replaces that of its
    strips."""

    name: str
    answer: Answer
    yield_strength: float | None = None

    @property
    def limit(self) -> float | None:
        """The least yield strength of the strips [Pa]; None where none is known."""
        known = [each.yield_strength for each in self.answer.design.strips if each.yield_strength is not None]
        return self.yield_strength or min(known, default=None)


#: Colour of a level and of its name.
MARK = "#444444"
#: Least distance of two names, and how far a name stays from the ends of its axis, in heights of a chart.
APART, WITHIN = 0.115, 0.03
#: Least height of an axis, in parts of the largest value; and columns of names over the width of a chart.
FLAT, NEAR = 2e-3, 20.0
#: A level further away than this many times the curves' largest value is told, not drawn.
FAR = 3.0


#: A curve: its name, colour and line, x and y (S,) in SI.
Curve = tuple[Look, Array, Array]


@dataclass(frozen=True, kw_only=True)
class Chart:
    """Curves of one quantity over another, in the units of the axes.

    Attributes:
        level: a value that is drawn across, with its name; None for none.
        equal: whether both axes have the same scale.
    """

    x: Scale
    y: Scale
    curves: tuple[Curve, ...]
    level: tuple[float, str] | None = None
    equal: bool = False

    def draw(self, panel: Axes) -> None:
        """Draw the chart."""
        across, x_unit = self.x.fitting(x for _, x, _ in self.curves)
        up, y_unit = self.y.fitting(y for _, _, y in self.curves)
        for look, x, y in self.curves:
            panel.plot(across * x, up * y, color=look.colour, linestyle=look.line)
        part, _, label = self.y.named(y_unit).rpartition("\n")
        panel.set(xlabel=self.x.named(x_unit), ylabel=label)
        panel.set_title(part, loc="left", fontsize=8.0)
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
        known = np.concatenate([up * y[np.isfinite(y)] for _, _, y in self.curves])
        least = FLAT * float(np.abs(known).max(initial=0.0))
        if len(known) and np.ptp(known) < least:
            middle = 0.5 * (known.min() + known.max())
            panel.set_ylim(middle - 0.5 * least, middle + 0.5 * least)

    def _level(self, panel: Axes, up: float) -> None:
        """Draw the level with its name, or tell it where it lies far above."""
        value, name = self.level or (0.0, "")
        largest = max(float(np.nanmax(y, initial=0.0)) for _, _, y in self.curves)
        told = f"{name} {up * value:.0f}" if up * value > 1e3 else f"{name} {up * value:.4g}"
        look: dict[str, Any] = {"ha": "left", "color": MARK, "fontsize": 8.0}
        if value <= FAR * largest:
            panel.axhline(up * value, color=MARK, linestyle="--", linewidth=1.0)
            panel.set_ylim(top=max(panel.get_ylim()[1], 1.18 * up * value))
            panel.annotate(told, (0.02, up * value), (0, 2), ("axes fraction", "data"), "offset points",
                           va="bottom", **look)  # fmt: skip
        else:
            panel.set_ylim(top=1.25 * panel.get_ylim()[1])
            panel.annotate(f"{told}, far above", (0.02, 0.97), xycoords="axes fraction", va="top", **look)

    def _names(self, panel: Axes, across: float, up: float) -> None:
        """Write the name of every curve beside its end, apart from the others."""
        named, last = [], []
        for look, x, y in self.curves:
            finite = np.flatnonzero(np.isfinite(y))
            if look.label and len(finite):
                named.append(look)
                last.append((across * x[finite[-1]], up * y[finite[-1]]))
        ends = np.array(last).reshape(-1, 2)
        words: dict[str, Any] = {"textcoords": "offset points", "fontsize": 8.0}
        if self.equal:  # the limits are known when it is drawn: names above the ends, equal ends in a row
            near = 0.03 * np.ptp(np.array(panel.dataLim.get_points()), axis=0).max()
            for k, (look, end) in enumerate(zip(named, ends, strict=True)):
                before = int((np.hypot(*(ends[:k] - end).T) < near).sum())
                above: dict[str, Any] = {"ha": "center", "va": "bottom", "color": look.colour}
                panel.annotate(look.label, (end[0], end[1]), (8 * before, 3), **above, **words)
            return
        low, high = panel.get_ylim()
        heights = (ends[:, 1] - low) / (high - low)
        left, right = panel.get_xlim()
        column = np.round(NEAR * (ends[:, 0] - left) / (right - left))  # those that end together are apart
        for each in np.unique(column):
            heights[column == each] = apart(heights[column == each])
        words["bbox"] = {"facecolor": "white", "edgecolor": "none", "alpha": 0.7, "pad": 0.5}
        for look, end, height in zip(named, ends, heights, strict=True):
            panel.annotate(look.label, (end[0], height), (3, 0), ("data", "axes fraction"), ha="left",
                           va="center", color=look.colour, **words)  # fmt: skip


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
