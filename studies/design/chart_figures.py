"""The design charts as they are printed: contours over crossing ratio and inclination, loads, validity."""

from collections.abc import Callable, Mapping
from dataclasses import replace

import pandas as pd
from matplotlib.figure import Figure

from studies.engine.study import Tables, records
from studies.record.marks import Contours, Level, Words
from studies.record.panels import Axis, Curves, Mark, Panel, sheet
from studies.record.style import BLACK, BLUE, GREEN, ORANGE, PURPLE, SKY, Look

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


def _charts(quantities: tuple[str, ...], tables: Tables) -> Figure:
    """Draw a row of charts a quantity, a column a rotation, with the ratios of least shift."""
    ratio = Axis("crossing_ratio", "ratio λ", ticks=(0.2, 0.5, 0.8))
    shiftless = [Level(at, colour=ORANGE, line=":", upright=True) for at in (LEAST_SHIFT, 1.0 - LEAST_SHIFT)]
    turns = list(tables["map"].groupby("rotation_deg"))
    lines = []
    for name in quantities:
        y = Axis("inclination_deg", f"{NAMES[name]}\ninclination [°]", ticks=(30, 45, 60))
        lines.append([Panel(ratio, y, [Contours(rows, name), *shiftless]) for _, rows in turns])
    return sheet(WIDTH, 1.5 * len(quantities) + 0.35, lines, columns=[f"{turn:g}°" for turn, _ in turns])


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
    return sheet(WIDTH, 2.5, [panels], legend=5)


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
    return sheet(WIDTH, 3.1, [[panel]])


DRAWN: Mapping[str, Callable[[Tables], Figure]] = {
    "charts_motion": lambda tables: _charts(("stiffness", "shift"), tables),
    "charts_strength": lambda tables: _charts(("stress", "variation"), tables),
    "charts_loads": _loads,
    "charts_validity": _validity,
}
