"""The figures of the effects' worth, from tables alone."""

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from studies.record.style import BLACK, BLUE, GREEN, ORANGE, RED, page

#: Column -> label, colour and marker of a change.
CHANGES = {
    "trajectory": ("path", BLACK, "o"),
    "torque": ("torque", ORANGE, "s"),
    "swing_frequency": ("frequency of the swing", BLUE, "D"),
    "first_mode": ("first mode at rest", GREEN, "x"),
}
#: Changes below this are drawn on the edge.
LEAST = 1e-7


def worth(tables: Mapping[str, pd.DataFrame], designs: Sequence[str], tolerance: float) -> Figure:
    """Draw the changes by every effect, one panel a design."""
    figure = page(9.5, 3.9)
    panels = figure.subplots(1, len(designs), sharex=True, sharey=True)
    rows = tables["worth"].query("status != 'refused'")
    order = (
        rows.set_index("scene")[list(CHANGES)].abs().groupby("scene").max().max(axis=1).sort_values().index
    )
    times = tables["timings"].set_index(["design", "scene"])["time_ratio"]
    for panel, design in zip(panels, designs, strict=True):
        mine = rows[rows["design"] == design].set_index("scene")
        for place, scene in enumerate(order):
            row = mine.loc[scene]
            for column, (label, colour, marker) in CHANGES.items():
                value = max(abs(float(row[column])), LEAST)  # of a NaN: NaN, which is not drawn
                panel.plot(
                    value, place, marker, color=colour, linestyle="", label=label if place == 0 else None,
                    markerfacecolor="none", markersize=5.5, clip_on=False,
                )  # fmt: skip
            ratio = float(times[design, scene])
            alone = "motion stops" if row["status"] == "not_converged" else "no motion"
            panel.annotate(
                f"time x {1.0 / ratio:.2g}" if np.isfinite(ratio) else alone,
                (1.0, place), (-2, 10), ("axes fraction", "data"), "offset points",
                ha="right", va="center", fontsize=7, color="#666666",
            )  # fmt: skip
        panel.axvline(tolerance, color=RED, linewidth=0.9)
        panel.set(xscale="log", xlim=(LEAST, 30.0), title=design, xlabel="|change| [1]")
        panel.set_xticks([1e-6, 1e-4, 1e-2, 1.0])
        panel.set_ylim(-0.6, len(order) - 0.4)
    panels[0].set_yticks(range(len(order)), labels=list(order))
    handles, labels = _once(panels[0].get_legend_handles_labels())
    figure.legend(handles, labels, loc="outside lower center", ncols=len(CHANGES))
    figure.suptitle(
        f"Change by leaving out one effect of the full scene; red line: {tolerance:g}; left edge: no more"
    )
    return figure


def savings(tables: Mapping[str, pd.DataFrame]) -> Figure:
    """Draw highest frequency and explicit step without stretching, and the shift by massless strips."""
    figure = page(9.5, 3.6)
    frequency, step, shift = figure.subplots(1, 3)
    for stretching, colour, label in (("yes", BLUE, "stretching"), ("no", ORANGE, "inextensible")):
        rows = tables["steps"][tables["steps"]["stretching"] == stretching]
        counts = rows["control_points"]
        frequency.semilogy(counts, 1e-3 * rows["highest_frequency_Hz"], "o-", color=colour, label=label)
        step.semilogy(counts, 1e6 * rows["explicit_step_s"], "o-", color=colour, label=label)
    frequency.set(xlabel="control points a strip, n", ylabel="highest frequency [kHz]")
    step.set(xlabel="control points a strip, n", ylabel="largest stable explicit step [µs]")
    for panel in (frequency, step):
        panel.set_xticks(sorted(set(tables["steps"]["control_points"])))
    frequency.set_title("Table 1, at rest and at 90°")
    frequency.legend()
    rows = tables["mass_ratio"].sort_values("mass_ratio")
    shift.loglog(rows["mass_ratio"], rows["shift"].abs(), "o-", color=BLUE, label="massless strips")
    ratio = rows["mass_ratio"].to_numpy(float)
    line = float(rows["shift"].iloc[0]) * ratio / ratio[0]
    shift.loglog(ratio, line, ":", color="#444444", label="in proportion")
    shift.set(xlabel="mass of the strips over that of the body", ylabel="shift of the first mode [1]")
    shift.set_title("Strips without inertia")
    shift.legend()
    return figure


def _once(drawn: tuple[list, list[str]]) -> tuple[list, list[str]]:
    """Return handles and labels without repeats."""
    chosen = np.unique(drawn[1], return_index=True)[1]
    return [drawn[0][place] for place in sorted(chosen)], [drawn[1][place] for place in sorted(chosen)]
