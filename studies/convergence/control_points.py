"""Convergence of the splines in every form: more control points, and more segments."""

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
from studies.record.panels import STRIP_POINTS, Axis, Curves, Panel, sheet
from studies.record.style import STRETCH, page

#: Control points of a segment, by segments a strip.
COUNTS = {1: range(4, 13), 2: range(4, 9)}
#: Segments of a strip with so many control points each.
SEGMENTS, EACH = range(1, 6), 5
MEASURES = ("material", "spatial")
#: Error that is asked of trajectory and torque [1].
CLOSE = 1e-4


def _settings() -> list[SplineSettings]:
    """Return every discretisation: segments, n, measure, stretch form, and m = 1 ... n - 1 modes.

    With more segments than those of the map m is n - 2.
    """
    grids = [(segments, n) for segments, counts in COUNTS.items() for n in counts]
    grids += [(segments, EACH) for segments in SEGMENTS if segments not in COUNTS]
    forms: list[tuple[int, int, str, str, int | None]] = []
    for segments, n in grids:
        modes = range(1, n) if segments in COUNTS else (n - 2,)
        forms += [(segments, n, measure, "consistent", None) for measure in MEASURES]
        forms += [
            (segments, n, "material", stretch, m) for stretch in ("mixed", "inextensible") for m in modes
        ]
    return [
        SplineSettings(segments=segments, measure=measure, control_points=n, stretch=stretch, axial_modes=m)
        for segments, n, measure, stretch, m in forms
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
        refined_by = (rows[rows["segments"] == 1], rows[rows["control_points"] == EACH])
        forms = [Curves(each, STRETCH, by=("stretch", "measure")) for each in refined_by]
        lines.append([Panel(STRIP_POINTS, y, (curves, doubt)) for curves in forms])
    titles = ["one segment, more control points", f"more segments of {EACH} control points"]
    return sheet(9.5, 6.6, lines, columns=titles, legend=3)


def _maps(tables: Tables) -> Figure:
    figure = page(9.5, 4.4)
    panels = figure.subplots(1, 2, sharey=True)
    rows = tables["map"].query("stretch == 'mixed' and measure == 'material'")
    norm = LogNorm(1e-10, 1.0)
    for panel, (segments, counts) in zip(panels, COUNTS.items(), strict=True):
        _map(panel, rows[rows["segments"] == segments], counts, norm)
        panel.set_title("one segment" if segments == 1 else f"{segments} segments")
        panel.set_xlabel("control points a segment, n")
    panels[0].set_ylabel("axial-force modes a segment, m")
    figure.suptitle("Numbers: decimal exponent of the error; rings: the default m = n - 2; x: not converged")
    figure.colorbar(panels[0].collections[0], ax=panels, label="largest error of the torque [1]")
    return figure


def _map(panel: Axes, rows: pd.DataFrame, counts: range, norm: LogNorm) -> None:
    """Draw the errors as coloured squares with their decimal exponent; a failed point is a cross."""
    modes = np.arange(1, max(counts))
    told: list[str] = ["axial_modes", "control_points", "error_torque"]
    for m, n, error in rows[told].itertuples(index=False):
        text = f"{np.log10(error):.0f}" if np.isfinite(error) else "x"
        colour = "white" if error < 1e-5 else "black"
        panel.text(n, m, text, ha="center", va="center", fontsize=7.5, color=colour)
    grid = rows.pivot(index=told[0], columns=told[1], values=told[2]).reindex(index=modes, columns=counts)
    edges = np.arange(counts[0] - 0.5, counts[-1] + 1.0)
    panel.pcolormesh(edges, np.arange(0.5, len(modes) + 1.0), grid, norm=norm, cmap="viridis")
    panel.grid(False)
    panel.plot(counts, np.array(counts) - 2, "o", markersize=15, markerfacecolor="none", color="white")
    panel.set(xticks=list(counts), yticks=list(modes))


def _forms(tables: Tables) -> Iterator[dict[str, Any]]:
    """Yield, for each stretch form of one segment with its default modes, the error of the torque with four
    control points, the least of any, and from which count on trajectory and torque are close."""
    chosen = _default_modes(tables["map"]).query("measure == 'material' and segments == 1")
    for stretch, curve in chosen.groupby("stretch"):
        count = reaching(curve, "control_points", CLOSE)
        yield {
            "name": f"{stretch} stretch",
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
            claim=f"At most {COUNTS[1][-1]} control points give trajectory and torque to {percent(CLOSE)}",
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
