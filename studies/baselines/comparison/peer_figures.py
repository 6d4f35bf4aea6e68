"""The figure of error against time of the spline and of other codes, from tables alone."""

from collections.abc import Mapping

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from studies.record.style import BLUE, GREEN, GREY, ORANGE, RED, page

#: (model, group) -> label, colour and marker.
LOOKS = {
    ("spline", "spline"): ("spline", BLUE, "x"),
    ("exudyn ancf", "Exudyn"): ("Exudyn, ANCF cable", ORANGE, "o"),
    ("exudyn exact", "Exudyn"): ("Exudyn, geometrically exact", GREEN, "s"),
    ("exudyn ancf", "Exudyn as delivered"): ("Exudyn as delivered, ANCF cable", RED, "v"),
    ("exudyn exact", "Exudyn as delivered"): ("Exudyn as delivered, geometrically exact", RED, "^"),
    ("openseespy frame", "OpenSees"): ("OpenSees, corotational frame", GREY, "D"),
}


def work_precision(tables: Mapping[str, pd.DataFrame]) -> Figure:
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
