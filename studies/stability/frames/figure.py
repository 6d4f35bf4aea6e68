"""The figure of what buckles: load against deflection, and the turn of the pushed pivot."""

from collections.abc import Mapping
from typing import Any

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from studies.record.style import BLACK, BLUE, GREEN, GREY, PURPLE, RED, page
from studies.stability.columns import DEFAULT, EIGHT, FE, PAPER, TWELVE
from studies.stability.frames.curves import ELASTICA, OTHER, PRIMARY, PRINT
from studies.stability.frames.questions import COLUMN, LEE, PIVOT, TOGGLE

LOOKS: dict[str, dict[str, Any]] = {
    ELASTICA: {"color": BLACK, "linewidth": 0.9},
    PRINT: {"color": BLACK, "linestyle": "", "marker": "+", "markersize": 8.0},
    PAPER: {"color": RED},
    DEFAULT: {"color": BLUE},
    EIGHT: {"color": PURPLE, "linestyle": "", "marker": "v", "markersize": 8.0, "markerfacecolor": "none"},
    TWELVE: {"color": GREEN, "linestyle": "--"},
    FE: {"color": GREY, "linestyle": "", "marker": "s", "markersize": 3.0},
}
AXES = {
    COLUMN: ("deflection of the tip across [L]", "load [Euler load]"),
    TOGGLE: ("deflection of the apex [in]", "load [lb]"),
    LEE: ("deflection below the load [cm]", "load [t]"),
    PIVOT: ("way down [mm]", "turn of the body [deg]"),
}


def figure(tables: Mapping[str, pd.DataFrame]) -> Figure:
    """Draw the four panels of the tables outcomes, curves, critical and branches."""
    drawn = page(8.6, 6.6)
    panels = dict(zip(AXES, drawn.subplots(2, 2).flat, strict=True))
    for part, panel in panels.items():
        panel.set(title=part, xlabel=AXES[part][0], ylabel=AXES[part][1])
    for part in (COLUMN, TOGGLE, LEE):
        _loads(panels[part], tables, part)
    for published in _published(tables["outcomes"], TOGGLE):
        panels[TOGGLE].axhline(published, color=BLACK, linewidth=0.6, linestyle=":")
    for published in _published(tables["outcomes"], LEE):
        panels[LEE].axhline(published, color=BLACK, linewidth=0.6, linestyle=":")
    panels[COLUMN].set(ylim=(0.0, 10.0))
    _pivot(panels[PIVOT], tables["branches"])
    handles = [Line2D([], [], label=model, **look) for model, look in LOOKS.items()]
    handles += [
        Line2D([], [], linestyle="", marker="o", color=BLACK, markerfacecolor="none", label="critical point"),
        Line2D([], [], color=BLACK, linewidth=0.6, linestyle=":", label="published limit load"),
        Line2D([], [], linestyle="", marker="x", color=BLACK, markersize=7.0, label="stopped, and says so"),
    ]
    drawn.legend(handles=handles, loc="outside lower center", ncols=5)
    return drawn


def _loads(panel: Axes, tables: Mapping[str, pd.DataFrame], part: str) -> None:
    """Draw the curves of a part and mark their critical points."""
    curves, critical = (tables[name][tables[name]["part"] == part] for name in ("curves", "critical"))
    for model, look in LOOKS.items():
        mine = curves[curves["model"] == model].sort_values("state")
        if len(mine):
            panel.plot(mine["deflection"], mine["load"], **look)
        points = critical[critical["model"] == model]
        if len(points):
            panel.plot(
                points["deflection"], points["load"], "o", color=look["color"], markerfacecolor="none",
                markersize=7.0,
            )  # fmt: skip


def _published(outcomes: pd.DataFrame, part: str) -> list[float]:
    """Return the published limit loads of a part."""
    asked = outcomes["case"].str.startswith(part) & outcomes["quantity"].str.startswith("limit load")
    return sorted(set(outcomes[asked]["published"]))


def _pivot(panel: Axes, branches: pd.DataFrame) -> None:
    """Draw the branch on which the body turns, and the one on which it does not: dotted where unstable."""
    refined = branches[(branches["model"] == TWELVE) & (branches["branch"] == PRIMARY)]
    crossing, deepest = refined["first_bifurcation_mm"].min(), refined["reached_mm"].max()
    panel.plot([0.0, crossing], [0.0, 0.0], color=BLACK, label="stable")
    panel.plot([crossing, deepest], [0.0, 0.0], color=BLACK, linestyle=":", label="unstable")
    for model, look in LOOKS.items():
        mine = branches[(branches["model"] == model) & (branches["branch"] == OTHER)].sort_values("asked_mm")
        if mine.empty:
            continue
        reached = mine[mine["says"].str.startswith("stopped") != True]  # noqa: E712 - nan: nothing is said
        panel.plot(reached["reached_mm"], reached["turn_deg"], **look)
        stopped = mine.drop(reached.index)
        if len(stopped):
            ends = {"marker": "x", "linestyle": "", "color": look["color"], "markersize": 7.0}
            panel.plot(stopped["reached_mm"], stopped["turn_deg"], **ends)
    panel.plot(crossing, 0.0, "o", color=GREEN, markerfacecolor="none", markersize=7.0)
    panel.legend(loc="upper left")
