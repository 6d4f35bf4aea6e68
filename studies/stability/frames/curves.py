"""Load against deflection of what buckles, its critical points, and the branches of the pushed pivot."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd

from studies.kinds import Array
from studies.stability.columns import COLUMNS, DEFAULT, EIGHT, FE, FINER, PAPER, TWELVE
from studies.stability.frames import elastica
from studies.stability.frames.arcs import Arc
from studies.stability.frames.designs import Frame, lees_frame, toggle
from studies.stability.frames.elastica import EULER, PUBLISHED
from studies.stability.frames.questions import (
    BIFURCATION,
    COLUMN,
    DEPTHS,
    LEE,
    TOGGLE,
    BucklingCase,
    answer,
    post_buckling,
    pushed,
    turned,
)

ELASTICA, PRINT = "elastica", "published"
DRAWN = (PAPER, DEFAULT, TWELVE, FE)
PUSHED = (DEFAULT, EIGHT, TWELVE, FE)
#: Turn of the tip of a column that is still straight [rad].
STRAIGHT = 1e-6
PRIMARY, OTHER = "primary", "other"
#: Depths that only the figure has [m].
BETWEEN = (3e-3, 7e-3, 1.5e-2)


def tables() -> dict[str, pd.DataFrame]:
    """Return curves and critical points (a row a state) and branches (a row a depth, model and branch)."""
    column = post_buckling(max(PUBLISHED))
    curves, critical = _elastica(), []
    for part, case in {
        COLUMN: column,
        TOGGLE: _plain(column, toggle(rise=0.386)),
        LEE: _plain(column, lees_frame()),
    }.items():
        for model in DRAWN:
            arc = answer(case, (COLUMNS | FINER)[model])
            curves += _states(part, model, case.frame, arc)
            for point in arc.critical:
                at = _at(part, case.frame, point.load, point.place)
                critical.append({"part": part, "model": model, "kind": point.kind, **at})
    branches = [
        _branch(pushed(depth), model, branch)
        for depth in sorted({*DEPTHS, *BETWEEN})
        for model in PUSHED
        for branch in (PRIMARY, OTHER)
    ]
    return {
        "curves": pd.DataFrame(curves),
        "critical": pd.DataFrame(critical),
        "branches": pd.DataFrame(branches),
    }


def _plain(case: BucklingCase, frame: Frame) -> BucklingCase:
    """Return the case of another frame, on its primary branch."""
    return replace(case, frame=frame, bent=None, branch="primary")


def _states(part: str, model: str, frame: Frame, arc: Arc) -> list[dict[str, Any]]:
    """Return the states of a path, and where it leaves a column's straight branch: its corner."""
    name = {"part": part, "model": model}
    rows = [
        {**name, "state": float(state), **_at(part, frame, float(arc.load[state]), place),
         "unstable_directions": int(arc.inertia[state])}
        for state, place in enumerate(arc.place)
    ]  # fmt: skip
    for point in arc.critical:
        if part == COLUMN and point.kind == BIFURCATION:
            last = int(np.argmax(np.abs(arc.place[:, 2]) > STRAIGHT)) - 0.5
            corner = _at(part, frame, point.load, point.place)
            rows.append({**name, "state": last, **corner, "unstable_directions": 0})
    return rows


def _at(part: str, frame: Frame, load: float, place: Array) -> dict[str, float]:
    """Return load and deflection as drawn: over Euler's and the length, or in the frame's units, down."""
    if part == COLUMN:
        return {"load": load / EULER, "deflection": abs(float(place[1]))}
    rest = next(body.centre for body in frame.design.bodies if body.name == frame.body)
    return {"load": load, "deflection": rest[1] - float(place[1])}


def _elastica() -> list[dict[str, Any]]:
    """Return the closed form and the published loads at the deflection of their angles."""
    angles = np.linspace(0.0, math.radians(max(PUBLISHED)), 177)
    rows = []
    for model, chosen in ((ELASTICA, angles), (PRINT, np.radians(list(PUBLISHED)))):
        loads = list(PUBLISHED.values()) if model == PRINT else [elastica.load_ratio(one) for one in chosen]
        for state, (load, (_, across)) in enumerate(zip(loads, elastica.tip(chosen), strict=True)):
            rows.append(
                {"part": COLUMN, "model": model, "state": state, "load": load, "deflection": float(across)}
            )
    return rows


def _branch(case: BucklingCase, model: str, branch: str) -> dict[str, Any]:
    """Return the last state of the pushed pivot on a branch; stable where it has no unstable direction."""
    asked = replace(case, branch="primary", tilt=0.0) if branch == PRIMARY else case
    arc: Arc = answer(asked, (COLUMNS | FINER)[model])
    return {
        "model": model,
        "branch": branch,
        "asked_mm": 1e3 * case.frame.load,
        "reached_mm": 1e3 * float(arc.load[-1]),
        "turn_deg": turned(arc),
        "energy_J": float(arc.energy[-1]),
        "unstable_directions": int(arc.inertia[-1]),
        "first_bifurcation_mm": min((1e3 * point.load for point in arc.critical), default=math.nan),
        "says": arc.message or arc.warning,
    }
