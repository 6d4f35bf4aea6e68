"""What a picture shows of an answer: its name, and curves over one axis."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes

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
#: Least height of an axis, in parts of the largest value.
FLAT = 2e-3
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
    curves: Sequence[Curve]
    level: tuple[float, str] | None = None
    equal: bool = False

    def draw(self, panel: Axes) -> None:
        """Draw the chart."""
        across, x_unit = self.x.fitting(x for _, x, _ in self.curves)
        up, y_unit = self.y.fitting(y for _, _, y in self.curves)
        for look, x, y in self.curves:
            panel.plot(across * x, up * y, **look.keywords())
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
