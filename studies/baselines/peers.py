"""Other codes beside the spline: errors and times of the static path and of the free swing, in one run.

Every error is against the limit of the code's own rod theory, with or without shear; how far the two are
apart, and how far the codes' finest answers are from the limits, stands in the tables `theories` and
`swing_theories`. Times are compared at equal error: the fastest of each group that reaches a level, and keeps
it at finer meshes or steps, over the fastest spline that does. The suite's own elements and the surrogates
stand beside the codes, so that one run, one limit and one criterion hold for all.
"""

import importlib.metadata
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from studies.baselines.compared import (
    AS_DELIVERED,
    EXUDYN,
    HINT,
    OPENSEES,
    SURROGATE,
    compared_paths,
    compared_swings,
    kept,
    missing,
)
from studies.baselines.exudyn_strips import exudyn_ancf
from studies.baselines.openseespy import openseespy_frame
from studies.cases.problem import named_case
from studies.engine import Answer, Claim, Part, Study, Tables, records
from studies.record.marks import Level
from studies.record.panels import Axis, Curves, Panel, sheet
from studies.record.style import BLACK, BLUE, ORANGE, PURPLE, YELLOW, Look
from studies.work_precision.limits import path_limits, swing_limits
from studies.work_precision.series import ELEMENTS, SPLINE

GROUPS = (ELEMENTS, EXUDYN, AS_DELIVERED, OPENSEES, SURROGATE)

#: Median and quartiles of a time, and the columns that they come from.
TIMES = {"s": "solve_s", "low_s": "low_s", "high_s": "high_s"}

#: A limit must be this much more certain than the level that errors against it are compared at.
CERTAINTY = 2.0
#: How all variants are drawn behind the fastest: marks alone, without a name.
FAINT = {"linestyle": "", "alpha": 0.35, "label": None}


def _ratios(
    rows: pd.DataFrame,
    times: pd.DataFrame,
    error: str,
    levels: Iterable[float],
    unsure: str | None = None,
) -> pd.DataFrame:
    """Return a row a level and group: the fastest variants, their times [s] and the ratio.

    Where no variant of a group gets there, `tried_s` says how long the longest of them took.

    Args:
        rows: model, group, variant, status and the column `error`; times: model, variant, solve_s.
        error: column that must not be above the level.
        levels: errors asked for.
        unsure: column with the uncertainty of what errors are against; a level that is not `CERTAINTY` times
            as large leaves the row out.
    """
    joined = rows[rows["status"] == "converged"].merge(times, on=["model", "variant"])
    groups = [group for group in GROUPS if group in set(rows["group"])]
    found = []
    for level in levels:
        sure = joined if unsure is None else joined[CERTAINTY * joined[unsure] <= level]
        spline = _fastest(sure, SPLINE, error, level)
        for group in groups:
            peer = _fastest(sure, group, error, level)
            found.append(
                {
                    "level": level,
                    "group": group,
                    "peer": peer["name"],
                    **{f"peer_{name}": peer[name] for name in TIMES},
                    "spline": spline["name"],
                    **{f"spline_{name}": spline[name] for name in TIMES},
                    "ratio": peer["s"] / spline["s"],
                    "tried_s": sure.loc[sure["group"] == group, "solve_s"].max(),
                }
            )
    return pd.DataFrame(found)


def _fastest(joined: pd.DataFrame, group: str, error: str, level: float) -> dict[str, Any]:
    """Return name and time of the fastest variant of a group within the level; NaN when none is."""
    within = joined[(joined["group"] == group) & (joined[error] <= level)]
    if within.empty:
        return {"name": "none"} | dict.fromkeys(TIMES, np.nan)
    best = within.sort_values("solve_s").iloc[0]
    setting = best["variant"] if isinstance(best["variant"], str) and best["variant"] else "closed form"
    return {"name": f"{best['model']}, {setting}"} | {name: float(best[TIMES[name]]) for name in TIMES}


#: Looks by model and group: a colour a code, a marker a beam.
LOOKS = {
    ("spline", SPLINE): Look(label="spline", colour=BLUE, marker="x"),
    ("finite elements", ELEMENTS): Look(label="finite elements", colour=BLACK, marker="s"),
    ("exudyn ancf", EXUDYN): Look(label="Exudyn, ANCF cable", colour=PURPLE, marker="^"),
    ("exudyn exact", EXUDYN): Look(label="Exudyn, geometrically exact", colour=PURPLE, marker="v"),
    ("exudyn ancf", AS_DELIVERED): Look(label="Exudyn as delivered, ANCF cable", colour=YELLOW, marker="^"),
    ("exudyn exact", AS_DELIVERED): Look(
        label="Exudyn as delivered, geometrically exact", colour=YELLOW, marker="v"
    ),
    ("openseespy frame", OPENSEES): Look(label="OpenSees, corotational frame", colour=ORANGE, marker="<"),
}


def _work_precision(tables: Tables) -> Figure:
    """Draw every setting as a point and the best of each model as a line, for the path and the swing."""
    path = Axis("worst", "larger error of trajectory and torque [1]", log=True)
    swing = Axis("rotation_rad", "largest error of the rotation [rad]", log=True)
    doubts = [
        Level(row["rotation_rad"], words=f"uncertainty of the limit {row['theory']}", line=":", place=0.99)
        for row in records(tables["swing_theories"].query("what == 'uncertainty'"))
    ]
    panels = [
        _panel(tables, "statics", path, "Static path to 90° in 20 increments"),
        _panel(tables, "swings", swing, "Free swing of 0.05 s from 90°", *doubts),
    ]
    title = "Each against the limit of its own theory; points: all settings tried; lines: the best of them"
    return sheet(9.5, 4.6, [panels], title=title, legend=3)


def _panel(tables: Tables, task: str, y: Axis, title: str, *marks: Level) -> Panel:
    """Return the panel of a task: all settings that converged, and of each model and beam those that none
    that is faster betters."""
    rows, times = tables[task], tables[f"{task}_timings"]
    rows = rows[rows["status"] == "converged"].merge(times, on=["model", "variant"]).sort_values("solve_s")
    best = rows[rows[y.column] <= rows.groupby(["model", "group"])[y.column].cummin()]
    return Panel(
        Axis("solve_s", "time of the solver [ms]", factor=1e3, log=True),
        y,
        (
            Curves(rows, LOOKS, by=("model", "group"), more=FAINT),
            Curves(best, LOOKS, by=("model", "group")),
            *marks,
        ),
        title=title,
    )


#: Errors at which times are compared: of the path [1], and of the swing [rad].
LEVELS = (1e-1, 1e-2, 1e-3, 2e-4, 1e-5, 1e-6)
SWING_LEVELS = (1e-1, 2e-2, 1e-2, 5e-3, 2e-3)
#: Level -> ratio to the fastest Exudyn that the suite set out for.
AIMS = {2e-4: 50.0, 1e-6: 100.0}
SWING_AIMS = {1e-2: 20.0}


def _paths() -> Answer:
    """Return theories, errors and times of the static path."""
    limits, theories = path_limits(named_case())
    rows, times = compared_paths(named_case(), limits)
    return {"theories": theories, "statics": rows, "statics_timings": times}


def _motions() -> Answer:
    """Return theories, errors and times of the swing."""
    limits, theories = swing_limits(named_case())
    uncertainty = {row["theory"]: row["rotation_rad"] for row in theories if row["theory"]}
    rows, times = compared_swings(named_case(), limits, uncertainty)
    return {"swing_theories": theories, "swings": rows, "swings_timings": times}


def _path_ratios(tables: Tables) -> pd.DataFrame:
    return _ratios(kept(tables["statics"], "worst"), tables["statics_timings"], "worst", LEVELS)


def _swing_ratios(tables: Tables) -> pd.DataFrame:
    rows = kept(tables["swings"], "rotation_rad")
    return _ratios(rows, tables["swings_timings"], "rotation_rad", SWING_LEVELS, unsure="uncertainty_rad")


def _codes() -> list[dict[str, str]]:
    """Return which of the other codes are there, and in which version."""
    rows = []
    for package, module in (("exudyn", exudyn_ancf), ("openseespy", openseespy_frame)):
        there = module.installed()
        rows.append(
            {
                "code": package,
                "status": "installed" if there else "not installed",
                "version": importlib.metadata.version(package) if there else "",
                "hint": "" if there else HINT,
            }
        )
    return rows


def _wanted(task: str, rows: pd.DataFrame, aims: Mapping[float, float]) -> list[dict[str, Any]]:
    """Return the ratios to Exudyn that were aimed at."""
    found = rows[(rows["group"] == EXUDYN) & rows["level"].isin(list(aims))].dropna(subset="ratio")
    return [{**row, "task": task, "aim": aims[row["level"]]} for row in records(found)]


STUDY = Study(
    parts=(
        Part(ask=lambda: {"codes": _codes()}),
        Part(ask=_paths, alone=True),
        Part(ask=_motions, alone=True),
    ),
    made={"statics_ratios": _path_ratios, "swings_ratios": _swing_ratios},
    claims_of_time=(
        Claim(
            claim="The spline is at least {aim:g} x faster than the fastest Exudyn at equal error",
            formulation="{task}, errors of {level:g}",
            quantity="the time of Exudyn over the spline's",
            rows=lambda tables: [
                *_wanted("static path", tables["statics_ratios"], AIMS),
                *_wanted("free swing of 0.05 s", tables["swings_ratios"], SWING_AIMS),
            ],
            value="ratio",
            holds=lambda row: row["ratio"] >= row["aim"],
        ),
    ),
    varying=("statics_ratios", "swings_ratios"),
    figures={"peers": _work_precision},
    missing=missing,
)
