"""Frequency of the swing and of small motion against control points, elements, step and amplitude."""

from collections.abc import Iterator
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from studies.convergence.swing_sweep import INTEGRATORS, MODES, PARTS
from studies.engine.study import Claim, Study, Tables
from studies.record.style import BLACK, BLUE, LOOKS, ORANGE, page, uncertain

SPLINE, TWENTY = "n = 6", "FE, 20 elements"

#: The part of a shift by which its prediction from statics may be off and still explain it.
EXPLAINED = 0.25
#: What "due to the number of control points" is read as: at most this part of the shift is left with more.
LEFT = 0.05
#: Both models "swing alike" within this part of the frequency: three times the error of 20 elements.
ALIKE = 1e-3


def _shifts(tables: Tables) -> Figure:
    figure = page(9.5, 6.6)
    (points, meshes, steps), (point_modes, mesh_modes, key) = figure.subplots(2, 3)
    level = float(tables["reference"]["uncertainty"].iloc[0])
    for stretch, look in (("consistent", LOOKS["n = 4, as the paper"]), ("mixed", LOOKS[SPLINE])):
        rows = tables["control_points"].query(f"stretch == '{stretch}'")
        style = {"color": look.colour, "marker": look.marker}
        points.semilogy(rows["control_points"], rows["shift"].abs(), **style, label=stretch)
        predicted = rows["shift_from_statics"].abs()
        label = f"{stretch}, statics"
        points.semilogy(
            rows["control_points"], predicted, **(style | {"marker": ""}), linestyle=":", label=label
        )
    points.set(xlabel="control points a strip", ylabel="|shift of the frequency| [1]", title="Swing from 90°")
    points.legend(loc="upper right", fontsize=7)
    rows = tables["elements"]
    meshes.loglog(rows["elements"], rows["shift"].abs(), "s--", color=BLACK)
    meshes.set(xlabel="elements a strip", title="Swing from 90°")
    _counts(meshes, rows["elements"])
    for (integrator, label), line in zip(INTEGRATORS.items(), (("x-", BLUE), ("o-", ORANGE)), strict=True):
        rows = tables["steps"][tables["steps"]["integrator"] == integrator]
        steps.loglog(rows["step_s"], rows["shift"].abs(), line[0], color=line[1], label=label)
    steps.set(xlabel="step [s]", title="Swing from 90°, n = 6")
    steps.legend(loc="upper left")
    for panel in (points, meshes):
        uncertain(panel, level)
    _modes(point_modes, mesh_modes, tables["modes"])
    key.set_axis_off()
    handles, labels = point_modes.get_legend_handles_labels()
    key.legend(handles, labels, loc="center left", title="small motion at rest")
    return figure


def _modes(points: Axes, meshes: Axes, rows: pd.DataFrame) -> None:
    """Draw the errors of the linear modes over either refinement, a colour a mode."""
    colours = [look.colour for look in LOOKS.values()]
    for mode, colour in zip(range(1, MODES + 1), colours, strict=False):
        for panel, model in ((points, "spline"), (meshes, "fe")):
            curve = rows[(rows["model"] == model) & (rows["mode"] == mode)]
            frequency = curve["limit_Hz"].iloc[0]
            style = {"color": colour, "marker": "o", "markersize": 3.0}
            panel.semilogy(
                curve["count"], curve["error"].abs(), **style, label=f"mode {mode}: {frequency:.1f} Hz"
            )
    points.set(
        xlabel="control points a strip", ylabel="|error of the frequency| [1]", title="Small motion at rest"
    )
    meshes.set(xlabel="elements a strip", title="Small motion at rest", xscale="log")
    _counts(meshes, rows.query("model == 'fe'")["count"])
    for panel in (points, meshes):
        panel.set_ylim(bottom=1e-11)


def _counts(panel: Axes, counts: "pd.Series[int]") -> None:
    """Put a tick at every other count, without the decades' own."""
    shown = sorted(set(counts))[::2]
    panel.set_xticks(shown, labels=[str(count) for count in shown])
    panel.minorticks_off()


def _backbone(tables: Tables) -> Figure:
    rows = tables["backbone"]
    figure = page(9.5, 3.8)
    curve, difference = figure.subplots(1, 2)
    wide = rows.pivot(index="amplitude_rad", columns="formulation", values="frequency_Hz")
    degrees = np.degrees(wide.index.to_numpy(float))
    for name in (TWENTY, SPLINE):
        curve.plot(degrees, wide[name], **LOOKS[name].keywords())
    statics = rows[rows["formulation"] == SPLINE].sort_values("amplitude_rad")
    curve.plot(
        degrees,
        statics["frequency_from_statics_Hz"],
        ":",
        color=BLACK,
        label="from statics alone, massless strips",
    )
    curve.axhline(rows["first_mode_Hz"].iloc[0], color="#888888", linewidth=0.8)
    curve.annotate(
        "first mode at rest",
        (60.0, rows["first_mode_Hz"].iloc[0]),
        (0, 3),
        textcoords="offset points",
        fontsize=8,
    )
    curve.set(xlabel="amplitude [deg]", ylabel="frequency of the swing [Hz]", xticks=range(0, 91, 15))
    curve.legend(loc="upper left")
    difference.plot(degrees, 1e4 * (wide[SPLINE] / wide[TWENTY] - 1.0), **LOOKS[SPLINE].keywords())
    difference.axhline(0.0, color="#444444", linewidth=0.8)
    difference.set(
        xlabel="amplitude [deg]", ylabel="difference to 20 elements [1e-4]", xticks=range(0, 91, 15)
    )
    return figure


def _shifts_left(tables: Tables) -> Iterator[dict[str, Any]]:
    """Yield, for each stretch form, the shift of four control points, the part of it that the static path
    does not explain, and the part that is left with the most points."""
    for stretch in ("consistent", "mixed"):
        rows = tables["control_points"].query("stretch == @stretch").sort_values("control_points")
        shifts, implied = rows["shift"].to_numpy(float), rows["shift_from_statics"].to_numpy(float)
        yield {
            "stretch": stretch,
            "shift": shifts[0],
            "unexplained": abs(implied[0] / shifts[0] - 1.0),
            "most": int(rows["control_points"].iloc[-1]),
            "left": abs(shifts[-1] / shifts[0]),
        }


def _four(tables: Tables) -> list[dict[str, Any]]:
    """Return what of the shift of four control points locking makes, and what of it the first mode shows."""
    four = tables["control_points"].query("control_points == 4").set_index("stretch")["shift"]
    first = tables["modes"].query("model == 'spline' and mode == 1 and count == 4")["error"].iloc[0]
    return [
        {
            "locking": 1.0 - four["mixed"] / four["consistent"],
            "first_mode": abs(first / four["mixed"]),
        }
    ]


def _apart(tables: Tables) -> list[dict[str, Any]]:
    """Return the largest difference of both models' frequencies at any amplitude."""
    wide = tables["backbone"].pivot(index="amplitude_rad", columns="formulation", values="frequency_Hz")
    return [{"apart": (wide[SPLINE] / wide[TWENTY] - 1.0).abs().max()}]


STUDY = Study(
    parts=PARTS,
    claims=(
        Claim(
            claim="Section 3.2: four control points swing faster because they are stiffer",
            formulation="n = 4, {stretch} stretch",
            quantity="the part of the shift ({shift:+.2%}) that the static path does not explain",
            rows=_shifts_left,
            value="unexplained",
            holds=lambda row: row["shift"] > 0.0 and row["unexplained"] <= EXPLAINED,
        ),
        Claim(
            claim="Section 3.2: the shift is due to the number of control points",
            formulation="{stretch} stretch",
            quantity="the shift at n = {most} over that at n = 4",
            rows=_shifts_left,
            value="left",
            most=LEFT,
        ),
        Claim(
            claim="The shift at four control points is mostly membrane locking",
            formulation="n = 4, consistent stretch",
            quantity="the part of the shift that goes with an independent axial force",
            rows=_four,
            value="locking",
            holds=lambda row: row["locking"] > 0.5,
        ),
        Claim(
            claim="The first mode at rest shows the shift of the swing",
            formulation="n = 4, mixed stretch",
            quantity="the error of the first mode at rest over the shift of the swing",
            rows=_four,
            value="first_mode",
            holds=lambda row: row["first_mode"] > 0.5,
        ),
        Claim(
            claim="Both models swing alike at every amplitude from 2 to 90 degrees",
            formulation=SPLINE,
            quantity="the largest difference of the frequency to 20 finite elements",
            rows=_apart,
            value="apart",
            most=ALIKE,
        ),
    ),
    figures={"frequency": _shifts, "backbone": _backbone},
)
