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
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from studies.baselines import tasks
from studies.baselines.exudyn_strips import exudyn_ancf
from studies.baselines.openseespy import openseespy_frame
from studies.baselines.variants import (
    AS_DELIVERED,
    ELEMENTS,
    EXUDYN,
    HINT,
    OPENSEES,
    SPLINE,
    SURROGATE,
    kept,
    missing,
)
from studies.cases.problem import named_case
from studies.engine.study import Answer, Claim, Part, Study, Tables, records
from studies.record.style import BLACK, BLUE, ORANGE, PURPLE, YELLOW, page

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


#: (model, group) -> label, colour and marker; a colour a code, a marker a beam.
LOOKS = {
    ("spline", SPLINE): ("spline", BLUE, "x"),
    ("finite elements", ELEMENTS): ("finite elements", BLACK, "s"),
    ("exudyn ancf", "Exudyn"): ("Exudyn, ANCF cable", PURPLE, "^"),
    ("exudyn exact", "Exudyn"): ("Exudyn, geometrically exact", PURPLE, "v"),
    ("exudyn ancf", "Exudyn as delivered"): ("Exudyn as delivered, ANCF cable", YELLOW, "^"),
    ("exudyn exact", "Exudyn as delivered"): ("Exudyn as delivered, geometrically exact", YELLOW, "v"),
    ("openseespy frame", "OpenSees"): ("OpenSees, corotational frame", ORANGE, "<"),
}


def _work_precision(tables: Mapping[str, pd.DataFrame]) -> Figure:
    """Draw every setting as a point and the best of each model as a line, for the path and the swing."""
    figure = page(9.5, 4.6)
    path, swing = figure.subplots(1, 2)
    _panel(path, tables["statics"], tables["statics_timings"], "worst")
    path.set(
        xlabel="time of the solver [ms]",
        ylabel="larger error of trajectory and torque [1]",
        title="Static path to 90° in 20 increments",
    )
    _panel(swing, tables["swings"], tables["swings_timings"], "rotation_rad")
    swing.set(
        xlabel="time of the solver [ms]",
        ylabel="largest error of the rotation [rad]",
        title="Free swing of 0.05 s from 90°",
    )
    _doubt(swing, tables["swing_theories"])
    handles, labels = path.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3)
    figure.suptitle(
        "Each against the limit of its own theory; points: all settings tried; lines: the best of them"
    )
    return figure


def _doubt(panel: Axes, theories: pd.DataFrame) -> None:
    """Mark how certain the limits of the swing are."""
    for row in theories[theories["what"] == "uncertainty"].to_dict("records"):
        level = float(row["rotation_rad"])
        panel.axhline(level, color="#444444", linewidth=0.9, linestyle=":")
        panel.annotate(
            f"uncertainty of the limit {row['theory']}", (0.99, level), (0, 2),
            ("axes fraction", "data"), "offset points",
            ha="right", va="bottom", fontsize=7, color="#444444",
            bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.5, "alpha": 0.85},
        )  # fmt: skip


def _panel(panel: Axes, rows: pd.DataFrame, times: pd.DataFrame, error: str) -> None:
    joined = rows[rows["status"] == "converged"].merge(times, on=["model", "variant"])
    for (model, group), (label, colour, marker) in LOOKS.items():
        mine = joined[(joined["model"] == model) & (joined["group"] == group)].sort_values("solve_s")
        if mine.empty:
            continue
        panel.loglog(
            1e3 * mine["solve_s"], mine[error], marker, color=colour, alpha=0.35, markersize=3, linestyle=""
        )
        best = mine[mine[error] <= mine[error].cummin()]
        panel.loglog(1e3 * best["solve_s"], best[error], marker + "-", color=colour, label=label)


#: Errors at which times are compared: of the path [1], and of the swing [rad].
LEVELS = (1e-1, 1e-2, 1e-3, 2e-4, 1e-5, 1e-6)
SWING_LEVELS = (1e-1, 2e-2, 1e-2, 5e-3, 2e-3)
#: Level -> ratio to the fastest Exudyn that the suite set out for.
AIMS = {2e-4: 50.0, 1e-6: 100.0}
SWING_AIMS = {1e-2: 20.0}


def _paths() -> Answer:
    """Return theories, errors and times of the static path."""
    limits, theories = tasks.path_limits(named_case())
    rows, times = tasks.compared_paths(named_case(), limits)
    return {"theories": theories, "statics": rows, "statics_timings": times}


def _motions() -> Answer:
    """Return theories, errors and times of the swing."""
    limits, theories = tasks.swing_limits(named_case())
    uncertainty = {row["theory"]: row["rotation_rad"] for row in theories if row["theory"]}
    rows, times = tasks.compared_swings(named_case(), limits, uncertainty)
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
