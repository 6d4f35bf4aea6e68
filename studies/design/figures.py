"""Figures of the design charts: stiffness, shift, stress and variation, and what loads do to them."""

from collections.abc import Callable, Mapping
from dataclasses import replace

import pandas as pd
from matplotlib.figure import Figure

from studies.engine import Tables
from studies.record.marks import Level
from studies.record.panels import Axis, Curves, Panel, sheet
from studies.record.style import BLACK, BLUE, GREEN, ORANGE, SKY, Look

#: Quantity -> how it is written beside its charts.
NAMES = {
    "stiffness": "$K L/(EI)$",
    "shift": "shift/$L$",
    "stress": r"$\sigma L/(E t)$",
    "variation": "variation of $K$",
}
#: Inclinations of the columns [deg], and colours of the rotations.
DRAWN, COLOURS = (30.0, 45.0, 60.0), (BLUE, SKY, GREEN, ORANGE, BLACK)
PAGE = 6.3


def _charts(tables: Tables) -> Figure:
    """Draw a row of charts a quantity, a column an inclination, a curve a rotation."""
    rows = tables["map"]
    turns = zip(sorted(set(rows["rotation_deg"])), COLOURS, strict=True)
    looks = {turn: Look(label=f"{turn:g}°", colour=colour) for turn, colour in turns}
    ratio = Axis("crossing_ratio", "crossing ratio λ", ticks=(0.1, 0.3, 0.5, 0.7, 0.9))
    lines = []
    for name, label in NAMES.items():
        some = (rows[rows["inclination_deg"] == inclination] for inclination in DRAWN)
        lines.append(
            [Panel(ratio, Axis(name, label), [Curves(each, looks, by="rotation_deg")]) for each in some]
        )
    columns = [f"inclination {inclination:g}°" for inclination in DRAWN]
    return sheet(PAGE, 6.6, lines, columns=columns, legend=len(looks))


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


CHARTS: Mapping[str, Callable[[Tables], Figure]] = {
    "charts": _charts,
    "charts_loads": _loads,
}
