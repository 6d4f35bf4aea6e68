"""Panels of figures: curves of tables over axes, and the sheets they stand on, alike in every study.

A study says of a panel what stands along its axes and which marks are drawn over them: curves, levels, heat
maps, and how uncertain a reference is. `sheet` puts them on a page. What no other figure has, a study draws
itself: by a mark of its own, or a function of matplotlib's axes in a panel's place.
"""

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator

from studies.record.style import Look, page

#: Beyond this a logarithmic axis has no marks within its decades: hundreds that say nothing.
CROWDED = 1e4
#: Within this it has a number at 1, 2 and 5 of every decade.
FEW = 2e2


@dataclass(frozen=True)
class Axis:
    """What stands along an axis of a panel.

    Attributes:
        column: of the tables that are drawn; factor: from its unit to that of the label.
        log: whether it is logarithmic. Sizes are drawn then, without a sign, and nothing of what is nought.
        limits: lowest and highest value, None for those of the curves.
        ticks: the only ones; each: or a tick at every value of the column.
        names: what the column has in place of numbers, from the top, or from the left, on.
    """

    column: str
    label: str
    factor: float = 1.0
    log: bool = False
    limits: tuple[float | None, float | None] = (None, None)
    ticks: Iterable[float] = ()
    each: bool = False
    names: Sequence[str] = ()

    def of(self, rows: pd.DataFrame) -> pd.Series:
        """Return what is drawn of rows."""
        if self.names:
            return rows[self.column].map({name: place for place, name in enumerate(self.names)})
        values = self.factor * rows[self.column]
        if not self.log:
            return values
        return values.abs().where(values != 0.0)

    def apply(self, panel: Axes, name: str, values: Iterable[float]) -> None:
        """Give the axis of that name, x or y, its looks, once the values along it are drawn."""
        ticks = list(self.ticks) or (sorted(set(values)) if self.each else [])
        if ticks:
            words = {"labels": [f"{tick:g}" for tick in ticks]} if self.log and self.each else {}
            getattr(panel, f"set_{name}ticks")(ticks, **words)
            getattr(panel, f"{name}axis").minorticks_off()
        panel.set(**{f"{name}label": self.label})
        if self.limits != (None, None):  # which would keep those of panels that share it from growing
            panel.set(**{f"{name}lim": self.limits})
        if self.names:
            getattr(panel, f"set_{name}ticks")(range(len(self.names)), labels=self.names)
            last = len(self.names) - 0.4
            panel.set(**{f"{name}lim": (last, -0.6) if name == "y" else (-0.6, last)})
        low, high = getattr(panel, f"get_{name}lim")()
        along = getattr(panel, f"{name}axis")
        if self.log and high > CROWDED * low:
            along.minorticks_off()
        elif self.log and not ticks and high < FEW * low:
            along.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
            along.set_major_formatter("{x:g}")
            along.minorticks_off()


#: Axes that many figures have.
ROTATION = Axis("rotation_rad", "rotation [deg]", factor=180.0 / math.pi, ticks=range(0, 91, 15))
TIME = Axis("time_s", "time [ms]", factor=1e3)
CONTROL_POINTS = Axis("control_points", "control points a strip, n", each=True)
STRIP_POINTS = Axis("strip_points", "control points a strip", each=True)
MESH = Axis("elements", "elements a strip", log=True, each=True)


class _Mark(Protocol):
    """What is drawn in a panel."""

    def draw(self, panel: Axes, x: Axis, y: Axis) -> None:
        """Draw it over these axes."""


@dataclass(frozen=True)
class Curves:
    """Curves of a table, one a look.

    Attributes:
        looks: of each curve, by the value of the column `by`, or by the values of several; or the look of all
            rows as one curve.
        along: column in whose order points are joined, x by default.
        more: of `Axes.plot`.
    """

    rows: pd.DataFrame
    looks: Mapping[Any, Look] | Look
    by: str | Sequence[str] = "formulation"
    along: str = ""
    more: Mapping[str, Any] | None = None

    def draw(self, panel: Axes, x: Axis, y: Axis) -> None:
        """Draw the curves."""
        for look, rows in self._curves():
            ordered = rows.sort_values(self.along or x.column, kind="stable")
            panel.plot(x.of(ordered), y.of(ordered), **look.keywords() | dict(self.more or {}))

    def _curves(self) -> Iterable[tuple[Look, pd.DataFrame]]:
        """Yield the rows of every curve with its look."""
        looks = self.looks if isinstance(self.looks, Mapping) else {None: self.looks}
        for key, look in looks.items():
            mine = self.rows if key is None else self.rows[self._is(key)]
            if len(mine):
                yield look, mine

    def _is(self, key: Any) -> Any:
        """Return which rows are of a look."""
        if isinstance(self.by, str):
            return self.rows[self.by] == key
        values = dict(zip(self.by, key, strict=True))
        return (self.rows[list(values)] == pd.Series(values)).all(axis=1)


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


@dataclass(frozen=True)
class Panel:
    """Marks over two axes; `equal`: in the same scale."""

    x: Axis
    y: Axis
    marks: Sequence[_Mark]
    title: str = ""
    equal: bool = False

    def __call__(self, panel: Axes) -> None:
        """Draw it all."""
        panel.set(xscale="log" if self.x.log else "linear", yscale="log" if self.y.log else "linear")
        for mark in self.marks:
            mark.draw(panel, self.x, self.y)
        rows = [mark.rows for mark in self.marks if isinstance(mark, Curves)]
        for name, axis in (("x", self.x), ("y", self.y)):
            axis.apply(panel, name, (value for some in rows for value in axis.of(some).dropna()))
        panel.set_title(self.title)
        if self.equal:
            panel.set_aspect("equal")


#: What stands in a place of a sheet.
Drawn = Callable[[Axes], None]


def sheet(
    width: float,
    height: float,
    rows: Sequence[Sequence[Drawn]],
    *,
    title: str = "",
    columns: Sequence[str] = (),
    legend: int = 0,
    heights: Sequence[float] = (),
    colours: str = "",
) -> Figure:
    """Return the page with rows of panels; those with the same axis share it, and its name stands once.

    A panel that stands in several neighbouring places fills them. On such a page no axis is shared.

    Args:
        width, height: as of `page` [inch]; title: of the whole; columns: titles of the columns.
        legend: columns of the one below all panels, for all of them; 0 for none.
        heights: of the rows, in proportion; colours: what the colours of a heat map stand for.
    """
    drawn = page(width, height)
    across = list(zip(*rows, strict=True))
    places = [[id(panel) for panel in row] for row in rows]
    apart = len({place for line in places for place in line}) == len(rows) * len(across)
    shared_x = apart and all(_same("x", column) for column in across) and len(rows) > 1
    along: Any = "all" if _same("x", [panel for row in rows for panel in row]) else "col"
    shared_y = apart and all(_same("y", row) for row in rows) and len(across) > 1
    up: Any = "row" if shared_y else "col" if all(_same("y", column) for column in across) else "none"
    if apart:
        sharing: Any = {"sharex": along if shared_x else "none", "sharey": up}
        grid = drawn.subplots(len(rows), len(across), squeeze=False, **sharing)
    else:
        axes: Any = drawn.subplot_mosaic(places, height_ratios=heights or None)  # type: ignore[arg-type]
        grid = np.array([[axes[place] for place in line] for line in places])
    for panel, draw in dict(zip(grid.flat, (each for row in rows for each in row), strict=True)).items():
        draw(panel)
    for panel in grid[:-1].flat if shared_x else ():
        panel.set_xlabel("")
    for panel in grid[:, 1:].flat if shared_y else ():
        panel.set_ylabel("")
    for panel, words in zip(grid[0], columns, strict=False):
        panel.set_title(words)
    if title:
        drawn.suptitle(title)
    if colours:
        drawn.colorbar(grid[0, 0].collections[0], ax=list(grid.flat), label=colours)
    if legend:
        _key(drawn, grid.flat, columns=legend)
    return drawn


def _same(name: str, draws: Sequence[Drawn]) -> bool:
    """Whether panels have the same axis of that name."""
    first = draws[0]
    return isinstance(first, Panel) and all(
        isinstance(draw, Panel) and getattr(draw, name) == getattr(first, name) for draw in draws
    )


def _key(drawn: Figure, panels: Iterable[Axes], *, columns: int) -> None:
    """Put one legend below a figure that names what its panels show, each once."""
    handles: dict[str, Any] = {}
    for panel in panels:
        for handle, label in zip(*panel.get_legend_handles_labels(), strict=True):
            handles[label] = handle
    drawn.legend(handles.values(), handles, loc="outside lower center", ncols=columns)
