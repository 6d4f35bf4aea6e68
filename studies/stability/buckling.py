"""Compression and buckling: the column and the elastica, frames that snap through, the pivot pushed down.

Beside the outcomes: load against deflection, critical points, and the branches of the pushed pivot.
"""

import math
from collections.abc import Mapping
from itertools import product
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from studies.engine import Answer, Part
from studies.kinds import Array
from studies.published.arcs import BIFURCATION, Arc, arc_of
from studies.published.case import Frame, published
from studies.record.digits import Digits
from studies.record.style import BLACK, BLUE, GREEN, GREY, PURPLE, RED, page
from studies.stability import family, questions
from studies.stability.questions import EULER, PUBLISHED, bent_column, load_ratio, pushed_pivot, tip

ELASTICA, PRINT = "elastica", "published"
DRAWN = (family.PAPER, family.DEFAULT, family.TWELVE, family.FE)
PUSHED = (family.DEFAULT, family.EIGHT, family.TWELVE, family.FE)
#: Turn of the tip of a column that is still straight [rad].
STRAIGHT = 1e-6
PRIMARY, OTHER = "primary", "other"
#: Depths that only the figure has [m].
BETWEEN = (3e-3, 7e-3, 1.5e-2)


def _frame(part: str) -> Frame:
    """Return the frame of a part of the figure."""
    if part == questions.COLUMN:
        return bent_column(max(PUBLISHED))
    return published({questions.TOGGLE: "williams_toggle", questions.LEE: "lees_frame"}[part]).frame()


def _curve(part: str, model: str) -> Answer:
    """Return a curve and its critical points, a row a state."""
    frame = _frame(part)
    arc = arc_of(frame, family.ARCS[model], follow_branch=part == questions.COLUMN)
    critical = [
        {"part": part, "model": model, "kind": each.kind, **_at(part, frame, each.load, each.place)}
        for each in arc.critical
    ]
    return {"curves": _states(part, model, frame, arc), "critical": critical}


def _states(part: str, model: str, frame: Frame, arc: Arc) -> list[dict[str, Any]]:
    """Return the states of a path, and where it leaves a column's straight branch: its corner."""
    name = {"part": part, "model": model}
    rows = [
        {**name, "state": float(state), **_at(part, frame, float(arc.load[state]), place),
         "unstable_directions": int(arc.inertia[state])}
        for state, place in enumerate(arc.place)
    ]  # fmt: skip
    for point in arc.critical:
        if part == questions.COLUMN and point.kind == BIFURCATION:
            last = int(np.argmax(np.abs(arc.place[:, 2]) > STRAIGHT)) - 0.5
            corner = _at(part, frame, point.load, point.place)
            rows.append({**name, "state": last, **corner, "unstable_directions": 0})
    return rows


def _at(part: str, frame: Frame, load: float, place: Array) -> dict[str, float]:
    """Return load and deflection as drawn: over Euler's and the length, or in the frame's units, down."""
    if part == questions.COLUMN:
        return {"load": load / EULER, "deflection": abs(float(place[1]))}
    return {"load": load, "deflection": frame.rest[1] - float(place[1])}


def _elastica() -> list[dict[str, Any]]:
    """Return the closed form and the published loads at the deflection of their angles."""
    angles = np.linspace(0.0, math.radians(max(PUBLISHED)), 177)
    rows = []
    for model, chosen in ((ELASTICA, angles), (PRINT, np.radians(list(PUBLISHED)))):
        loads = list(PUBLISHED.values()) if model == PRINT else [load_ratio(one) for one in chosen]
        for state, (load, (_, across)) in enumerate(zip(loads, tip(chosen), strict=True)):
            at = {"load": load, "deflection": float(across)}
            rows.append({"part": questions.COLUMN, "model": model, "state": state, **at})
    return rows


def _branch(depth: float, model: str, branch: str) -> Answer:
    """Return the last state of the pushed pivot on a branch; stable where it has no unstable direction."""
    frame = pushed_pivot(depth)
    arc = arc_of(frame, family.ARCS[model], follow_branch=branch == OTHER)
    found = {
        "model": model,
        "branch": branch,
        "asked_mm": 1e3 * frame.load,
        "reached_mm": 1e3 * float(arc.load[-1]),
        "turn_deg": arc.turned,
        "energy_J": float(arc.energy[-1]),
        "unstable_directions": int(arc.inertia[-1]),
        "first_bifurcation_mm": min((1e3 * point.load for point in arc.critical), default=math.nan),
        "says": arc.message or arc.warning,
    }
    return {"branches": found}


LOOKS: dict[str, dict[str, Any]] = {
    ELASTICA: {"color": BLACK, "linewidth": 0.9},
    PRINT: {"color": BLACK, "linestyle": "", "marker": "+", "markersize": 8.0},
    family.PAPER: {"color": RED},
    family.DEFAULT: {"color": BLUE},
    family.EIGHT: {"color": PURPLE, "linestyle": "", "marker": "v", "markersize": 8.0, "fillstyle": "none"},
    family.TWELVE: {"color": GREEN, "linestyle": "--"},
    family.FE: {"color": GREY, "linestyle": "", "marker": "s", "markersize": 3.0, "markevery": 0.03},
}
AXES = {
    questions.COLUMN: ("deflection of the tip across [L]", "load [Euler load]"),
    questions.TOGGLE: ("deflection of the apex [in]", "load [lb]"),
    questions.LEE: ("deflection below the load [cm]", "load [t]"),
    questions.PIVOT: ("way down [mm]", "turn of the body [deg]"),
}


def _figure(tables: Mapping[str, pd.DataFrame]) -> Figure:
    """Draw the four panels of the tables outcomes, curves, critical and branches."""
    drawn = page(8.6, 6.6)
    panels = dict(zip(AXES, drawn.subplots(2, 2).flat, strict=True))
    for part, panel in panels.items():
        panel.set(title=part, xlabel=AXES[part][0], ylabel=AXES[part][1])
    for part in (questions.COLUMN, questions.TOGGLE, questions.LEE):
        _loads(panels[part], tables, part)
        for limit in _limits(tables["outcomes"], part):
            panels[part].axhline(limit, color=BLACK, linewidth=0.6, linestyle=":")
    panels[questions.COLUMN].set(ylim=(0.0, 10.0))
    _pivot(panels[questions.PIVOT], tables["branches"])
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


def _limits(outcomes: pd.DataFrame, part: str) -> list[float]:
    """Return the published limit loads of a part."""
    asked = outcomes["case"].str.startswith(part) & outcomes["quantity"].str.startswith("limit load")
    return sorted(set(outcomes[asked]["published"]))


def _pivot(panel: Axes, branches: pd.DataFrame) -> None:
    """Draw the branch on which the body turns, and the one on which it does not: dotted where unstable."""
    refined = branches[(branches["model"] == family.TWELVE) & (branches["branch"] == PRIMARY)]
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


#: The branch beyond 10 mm amplifies round-off, and where on a curve a state lies is up to the arc length.
DIGITS: dict[str, Digits | None] = {
    **dict.fromkeys(("curves.load", "curves.deflection"), Digits(relative=0.1, scale=0.01)),
    **dict.fromkeys(("reached_mm", "turn_deg", "energy_J"), Digits(relative=1e-3, scale=1e-5)),
    "outcomes.found": Digits(relative=1e-5, floor=1e-5, rows="outcome == 'right'"),
    "outcomes.error": Digits(relative=0.05, floor=1e-8, rows="outcome == 'right'"),
    "largest_right_error": Digits(relative=0.05),
    "warned": None,
}

STUDY = family.study(
    questions.ASKED,
    Part(ask=lambda: {"curves": _elastica()}),
    Part(at=lambda: product((questions.COLUMN, questions.TOGGLE, questions.LEE), DRAWN), ask=_curve),
    Part(at=lambda: product(sorted({*questions.DEPTHS, *BETWEEN}), PUSHED, (PRIMARY, OTHER)), ask=_branch),
    digits=DIGITS,
    figures={"stability_buckling": _figure},
)
