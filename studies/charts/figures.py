"""The design charts as they are printed: contours over crossing ratio and inclination, loads, validity."""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from studies.engine.study import Tables
from studies.record.style import BLACK, BLUE, GREEN, ORANGE, PURPLE, SKY, page

#: Quantity -> how it is written beside its charts.
NAMES = {
    "stiffness": "$K L/(EI)$",
    "shift": "shift/$L$",
    "stress": r"$\sigma L/(E t)$",
    "variation": "variation of $K$",
}
#: Crossing ratio of least shift for small rotations (Haringx, Wittrick), which the charts mark.
LEAST_SHIFT = 0.5 - 5.0**0.5 / 6.0
WIDTH = 6.3
#: Where the names of pivots stand whose neighbours are near: how far [pt], and on which side.
BESIDE = {"large steel": ((4, -10), "right"), "titanium": ((4, -10), "left")}


def _charts(rows: tuple[str, ...], tables: Tables) -> Figure:
    """Draw a row of charts a quantity, a column a rotation."""
    table = tables["map"]
    turns = sorted(set(table["rotation_deg"]))
    drawn = page(WIDTH, 1.5 * len(rows) + 0.35)
    panels = drawn.subplots(len(rows), len(turns), sharex=True, sharey=True, squeeze=False)
    for line, name in zip(panels, rows, strict=True):
        for panel, turn in zip(line, turns, strict=True):
            _chart(panel, table[table["rotation_deg"] == turn], name)
        line[0].set_ylabel(f"{NAMES[name]}\ninclination [°]")
    for panel, turn in zip(panels[0], turns, strict=True):
        panel.set_title(f"{turn:g}°")
    drawn.supxlabel("crossing ratio λ", fontsize=8)
    return drawn


def _chart(panel: Axes, rows: pd.DataFrame, name: str) -> None:
    grid: Any = rows.pivot(index="inclination_deg", columns="crossing_ratio", values=name)
    levels = MaxNLocator(4, steps=(1, 2, 2.5, 5, 10)).tick_values(
        grid.to_numpy().min(), grid.to_numpy().max()
    )
    lines = panel.contour(grid.columns, grid.index, grid, levels=levels, colors=BLUE, linewidths=0.8)
    for said in panel.clabel(lines, fontsize=7, inline_spacing=1, fmt=lambda value: f"{value:.3g}"):
        said.set_clip_on(False)
    panel.axvline(LEAST_SHIFT, color=ORANGE, linewidth=0.7, linestyle=":")
    panel.axvline(1.0 - LEAST_SHIFT, color=ORANGE, linewidth=0.7, linestyle=":")
    panel.grid(visible=False)
    panel.set(xticks=(0.2, 0.5, 0.8), yticks=(30, 45, 60))


def _loads(tables: Tables) -> Figure:
    """Draw the stiffness at rest over the load by crossing ratio, and the load at which it buckles."""
    drawn = page(WIDTH, 2.5)
    along, across, most = drawn.subplots(1, 3)
    rows = tables["loads"].query("inclination_deg == 45")
    colours = dict(zip(sorted(set(rows["crossing_ratio"])), (BLUE, SKY, GREEN, ORANGE, BLACK), strict=True))
    for ratio, colour in colours.items():
        own = rows[rows["crossing_ratio"] == ratio].set_index("direction")
        away, towards = own.loc["away from the ground"], own.loc["towards the ground"]
        load = np.r_[-away["load"].to_numpy()[::-1], towards["load"].to_numpy()[1:]]
        stiffness = np.r_[away["stiffness"].to_numpy()[::-1], towards["stiffness"].to_numpy()[1:]]
        along.plot(load, stiffness / away["stiffness"].iloc[0], color=colour, label=f"λ = {ratio:.3g}")
        side = own.loc["across"]
        across.plot(side["load"], side["stiffness"] / side["stiffness"].iloc[0], color=colour)
    along.axhline(0.0, color=BLACK, linewidth=0.8)
    along.set(xlabel="$P L^2/(EI)$, + to the ground", ylabel="$K/K(P=0)$, α = 45°", title="along the axis")
    across.set(xlabel="$P L^2/(EI)$", title="across it")
    for inclination, look in ((30.0, ":"), (45.0, "-"), (60.0, "--")):
        own = tables["buckling"].query("inclination_deg == @a", local_dict={"a": inclination})
        most.plot(
            own["crossing_ratio"], own["load"], look, marker="o", color=BLACK, label=f"{inclination:g}°"
        )
    most.set(xlabel="crossing ratio λ", ylabel="buckling $P L^2/(EI)$", title="to the ground", ylim=(0, None))
    most.legend(title="inclination", title_fontsize=8)
    drawn.legend(*along.get_legend_handles_labels(), loc="outside lower center", ncols=5, columnspacing=1.0)
    return drawn


def _validity(tables: Tables) -> Figure:
    """Draw where a plain beam is off by a percent: width and thickness over length, with pivots marked."""
    drawn = page(WIDTH, 3.1)
    panel = drawn.subplots()
    rows = tables["validity"]
    for row in tables["limits"].to_dict("records"):
        line, share = "-" if row["share"] < 0.02 else "--", f"{row['share']:.0%}"
        if row["ratio"] == "width_ratio":
            panel.axvline(row["value"], color=GREEN, linestyle=line)
            at, text = (row["value"], 0.18), f"clamped width {share}"
            panel.annotate(text, at, (2, 0), textcoords="offset points", rotation=90, va="top",
                           fontsize=8, color=GREEN)  # fmt: skip
        elif row["ratio"] == "thickness_ratio":
            panel.axhline(row["value"], color=PURPLE, linestyle=line)
            panel.annotate(f"roots of one block {share}", (0.7, row["value"]), (0, 2),
                           textcoords="offset points", fontsize=8, color=PURPLE)  # fmt: skip
    for row in rows.to_dict("records"):
        place = (row["width_ratio"], row["thickness_ratio"])
        panel.plot(*place, "o", color=BLACK)
        text = row["pivot"].removesuffix("_pivot").replace("_", " ")
        by, side = BESIDE.get(text, ((4, 4), "left"))
        panel.annotate(text, place, by, textcoords="offset points", fontsize=8, ha=side)
    panel.set(xscale="log", yscale="log", xlim=(0.02, 2.0), ylim=(2.5e-3, 0.2))
    panel.set(xlabel="width over length $b/L$", ylabel="thickness over length $t/L$")
    return drawn


DRAWN: Mapping[str, Callable[[Tables], Figure]] = {
    "charts_motion": lambda tables: _charts(("stiffness", "shift"), tables),
    "charts_strength": lambda tables: _charts(("stress", "variation"), tables),
    "charts_loads": _loads,
    "charts_validity": _validity,
}
