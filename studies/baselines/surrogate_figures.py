"""The figure of the surrogates' errors, from tables alone."""

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from studies.record.style import BLACK, GREEN, LOOKS, ORANGE, PURPLE, SKY, YELLOW, page

#: Model -> label, colour and line.
MODELS = {
    "linear pivot": ("linear pivot", ORANGE, "-"),
    "pin joint": ("pin joint", PURPLE, "-"),
    "four-bar": ("four-bar (fitted)", GREEN, "-"),
    "beam constraint model": ("beam constraint model", YELLOW, "-"),
    "chained constraint model": ("the same, chained", SKY, "-"),
}
SPLINES = {
    name: (LOOKS[name].label, LOOKS[name].colour, "--")
    for name in ("n = 4, as the paper", "n = 4, locking-free", "n = 6")
}
#: Errors below this are not drawn.
LEAST = 1e-6


def errors(tables: Mapping[str, pd.DataFrame], levels: Sequence[float]) -> Figure:
    """Draw the static errors over the rotation (above), frequencies and motion (below)."""
    figure = page(9.5, 6.4)
    above, below = figure.subplots(2, 3)
    for panel, quantity in zip(above, ("trajectory", "torque", "stiffness"), strict=True):
        _static(panel, tables["errors"], quantity, levels)
    above[0].set_title("Static path to 90°")
    _frequencies(below[0], tables["swings"])
    _motion(below[1], below[2], tables["motion"])
    handles, labels = above[0].get_legend_handles_labels()
    reference, name = below[1].get_legend_handles_labels()
    figure.legend([*handles, *reference[:1]], [*labels, *name[:1]], loc="outside lower center", ncols=4)
    return figure


def _static(panel: Axes, rows: pd.DataFrame, quantity: str, levels: Sequence[float]) -> None:
    for model, (label, colour, line) in (MODELS | SPLINES).items():
        mine = rows[rows["model"] == model]
        error = mine[quantity].abs()
        panel.semilogy(
            np.degrees(mine["rotation_rad"]),
            error.where(error > LEAST),
            color=colour,
            linestyle=line,
            label=label,
        )
    for level in levels:
        panel.axhline(level, color="#999999", linewidth=0.8)
        panel.annotate(
            f"{level:.0%}", (1.0, level), (2, 0), ("axes fraction", "data"), "offset points",
            ha="left", va="center", fontsize=7, color="#666666",
        )  # fmt: skip
    panel.set(
        xlabel="rotation [°]", ylabel=f"|error of the {quantity}| [1]", ylim=(LEAST, 30.0), xlim=(0, 90)
    )
    panel.set_xticks(range(0, 91, 15))


def _frequencies(panel: Axes, rows: pd.DataFrame) -> None:
    for model, (_, colour, _) in MODELS.items():
        mine = rows[rows["model"] == model].sort_values("amplitude_rad")
        panel.plot(np.degrees(mine["amplitude_rad"]), 100.0 * mine["shift"], "o-", color=colour)
    panel.axhline(0.0, color=BLACK, linewidth=0.8)
    panel.set(xlabel="amplitude of the swing [°]", ylabel="shift of the frequency [%]", title="Free swing")
    panel.set_xticks(range(0, 91, 15))


def _motion(whole: Axes, apart: Axes, rows: pd.DataFrame) -> None:
    reference = rows[rows["model"] == "reference"].sort_values("time_s")
    whole.plot(
        1e3 * reference["time_s"], np.degrees(reference["rotation_rad"]), color=BLACK, label="refined spline"
    )
    for model, (_, colour, _) in MODELS.items():
        mine = rows[rows["model"] == model].sort_values("time_s")
        whole.plot(1e3 * mine["time_s"], np.degrees(mine["rotation_rad"]), color=colour, linewidth=1.0)
        apart.plot(1e3 * mine["time_s"], np.degrees(mine["difference_rad"]), color=colour)
    whole.set(xlabel="time [ms]", ylabel="rotation [°]", title="Released at 90°")
    apart.set(xlabel="time [ms]", ylabel="difference to the refined spline [°]")
    whole.set_yticks(range(-90, 91, 45))
    apart.set_yticks(range(-180, 181, 60))
