"""Other codes beside the spline: errors and times of the static path and of the free swing, in one run.

Every error is against the limit of the code's own rod theory, with or without shear; how far the two are
apart, and how far the codes' finest answers are from the limits, stands in the tables `theories` and
`swing_theories`. Times are compared at equal error: the fastest of each group that reaches a level, and keeps
it at finer meshes or steps, over the fastest spline that does. The suite's own elements and the surrogates
stand beside the codes, so that one run, one limit and one criterion hold for all.
"""

import importlib.metadata
from collections.abc import Iterable
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
from studies.engine import Answer, Part, Study, Tables, records
from studies.record.marks import Level
from studies.record.panels import Axis, Curves, Panel, sheet
from studies.record.style import BLACK, BLUE, ORANGE, PURPLE, Look
from studies.work_precision.limits import path_limits, swing_limits
from studies.work_precision.series import ELEMENTS, SPLINE

GROUPS = (ELEMENTS, EXUDYN, AS_DELIVERED, OPENSEES, SURROGATE)

#: Median and quartiles of a time, and the columns that they come from.
TIMES = {"s": "solve_s", "low_s": "low_s", "high_s": "high_s"}

#: A limit must be this much more certain than the level that errors against it are compared at.
CERTAINTY = 2.0


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


#: Looks by group: a colour a code.
LOOKS = {
    SPLINE: Look(label="spline", colour=BLUE, marker="x"),
    ELEMENTS: Look(label="finite elements", colour=BLACK, marker="s"),
    EXUDYN: Look(label="Exudyn, tuned", colour=PURPLE, marker="^"),
    AS_DELIVERED: Look(label="Exudyn as delivered", colour=PURPLE, line=":", marker="v"),
    OPENSEES: Look(label="OpenSees", colour=ORANGE, line="--", marker="<"),
}


def _fastest_of_all(tables: Tables) -> Figure:
    """Draw the error over the time of the best settings of each group, for the path and the swing."""
    path = Axis("worst", "larger error of trajectory and torque [1]", log=True)
    swing = Axis("rotation_rad", "largest error of the rotation [rad]", log=True)
    unsure = {
        row["theory"]: row["rotation_rad"]
        for row in records(tables["swing_theories"].query("what == 'uncertainty'"))
    }
    doubts = [Level(level, words=theory, line=":", place=1.0) for theory, level in unsure.items()]
    panels = [
        _panel(tables, "statics", path, "Static path to 90° in 20 increments"),
        _panel(tables, "swings", swing, "Free swing of 0.05 s from 90°", *doubts),
    ]
    return sheet(9.5, 4.2, [panels], legend=5)


def _panel(tables: Tables, task: str, y: Axis, title: str, *marks: Level) -> Panel:
    """Return the panel of a task: of each group the settings that keep an error which none that is faster
    keeps, as the table of ratios has them."""
    rows = kept(tables[task], y.column).merge(tables[f"{task}_timings"], on=["model", "variant"])
    rows = rows[rows["status"] == "converged"].sort_values("solve_s")
    least = rows.groupby("group")[y.column].cummin()
    best = rows[(rows[y.column] == least) & ~rows.duplicated(["group", y.column])]
    time = Axis("solve_s", "time of the increments or steps [ms]", factor=1e3, log=True)
    return Panel(time, y, (Curves(best, LOOKS, by="group"), *marks), title=title)


#: Errors at which times are compared: of the path [1], and of the swing [rad].
LEVELS = (1e-1, 1e-2, 1e-3, 2e-4, 1e-5, 1e-6)
SWING_LEVELS = (1e-1, 2e-2, 1e-2, 5e-3, 2e-3)


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


STUDY = Study(
    parts=(
        Part(ask=lambda: {"codes": _codes()}),
        Part(ask=_paths, alone=True),
        Part(ask=_motions, alone=True),
    ),
    made={"statics_ratios": _path_ratios, "swings_ratios": _swing_ratios},
    varying=("statics_ratios", "swings_ratios"),
    figures={"peers": _fastest_of_all},
    missing=missing,
)
