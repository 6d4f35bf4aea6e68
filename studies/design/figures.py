"""Figures of designs: those that are sized, to scale with their answers, the search for them, and charts to
design with, which are printed."""

import textwrap
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure

from studies.design.task import BASELINES, QUESTIONS, TABLE_ONE, WIDE
from studies.engine import Tables, records
from studies.record.marks import Contours, Level, Words
from studies.record.panels import Axis, Curves, Mark, Panel, sheet
from studies.record.style import BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, RED, SKY, Look, page

COLOURS = dict(zip((*BASELINES, *QUESTIONS), (BLACK, BLACK, BLUE, RED, SKY, ORANGE, BLUE, RED), strict=True))
STARTS = (BLACK, BLUE, RED, GREEN, ORANGE, PURPLE, SKY, GREY)
#: Answers over the rotation: column, unit's factor, label.
ANSWERS = (
    ("centre_shift_m", 1e3, "centre shift [mm]"),
    ("stiffness_Nm_per_rad", 1.0, "stiffness dT/dθ [N m / rad]"),
    ("largest_stress_Pa", 1e-9, "largest stress [GPa]"),
)


def designs(tables: Mapping[str, pd.DataFrame], baseline: str) -> Figure:
    """Draw a baseline and what was sized from it to one scale, above their answers over the rotation."""
    figure = page(11.0, 7.2)
    parts: Any = figure.subfigures(2, 1, height_ratios=(1.0, 1.15))
    above, below = parts
    names = _drawn(baseline)
    _geometry(above, tables, names)
    panels: Any = below.subplots(1, 3)
    last = round(np.degrees(tables["curves"].query("design == @baseline")["rotation_rad"].max()))
    for panel, (column, factor, label) in zip(panels, ANSWERS, strict=True):
        for name in names:
            for model, looks in (("spline", {"linestyle": "-"}), ("FE", {"linestyle": "", "marker": "o"})):
                curve = tables["curves"].query("design == @name and model == @model")
                curve = curve.sort_values("rotation_rad")
                panel.plot(
                    np.degrees(curve["rotation_rad"]),
                    factor * curve[column],
                    color=COLOURS[name],
                    markersize=3.0,
                    label=name if model == "spline" else "_",
                    **looks,
                )
        panel.set(xlabel="rotation [deg]", ylabel=label, xticks=range(0, last + 1, last // 3))
    panels[0].set_ylim(bottom=0.0)
    panels[0].plot([], [], "o", color=GREY, markersize=3.0, label="elements (lines: spline)")
    below.legend(*panels[0].get_legend_handles_labels(), loc="outside upper center", ncols=3)
    figure.draw_without_rendering()  # panels of one scale have their place after a first layout only
    return figure


def search(tables: Mapping[str, pd.DataFrame], baseline: str) -> Figure:
    """Draw objective and violation over the iterations of every start, the trade, what constraints cost."""
    figure = page(11.0, 8.6)
    names = [name for name in _drawn(baseline) if name != baseline]
    parts: Any = figure.subfigures(2, 1, height_ratios=(2.0, 1.15))
    above, below = parts
    panels: Any = above.subplots(2, len(names), sharex="col", sharey="row", squeeze=False)
    for column, name in enumerate(names):
        _search(panels[:, column], tables, name)
    panels[0, 0].set_ylabel("objective / start 0 [1]")
    panels[1, 0].set_ylabel("worst violation [1]")
    for start, colour in enumerate(STARTS[: tables["starts"]["start"].max() + 1]):
        panels[1, 0].plot([], [], color=colour, label=f"start {start}" + f" ({baseline})" * (start == 0))
    ends = (("o", BLACK, "best optimum"), ("o", "white", "another optimum"), ("x", BLACK, "no optimum"))
    for marker, face, label in ends:
        panels[1, 0].plot([], [], marker, color=BLACK, markerfacecolor=face, label=label)
    above.legend(*panels[1, 0].get_legend_handles_labels(), loc="outside upper center", ncols=6)
    trade, bars = below.subplots(1, 2, width_ratios=(1.0, 1.15))
    _trade(trade, tables)
    _prices(bars, tables, names)
    below.legend(*trade.get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return figure


def _drawn(baseline: str) -> list[str]:
    """Return a baseline and the questions that were asked of it."""
    return [baseline, *(name for name, question in QUESTIONS.items() if question.baseline == baseline)]


def _geometry(figure: SubFigure, tables: Mapping[str, pd.DataFrame], names: Sequence[str]) -> None:
    """Draw each design's strips with their thickness, and the plate between their ends."""
    panels: Any = figure.subplots(1, len(names), sharex=True, sharey=True)
    highest = 1e3 * tables["shapes"][tables["shapes"]["design"].isin(names)]["y_m"].max()
    for panel, name in zip(panels, names, strict=True):
        colour = COLOURS[name]
        design = tables["designs"].query("design == @name").iloc[0]
        for state, faint in (("at rest", 0.3), ("at the end", 1.0)):
            shape = tables["shapes"].query("design == @name and state == @state")
            origin = shape.query("station == 0")["x_m"].mean()
            ends = []
            for _, strip in shape.groupby("strip"):
                line = strip.sort_values("station")[["x_m", "y_m"]].to_numpy() - (origin, 0.0)
                outline = 1e3 * _thick(line, design["thickness_m"])
                panel.fill(*outline.T, color=colour, alpha=faint, linewidth=0.3)
                ends.append(1e3 * line[-1])
            panel.plot(*np.array(ends).T, color=GREY, linewidth=2.5, alpha=faint, zorder=1)
            if state == "at rest":
                clamps = shape.query("station == 0")["x_m"] - origin
                panel.plot(1e3 * clamps, [0.0, 0.0], color=GREY, linewidth=2.5, zorder=1)
        sizes = (
            f"L {1e3 * design['length_m']:.1f}, t {1e3 * design['thickness_m']:.2f},\n"
            f"b {1e3 * design['width_m']:.1f} mm, {np.degrees(design['inclination_rad']):.0f}°\n"
            f"λ = {design['crossing_ratio']:.3f}"
        )
        panel.set(title=_broken(name), xlabel="x [mm]", aspect="equal", anchor="S")
        text = panel.annotate(sizes, (0.5, 0.99), xycoords="axes fraction", ha="center", va="top", fontsize=7)
        text.set_in_layout(False)
        panel.set_ylim(-8.0, 1.9 * highest)
        panel.set_axisbelow(True)
    panels[0].set_ylabel("y [mm]")


def _broken(name: str) -> str:
    """Return a name in short lines."""
    return textwrap.fill(name, 18)


def _thick(line: np.ndarray, thickness: float) -> np.ndarray:
    """Return the outline (2 P, 2) of a strip about its centreline (P, 2)."""
    along = np.gradient(line, axis=0)
    across = np.column_stack((-along[:, 1], along[:, 0])) / np.hypot(*along.T)[:, None]
    return np.vstack((line + 0.5 * thickness * across, (line - 0.5 * thickness * across)[::-1]))


def _search(panels: np.ndarray, tables: Mapping[str, pd.DataFrame], name: str) -> None:
    above, below = panels
    ends = tables["starts"].query("question == @name").set_index("start")
    for start, optimum in ends["optimum"].items():
        line = tables["history"].query("question == @name and start == @start").sort_values("iteration")
        colour, last = STARTS[int(str(start))], line.iloc[-1]
        marker = "x" if optimum == 0 else "o"
        face = colour if optimum == 1 else "white"
        looks = {"color": colour, "linewidth": 0.9}
        above.semilogy(line["iteration"], line["objective_over_baseline"], **looks)
        above.plot(
            last["iteration"], last["objective_over_baseline"], marker, color=colour, markerfacecolor=face
        )
        below.semilogy(line["iteration"], line["violation"].clip(lower=1e-15), **looks)
    above.set_title(_broken(name))
    below.set(xlabel="iteration", ylim=(1e-16, 1e3))
    below.set_xscale("symlog", linthresh=10.0)


def _trade(panel: Axes, tables: Mapping[str, pd.DataFrame]) -> None:
    """Draw centre shift against variation: the trade between the least of both, and the designs."""
    trade = tables["trade"].query("status == 'optimum'")
    ends = tables["designs"][tables["designs"]["design"].isin(WIDE)]
    line = pd.concat([trade, ends])[["variation", "centre_shift_m"]].sort_values("variation")
    panel.loglog(line["variation"], 1e3 * line["centre_shift_m"], ".-", color=PURPLE, label="trade")
    for name in _drawn(TABLE_ONE):
        design = tables["designs"].query("design == @name").iloc[0]
        panel.plot(design["variation"], 1e3 * design["centre_shift_m"], "o", color=COLOURS[name], label=name)
    panel.set(xlabel="largest variation of stiffness over ±45° [1]", ylabel="largest centre shift [mm]")


def _prices(panel: Axes, tables: Mapping[str, pd.DataFrame], names: Sequence[str]) -> None:
    """Draw what each constraint costs at each optimum."""
    prices = tables["active"].pivot_table(index="constraint", columns="question", values="price")
    prices = prices.reindex(columns=list(names)).fillna(0.0)
    prices = prices[(prices.abs() > 1e-3).any(axis=1)]
    place = np.arange(len(prices))
    for i, name in enumerate(names):
        panel.barh(place + 0.2 * (1.5 - i), prices[name], height=0.18, color=COLOURS[name])
    panel.set_yticks(place, labels=[label.replace("_", " ") for label in prices.index])
    panel.axvline(0.0, color=BLACK, linewidth=0.8)
    panel.set_xscale("symlog", linthresh=1.0)
    panel.set_axisbelow(True)
    panel.set(xlabel="change of objective / of limit [%/%]")


#: Quantity -> how it is written beside its charts.
NAMES = {
    "stiffness": "$K L/(EI)$",
    "shift": "shift/$L$",
    "stress": r"$\sigma L/(E t)$",
    "variation": "variation of $K$",
}
#: Crossing ratio of least shift for small rotations (Haringx, Wittrick), which the charts mark.
LEAST_SHIFT = 0.5 - 5.0**0.5 / 6.0
PAGE = 6.3
#: Where the names of pivots stand whose neighbours are near: how far [pt], and on which side.
BESIDE = {"large steel": ((4, -10), "right"), "titanium": ((4, -10), "left")}


def _charts(quantities: tuple[str, ...], tables: Tables) -> Figure:
    """Draw a row of charts a quantity, a column a rotation, with the ratios of least shift."""
    ratio = Axis("crossing_ratio", "ratio λ", ticks=(0.2, 0.5, 0.8))
    shiftless = [Level(at, colour=ORANGE, line=":", upright=True) for at in (LEAST_SHIFT, 1.0 - LEAST_SHIFT)]
    turns = list(tables["map"].groupby("rotation_deg"))
    lines = []
    for name in quantities:
        y = Axis("inclination_deg", f"{NAMES[name]}\ninclination [°]", ticks=(30, 45, 60))
        lines.append([Panel(ratio, y, [Contours(rows, name), *shiftless]) for _, rows in turns])
    return sheet(PAGE, 1.5 * len(quantities) + 0.35, lines, columns=[f"{turn:g}°" for turn, _ in turns])


def _loads(tables: Tables) -> Figure:
    """Draw the stiffness at rest over the load by crossing ratio, and the load at which it buckles."""
    rows = tables["loads"].query("inclination_deg == 45")
    away = rows["direction"] == "away from the ground"
    rest = rows[rows["load"] == 0.0].groupby("crossing_ratio")["stiffness"].first()
    rows = rows.assign(
        load=rows["load"].where(~away, -rows["load"]),
        relative=rows["stiffness"] / rows["crossing_ratio"].map(rest),
    )
    across = rows["direction"] == "across"
    colours = dict(zip(sorted(set(rows["crossing_ratio"])), (BLUE, SKY, GREEN, ORANGE, BLACK), strict=True))
    looks = {ratio: Look(label=f"λ = {ratio:.3g}", colour=colour) for ratio, colour in colours.items()}
    load = Axis("load", "$P L^2/(EI)$")
    stiffness = Axis("relative", "$K/K(P=0)$, α = 45°")
    panels = (
        Panel(
            replace(load, label="$P L^2/(EI)$, + to the ground"), stiffness, title="along the axis",
            marks=(Curves(rows[~across], looks, by="crossing_ratio"), Level(0.0))
        ),
        Panel(
            load, replace(stiffness, label=""), title="across it",
            marks=(Curves(rows[across], looks, by="crossing_ratio"),)
        ),
        _buckling(tables["buckling"]),
    )  # fmt: skip
    return sheet(PAGE, 2.5, [panels], legend=5)


def _buckling(rows: pd.DataFrame) -> Panel:
    """Return the loads to the ground at which pivots buckle, over the crossing ratio by inclination."""
    looks = {
        inclination: Look(label=f"α = {inclination:g}°", colour=BLACK, line=line, marker="o")
        for inclination, line in ((30.0, ":"), (45.0, "-"), (60.0, "--"))
    }
    return Panel(
        Axis("crossing_ratio", "crossing ratio λ"),
        Axis("load", "buckling $P L^2/(EI)$", limits=(0.0, None)),
        (Curves(rows, looks, by="inclination_deg"),),
        title="to the ground",
    )


def _validity(tables: Tables) -> Figure:
    """Draw where a plain beam is off by a percent: width and thickness over length, with pivots marked."""
    marks: list[Mark] = []
    for row in records(tables["limits"]):
        line, share = "-" if row["share"] < 0.02 else "--", f"{row['share']:.0%}"
        if row["ratio"] == "width_ratio":
            place, words = (row["value"], 0.18), f"clamped width {share}"
            marks.append(Level(row["value"], colour=GREEN, line=line, upright=True))
            marks.append(Words(words, place, by=(2, 0), colour=GREEN, turned=True))
        elif row["ratio"] == "thickness_ratio":
            place, words = (0.7, row["value"]), f"roots of one block {share}"
            marks.append(Level(row["value"], colour=PURPLE, line=line))
            marks.append(Words(words, place, by=(0, 2), colour=PURPLE))
    marks.append(Curves(tables["validity"], Look(label="_", colour=BLACK, line="", marker="o")))
    for row in records(tables["validity"]):
        text = row["pivot"].removesuffix("_pivot").replace("_", " ")
        by, side = BESIDE.get(text, ((4, 4), "left"))
        place = (row["width_ratio"], row["thickness_ratio"])
        marks.append(Words(text, place, by=by, colour=BLACK, side=side))
    panel = Panel(
        Axis("width_ratio", "width over length $b/L$", log=True, limits=(0.02, 2.0)),
        Axis("thickness_ratio", "thickness over length $t/L$", log=True, limits=(2.5e-3, 0.2)),
        marks,
    )
    return sheet(PAGE, 3.1, [[panel]])


CHARTS: Mapping[str, Callable[[Tables], Figure]] = {
    "charts_motion": lambda tables: _charts(("stiffness", "shift"), tables),
    "charts_strength": lambda tables: _charts(("stress", "variation"), tables),
    "charts_loads": _loads,
    "charts_validity": _validity,
}
