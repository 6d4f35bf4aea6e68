"""The maps of the pivot's design space, and the designs that no other one betters."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.collections import PathCollection
from matplotlib.figure import Figure
from numpy.typing import NDArray

from studies.kinds import Array
from studies.record.marks import Contours, Level
from studies.record.panels import Axis, Curves, Panel
from studies.record.style import BLACK, RED, Look, page


def not_dominated(costs: Array) -> NDArray[np.bool_]:
    """Return which designs are on the Pareto front: no other is at most as costly in all and less in one.

    Args:
        costs: (D, C), each to be small; of designs that are equal in all, all are kept.
    """
    front = np.ones(len(costs), dtype=bool)
    # what dominates another has the smaller sum: so those that stay are known by the time they are asked
    scale = np.ptp(costs, axis=0)
    order = np.argsort((costs / np.where(scale > 0.0, scale, 1.0)).sum(axis=1), kind="stable")
    for place, design in enumerate(order):
        if front[design]:
            later = order[place + 1 :]
            later = later[front[later]]
            worse = (costs[later] >= costs[design]).all(axis=1) & (costs[later] > costs[design]).any(axis=1)
            front[later[worse]] = False
    return front


def dominating(costs: Array, design: Array) -> NDArray[np.bool_]:
    """Return which designs (D, C) are at most as costly as `design` (C,) in all and less in one."""
    return np.asarray((costs <= design).all(axis=1) & (costs < design).any(axis=1))


#: Quantities in the order of the study, in a word.
SHORT = ("stiffness", "variation", "shift", "stress")
#: Crossing ratios 1/2 -+ sqrt(5)/6 at which the centre does not shift at small rotations.
WITTRICK = {"0.1273": 0.5 - 5.0**0.5 / 6.0, "0.8727": 0.5 + 5.0**0.5 / 6.0}
#: A map's quantity -> factor, title and levels of its lines.
MAPS = {
    "centre_shift_max_m": (1e3, "Largest shift [mm], L/t = {:g}", (0.5, 1, 2, 4, 6, 8)),
    "stiffness_variation": (
        1.0,
        "Variation of the stiffness, L/t = {:g}",
        (0.03, 0.1, 0.2, 0.4, 0.7),
    ),
}
#: Eight colours for the crossing ratio, a tenth each.
COLOURS = colormaps["viridis"].resampled(8)
STAR: dict[str, Any] = {
    "marker": "*",
    "markersize": 13,
    "color": RED,
    "markeredgecolor": BLACK,
    "linestyle": "",
}


def space(tables: Mapping[str, pd.DataFrame]) -> Figure:
    """Draw the designs by pairs of quantities (above) and the maps over the geometry (below)."""
    figure = page(9.0, 7.4)
    above, below = figure.subplots(2, 2)
    designs, checks = tables["designs"], tables["checks"]
    given = checks[checks["design"] == "Table 1"].iloc[0]
    shown = designs.assign(centre_shift_max_mm=1e3 * designs["centre_shift_max_m"])
    shown["stress_max_MPa"] = 1e-6 * shown["stress_max_Pa"]
    star = {
        "centre_shift_max_mm": 1e3 * given["centre_shift_max_m"],
        "stress_max_MPa": 1e-6 * given["stress_max_Pa"],
        "stiffness_variation": given["stiffness_variation"],
        "stiffness_rest_Nm_per_rad": given["stiffness_rest_Nm_per_rad"],
    }
    marks = _cloud(above[0], shown, star, "centre_shift_max_mm", "stiffness_variation", 1.0)
    above[0].set(xlabel="largest shift of the centre [mm]", ylabel="variation of the stiffness [1]")
    above[0].set_title(f"{len(designs)} pivots over ±45°: shift and variation")
    _cloud(above[1], shown, star, "stress_max_MPa", "stiffness_rest_Nm_per_rad", -1.0)
    above[1].set(xlabel="largest stress [MPa]", ylabel="stiffness at rest [N m/rad]")
    above[1].set_title("Stress and stiffness")
    figure.colorbar(marks, ax=list(above), label="crossing ratio [1]", shrink=0.95)
    above[0].legend(loc="lower right", frameon=True, framealpha=0.9)
    for panel, name in zip(below, MAPS, strict=True):
        _map(tables["map"], name, *MAPS[name])(panel)
    return figure


def _cloud(
    panel: Axes, designs: pd.DataFrame, star: Mapping[str, float], x: str, y: str, sign: float
) -> PathCollection:
    """Draw all designs in grey, those that none betters in colour, and the front of the two quantities.

    `sign`: 1 if y is to be small, -1 if it is to be large.
    """
    front = designs["front"] == "yes"
    rest, best = designs[~front], designs[front]
    panel.scatter(
        rest[x], rest[y], s=3, color="#c8c8c8", linewidths=0, rasterized=True, antialiased=False,
        label=f"dominated ({len(rest)})",
    )  # fmt: skip
    marks = panel.scatter(
        best[x], best[y], s=8, c=best["crossing_ratio"], cmap=COLOURS, vmin=0.1, vmax=0.9, linewidths=0,
        rasterized=True, antialiased=False, label=f"not dominated ({len(best)})",
    )  # fmt: skip
    pair = designs[not_dominated(np.column_stack((designs[x], sign * designs[y])))].sort_values(x)
    panel.plot(pair[x], pair[y], color=BLACK, linewidth=1.0, label="not dominated in these two")
    panel.plot(star[x], star[y], label="Table 1", **STAR)
    panel.set(xscale="log", yscale="log")
    return marks


def _map(maps: pd.DataFrame, name: str, factor: float, title: str, levels: tuple[float, ...]) -> Panel:
    """Return one quantity over crossing ratio and inclination, with Wittrick's ratios and Table 1's place."""
    reference = pd.DataFrame({"crossing_ratio": [0.5], "inclination_deg": [45.0]})
    return Panel(
        Axis("crossing_ratio", "crossing ratio [1]"),
        Axis("inclination_deg", "inclination [°]"),
        (
            Contours(maps, name, factor=factor, levels=levels, colour=BLACK, shaded=True),
            *(
                Level(ratio, words=label, colour=RED, line="--", upright=True)
                for label, ratio in WITTRICK.items()
            ),
            Curves(reference, Look(label="_", colour=RED), more=STAR),
        ),
        title=title.format(maps["slenderness"].iloc[0]),
    )
