"""The figures of the work-precision studies, from tables alone."""

from collections.abc import Mapping

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from studies.record.style import BLUE, GREEN, Look, page
from studies.work_precision.moving_series import looks as moving_looks
from studies.work_precision.scaling import of_basis
from studies.work_precision.series import looks

COSTS = {"solve_s": "time of the increments [s]", "flops": "counted operations [1]"}
QUANTITIES = {"trajectory": "trajectory", "torque": "torque", "stiffness": "stiffness K"}


def statics(tables: Mapping[str, pd.DataFrame], margin: float) -> Figure:
    """Draw time (above) and work (below) over the largest error, one column a quantity.

    Errors below `margin` times that of their reference are left out.
    """
    rows = tables["errors"].merge(tables["timings"], on=["series", "setting"])
    figure = page(10.0, 7.0)
    panels = figure.subplots(2, len(QUANTITIES), sharex="col", sharey="row")
    for column, (quantity, label) in enumerate(QUANTITIES.items()):
        error = rows[f"error_{quantity}"]
        shown = rows[error >= margin * rows[f"reference_{quantity}"]]
        for panel, (cost, title) in zip(panels[:, column], COSTS.items(), strict=True):
            curves(panel, shown, f"error_{quantity}", cost, "count", looks())
            panel.set_xscale("log")
            panel.set_yscale("log")
            if column == 0:
                panel.set_ylabel(title)
        panels[0, column].set_title(label)
        panels[1, column].set_xlabel(f"largest error of the {quantity} [1]")
        panels[1, column].invert_xaxis()
    _legend(figure, panels[0, 0])
    return figure


def scaling(tables: Mapping[str, pd.DataFrame]) -> Figure:
    """Draw time and counted work of one Newton iteration over the control points."""
    figure = page(9.5, 3.8)
    timed, counted = figure.subplots(1, 2)
    styles = {
        "bezier": ("Bézier curve, condensed", BLUE, "x-"),
        "bspline": ("cubic B-spline, sparse from n = 24 on", GREEN, "o-."),
    }
    for basis, (label, colour, line) in styles.items():
        times, flops = (of_basis(tables[name], basis) for name in ("scaling_of_time", "scaling"))
        n = times["control_points"].to_numpy(float)
        timed.loglog(n, 1e6 * times["iteration_s"], line, color=colour, label=label)
        total = flops["assembly_flops"] + flops["factorisation_flops"]
        counted.loglog(n, total, line, color=colour, label=label)
    counts = sorted(set(tables["scaling"]["control_points"]))
    for panel in (timed, counted):
        slope(panel, counts[0], counts[-1])
        panel.set_xlabel("control points a strip, n")
        panel.set_xticks(counts, labels=[str(each) for each in counts])
        panel.minorticks_off()
    timed.set_ylabel("time of one iteration [µs]")
    counted.set_ylabel("operations of one iteration [1]")
    timed.legend()
    return figure


def slope(panel: Axes, first: int, last: int) -> None:
    """Draw lines of slope 1 and 3 from the lower left, within the panel."""
    low, high = panel.get_ylim()
    for power, line in ((1, ":"), (3, "--")):
        n = np.array([first, min(last, first * (high / low) ** (1.0 / power))])
        panel.plot(n, low * (n / first) ** power, line, color="#888888", linewidth=0.9, label=f"n^{power}")
    panel.set_ylim(low, high)


def dynamics(tables: Mapping[str, pd.DataFrame], margin: float) -> Figure:
    """Draw time (above) and work (below) over the errors of rotation and frequency."""
    rows = tables["errors"].merge(tables["timings"], on=["series", "setting"])
    figure = page(9.5, 7.0)
    panels = figure.subplots(2, 2, sharex="col", sharey="row")
    titles = {"rotation_rad": "largest error of the rotation over 0.05 s [rad]"}
    titles |= {"frequency": "error of the swing's frequency [1]"}
    for column, (quantity, title) in enumerate(titles.items()):
        shown = rows[rows[f"error_{quantity}"] >= margin * rows[f"reference_{quantity}"]]
        for panel, (cost, label) in zip(panels[:, column], COSTS.items(), strict=True):
            curves(panel, shown, f"error_{quantity}", cost, "rank", moving_looks())
            panel.set_xscale("log")
            panel.set_yscale("log")
            if column == 0:
                panel.set_ylabel(label.replace("increments", "steps"))
        panels[1, column].set_xlabel(title)
        panels[1, column].invert_xaxis()
    panels[0, 0].set_title("rotation")
    panels[0, 1].set_title("frequency")
    _legend(figure, panels[0, 0])
    return figure


def curves(
    panel: Axes, rows: pd.DataFrame, error: str, cost: str, rank: str, styles: Mapping[str, Look]
) -> None:
    """Draw one curve a family of each series, of the rows that have both numbers, in the order of `rank`."""
    known = rows[rows[error].notna() & rows[cost].notna()].sort_values(rank)
    for name, look in styles.items():
        for place, (_, mine) in enumerate(known[known["series"] == name].groupby("family", sort=False)):
            label = {} if place == 0 else {"label": None}
            panel.plot(mine[error], mine[cost], **(look.keywords() | label))
            if cost == "flops" and mine["family"].iloc[0] != "all":
                panel.annotate(
                    mine["family"].iloc[0], (mine[error].iloc[-1], mine[cost].iloc[-1]), (0, 4),
                    textcoords="offset points", ha="center", fontsize=7, color=look.colour,
                )  # fmt: skip


def _legend(figure: Figure, panel: Axes) -> None:
    handles, labels = panel.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=4)
