"""Compression and buckling: the column and the elastica, frames that snap through, the pivot pushed down.

Beside the outcomes: load against deflection, critical points, and the branches of the pushed pivot.
"""

import math
from itertools import product
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from studies.engine import Answer, Part, Row, Tables
from studies.kinds import Array
from studies.published.arcs import BIFURCATION, arc_of
from studies.published.case import published
from studies.record.marks import Level
from studies.record.panels import Axis, Curves, Mark, Panel, sheet
from studies.record.store import Digits
from studies.record.style import BLACK, BLUE, GREEN, GREY, PURPLE, RED, Look
from studies.stability import questions
from studies.stability.questions import EULER, PUBLISHED, bent_column, load_ratio, pushed_pivot, tip
from studies.stability.verdict import ARCS, DEFAULT, EIGHT, FE, PAPER, TWELVE, study

ELASTICA, PRINT = "elastica", "published"
DRAWN = (PAPER, DEFAULT, TWELVE, FE)
PUSHED = (DEFAULT, EIGHT, TWELVE, FE)
#: Turn of the tip of a column that is still straight [rad].
STRAIGHT = 1e-6
PRIMARY, OTHER = "primary", "other"
#: Depths that only the figure has [m].
BETWEEN = (3e-3, 7e-3, 1.5e-2)


def _curve(part: str, model: str) -> Answer:
    """Return a curve, a row a state, and its critical points; a column's corner where it leaves the straight
    branch is a state as well."""
    names = {questions.TOGGLE: "williams_toggle", questions.LEE: "lees_frame"}
    column = part == questions.COLUMN
    frame = bent_column(max(PUBLISHED)) if column else published(names[part]).frame()
    arc = arc_of(frame, ARCS[model], follow_branch=column)

    def at(load: float, place: Array, **which: Any) -> Row:
        """Return load and deflection over Euler's and the length, or in the frame's units, down."""
        deflection = abs(float(place[1])) if column else frame.rest[1] - float(place[1])
        scaled = load / EULER if column else load
        return {"part": part, "model": model, **which, "load": scaled, "deflection": deflection}

    states = enumerate(zip(map(float, arc.load), arc.place, arc.inertia, strict=True))
    rows = [
        at(load, place, state=float(state)) | {"unstable_directions": int(inertia)}
        for state, (load, place, inertia) in states
    ]
    for point in arc.critical if column else ():
        if point.kind == BIFURCATION:
            last = int(np.argmax(np.abs(arc.place[:, 2]) > STRAIGHT)) - 0.5
            rows.append(at(point.load, point.place, state=last) | {"unstable_directions": 0})
    critical = [at(point.load, point.place, kind=point.kind) for point in arc.critical]
    return {"curves": rows, "critical": critical}


def _elastica() -> list[Row]:
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
    arc = arc_of(frame, ARCS[model], follow_branch=branch == OTHER)
    found = {
        "model": model,
        "branch": branch,
        "asked_mm": 1e3 * frame.load,
        "reached_mm": 1e3 * float(arc.load[-1]),
        "turn_deg": arc.turned,
        "energy_J": float(arc.energy[-1]),
        "unstable_directions": int(arc.inertia[-1]),
        "first_bifurcation_mm": min((1e3 * point.load for point in arc.critical), default=math.nan),
        "says": arc.message or arc.resolution,
    }
    return {"branches": found}


LOOKS = {
    ELASTICA: Look(label=ELASTICA, colour=BLACK),
    PRINT: Look(label=PRINT, colour=BLACK, line="", marker="P", hollow=True),
    PAPER: Look(label=PAPER, colour=RED),
    DEFAULT: Look(label=DEFAULT, colour=BLUE),
    EIGHT: Look(label=EIGHT, colour=PURPLE, line="", marker="v", hollow=True),
    TWELVE: Look(label=TWELVE, colour=GREEN, line="--"),
    FE: Look(label=FE, colour=GREY, line=":"),
}
#: Looks of critical points, and of where a path stopped, by model.
CRITICAL, STOPPED = (
    {
        name: Look(label=label, colour=look.colour, line="", marker=marker, hollow=True)
        for name, look in LOOKS.items()
    }
    for label, marker in (("critical point", "o"), ("stopped with a message", "x"))
)
AXES = {
    questions.COLUMN: ("deflection of the tip across [L]", "load [Euler load]", (0.0, 10.0)),
    questions.TOGGLE: ("deflection of the apex [in]", "load [lb]", (None, None)),
    questions.LEE: ("deflection below the load [cm]", "load [t]", (None, None)),
}
DOWN, TURN = Axis("reached_mm", "way down [mm]"), Axis("turn_deg", "turn of the body [deg]")
LARGE = {"markersize": 7.0}


def _figure(tables: Tables) -> Figure:
    """Draw the four panels of the tables outcomes, curves, critical and branches."""
    column, toggle, lee = (_loads(tables, part) for part in AXES)
    return sheet(8.6, 6.6, [[column, toggle], [lee, _pivot(tables["branches"])]], legend=4)


def _loads(tables: Tables, part: str) -> Panel:
    """Return the curves of a part with their critical points and the published limit loads."""
    curves, critical = (tables[name][tables[name]["part"] == part] for name in ("curves", "critical"))
    outcomes = tables["outcomes"]
    asked = outcomes["case"].str.startswith(part) & outcomes["quantity"].str.startswith("limit load")
    levels = sorted(set(outcomes[asked]["published"]), reverse=True)
    along, up, limits = AXES[part]
    marks: tuple[Mark, ...] = (
        Curves(curves, LOOKS, by="model", along="state"),
        Curves(critical, CRITICAL, by="model", more=LARGE),
        *(Level(level, "" if k else "published", line=":") for k, level in enumerate(levels)),
    )
    return Panel(Axis("deflection", along), Axis("load", up, limits=limits), marks, title=part)


def _pivot(branches: pd.DataFrame) -> Panel:
    """Return the branch on which the body turns, and the one on which it does not: dotted where unstable."""
    refined = branches[(branches["model"] == TWELVE) & (branches["branch"] == PRIMARY)]
    crossing, deepest = refined["first_bifurcation_mm"].min(), refined["reached_mm"].max()
    other = branches[branches["branch"] == OTHER]
    stopped = other["says"].fillna("").str.startswith("stopped")
    ways = {"stable": ("-", 0.0, crossing), "unstable": (":", crossing, deepest)}
    marks = [
        Curves(pd.DataFrame({"reached_mm": ends, "turn_deg": 0.0}), Look(label=name, colour=BLACK, line=line))
        for name, (line, *ends) in ways.items()
    ]
    marks += [
        Curves(other[~stopped], LOOKS, by="model", along="asked_mm"),
        Curves(other[stopped], STOPPED, by="model", more=LARGE),
        Curves(pd.DataFrame({"reached_mm": [crossing], "turn_deg": 0.0}), CRITICAL[TWELVE], more=LARGE),
    ]
    return Panel(DOWN, TURN, marks, title=questions.PIVOT)


#: The branch beyond 10 mm amplifies round-off, and where on a curve a state lies is up to the arc length.
DIGITS: dict[str, Digits | None] = {
    **dict.fromkeys(("curves.load", "curves.deflection"), Digits(relative=0.1, scale=0.01)),
    **dict.fromkeys(("reached_mm", "turn_deg", "energy_J"), Digits(relative=1e-3, scale=1e-5)),
    "outcomes.found": Digits(relative=1e-5, floor=1e-5, rows="outcome == 'right'"),
    "outcomes.error": Digits(relative=0.05, floor=1e-8, rows="outcome == 'right'"),
    "largest_right_error": Digits(relative=0.05),
    "warned": None,
}

STUDY = study(
    questions.ASKED,
    Part(ask=lambda: {"curves": _elastica()}),
    Part(at=lambda: product((questions.COLUMN, questions.TOGGLE, questions.LEE), DRAWN), ask=_curve),
    Part(at=lambda: product(sorted({*questions.DEPTHS, *BETWEEN}), PUSHED, (PRIMARY, OTHER)), ask=_branch),
    digits=DIGITS,
    figures={"stability_buckling": _figure},
)
