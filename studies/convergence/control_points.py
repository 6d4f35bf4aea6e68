"""Convergence of the splines with their control points in every form."""

from collections.abc import Iterator
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure

from studies.answers.reference import QUANTITIES
from studies.answers.settings import SplineSettings
from studies.cases.problem import named_case
from studies.convergence.sweep import reaching, spline_row
from studies.engine import Claim, Part, Study, Tables, percent
from studies.paper.formulations import refined
from studies.record.marks import Doubt
from studies.record.panels import CONTROL_POINTS, Axis, Curves, Panel, sheet
from studies.record.style import BASES, STRETCH, page

COUNTS = range(4, 13)
MEASURES = ("material", "spatial")
#: Error that is asked of trajectory and torque [1].
CLOSE = 1e-4


def _settings() -> list[SplineSettings]:
    """Return every discretisation of the map: basis, measure, stretch form, n, and m = 1 ... n - 1."""
    forms: list[tuple[str, int, str, int | None]] = []
    for n in COUNTS:
        forms += [(measure, n, "consistent", None) for measure in MEASURES]
        forms += [("material", n, stretch, m) for stretch in ("mixed", "inextensible") for m in range(1, n)]
    return [
        SplineSettings(basis=basis, measure=measure, control_points=n, stretch=stretch, axial_modes=m)
        for basis in BASES
        for measure, n, stretch, m in forms
    ]


def _default_modes(rows: pd.DataFrame) -> pd.DataFrame:
    """Return the rows of the default m = n - 2, and those of consistent stretch, which has no modes."""
    return rows[(rows["stretch"] == "consistent") | (rows["axial_modes"] == rows["control_points"] - 2)]


def _lines(tables: Tables) -> Figure:
    rows, limits = _default_modes(tables["map"]), tables["reference"]
    lines = []
    for quantity in ("trajectory", "torque"):
        y = Axis(f"error_{quantity}", f"largest error of the {quantity} [1]", log=True)
        doubt = Doubt(float(limits["uncertainty"][limits["quantity"] == quantity].max()))
        forms = [Curves(rows[rows["basis"] == basis], STRETCH, by=("stretch", "measure")) for basis in BASES]
        lines.append([Panel(CONTROL_POINTS, y, (curves, doubt)) for curves in forms])
    return sheet(9.5, 6.6, lines, columns=list(BASES.values()), legend=3)


def _maps(tables: Tables) -> Figure:
    figure = page(9.5, 4.4)
    panels = figure.subplots(1, 2, sharey=True)
    rows = tables["map"].query("stretch == 'mixed' and measure == 'material'")
    norm = LogNorm(1e-10, 1.0)
    for panel, (basis, label) in zip(panels, BASES.items(), strict=True):
        _map(panel, rows[rows["basis"] == basis], norm)
        panel.set_title(label)
        panel.set_xlabel("control points a strip, n")
    panels[0].set_ylabel("axial-force modes a strip, m")
    figure.suptitle("Numbers: decimal exponent of the error; rings: the default m = n - 2; x: not converged")
    figure.colorbar(panels[0].collections[0], ax=panels, label="largest error of the torque [1]")
    return figure


def _map(panel: Axes, rows: pd.DataFrame, norm: LogNorm) -> None:
    """Draw the errors as coloured squares with their decimal exponent; a failed point is a cross."""
    modes = np.arange(1, max(COUNTS))
    told: list[str] = ["axial_modes", "control_points", "error_torque"]
    for m, n, error in rows[told].itertuples(index=False):
        text = f"{np.log10(error):.0f}" if np.isfinite(error) else "x"
        colour = "white" if error < 1e-5 else "black"
        panel.text(n, m, text, ha="center", va="center", fontsize=7.5, color=colour)
    grid = rows.pivot(index=told[0], columns=told[1], values=told[2]).reindex(index=modes, columns=COUNTS)
    edges = np.arange(COUNTS[0] - 0.5, COUNTS[-1] + 1.0)
    panel.pcolormesh(edges, np.arange(0.5, len(modes) + 1.0), grid, norm=norm, cmap="viridis")
    panel.grid(False)
    panel.plot(COUNTS, np.array(COUNTS) - 2, "o", markersize=15, markerfacecolor="none", color="white")
    panel.set(xticks=list(COUNTS), yticks=list(modes))


def _forms(tables: Tables) -> Iterator[dict[str, Any]]:
    """Yield, for each basis and stretch form with its default modes, the error of the torque with four
    control points, the least of any, and from which count on trajectory and torque are close."""
    chosen = _default_modes(tables["map"]).query("measure == 'material'")
    for (basis, stretch), curve in chosen.groupby(["basis", "stretch"]):
        count = reaching(curve, "control_points", CLOSE)
        yield {
            "name": f"{BASES[str(basis)]}, {stretch} stretch",
            "four": curve.query("control_points == 4")["error_torque"].iloc[0],
            "best": curve["error_torque"].min(),
            "reaches": count is not None,
            "place": f" (within it from n = {count})" if count else "",
        }


MAP_STUDY = Study(
    parts=(
        Part(at=_settings, ask=lambda each: {"map": spline_row(named_case(), each, refined())}),
        Part(
            at=lambda: QUANTITIES,
            ask=lambda name: {"reference": {"quantity": name, "uncertainty": refined().uncertainty[name]}},
        ),
    ),
    claims=(
        Claim(
            claim="Four control points give the torque to 3 % on the whole path",
            formulation="{name}",
            quantity="the largest error of the torque with four control points",
            rows=_forms,
            value="four",
            most=0.03,
        ),
        Claim(
            claim=f"At most {COUNTS[-1]} control points give trajectory and torque to {percent(CLOSE)}",
            formulation="{name}",
            quantity="the smallest error of the torque{place}",
            rows=_forms,
            value="best",
            holds=lambda row: row["reaches"],
        ),
    ),
    figures={"control_points": _lines, "locking_map": _maps},
)
"""Convergence of the splines with their control points in every form: the locking map."""
