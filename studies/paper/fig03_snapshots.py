"""Fig 3 of the paper: snapshots of the pivot, both models superposed, and the distance of their strips."""

from dataclasses import replace

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from scipy.interpolate import CubicSpline

from studies.answers.response import Response
from studies.cases.problem import named_case
from studies.engine import Answer, Claim, Part, Study, Tables
from studies.kinds import Array
from studies.paper.formulations import FE, LOCKING_FREE, LOOKS, PAPER, REFINED, SETTINGS, path_of, refined
from studies.record.marks import Level
from studies.record.panels import ROTATION, Axis, Curves, Panel, key
from studies.record.style import page

#: Parts of the path at which the pivot is drawn.
SNAPSHOTS = (0.0, 0.25, 0.5, 0.75, 1.0)
DRAWN = (PAPER, LOCKING_FREE, REFINED)

#: In the snapshots the finite elements are points over the splines' lines, so that both can be seen.
NODES = replace(LOOKS[REFINED], line="", marker="o").keywords() | {"markersize": 2.6}

BOUND = 0.01


def _compared(name: str) -> Answer:
    """Return a formulation's shapes at the snapshots, and their distance to the finest elements."""
    answer = path_of(name)
    distance = _distance(answer, refined().finest) / named_case().length
    rows = {"formulation": name, "rotation_rad": answer.rotation, "distance": distance}
    return {"shapes": _snapshots(name, answer), "distances": pd.DataFrame(rows)}


def _largest(tables: Tables) -> pd.DataFrame:
    """Return the largest distance of each formulation but 20 elements, and whether its path is whole."""
    largest = tables["distances"].groupby("formulation").max().drop(FE).reset_index()
    return largest.assign(whole=largest["rotation_rad"] >= tables["distances"]["rotation_rad"].max() - 1e-9)


def _figure(tables: Tables) -> Figure:
    """Draw the snapshots in a row and the distance of the strips over the rotation below."""
    drawn = page(9.5, 5.8)
    panels = drawn.subplot_mosaic([list("abcde"), ["error"] * 5], height_ratios=(1.0, 1.2))
    shapes = tables["shapes"]
    for label, rotation in zip("abcde", sorted(shapes["rotation_rad"].unique()), strict=True):
        _draw_pivot(panels[label], shapes[shapes["rotation_rad"] == rotation])
        panels[label].set_title(f"{np.degrees(rotation):.3g}°")
    panels["a"].set_ylabel("y [mm]")
    error = Panel(
        ROTATION,
        Axis("distance", "largest distance / length [1]", log=True),
        (
            Curves(tables["distances"].query("rotation_rad > 0"), LOOKS),
            Level(BOUND, words="1 %"),
        ),
        title="Distance of the strips to those of the refined finite elements",
    )
    error(panels["error"])
    key(drawn, (panels["error"], panels["a"]), columns=4)
    return drawn


def _draw_pivot(panel: Axes, shapes: pd.DataFrame) -> None:
    """Draw ground, strips and body of one snapshot; the formulations lie over one another."""
    for name in DRAWN:
        shape = shapes[shapes["formulation"] == name]
        look = NODES if name == REFINED else LOOKS[name].keywords() | {"marker": ""}
        every = 16 if name == REFINED else 1
        ends = []
        for _, strip in shape.groupby("strip"):
            x, y = 1e3 * strip["x_m"].to_numpy(), 1e3 * strip["y_m"].to_numpy()
            panel.plot(x[::every], y[::every], **look)
            ends.append((x[[0, -1]], y[[0, -1]]))
        if name == REFINED:
            (x1, y1), (x2, y2) = ends
            for end in (0, 1):
                panel.plot([x1[end], x2[end]], [y1[end], y2[end]], color="#b0b0b0", linewidth=4.0, zorder=0)
    panel.set(aspect="equal", xlim=(-24.0, 70.0), ylim=(-6.0, 90.0), xlabel="x [mm]", yticks=(0, 30, 60, 90))


def _snapshots(name: str, answer: Response) -> pd.DataFrame:
    """Return the strips' shapes at the snapshots that the path reached."""
    states = [round(part * named_case().increments) for part in SNAPSHOTS]
    rows = [
        {
            "formulation": name,
            "rotation_rad": answer.rotation[state],
            "strip": strip + 1,
            "station": answer.stations,
            "x_m": answer.solution.shape[state, strip, :, 0],
            "y_m": answer.solution.shape[state, strip, :, 1],
        }
        for state in states
        for strip in (0, 1)
        if state < len(answer.rotation)
    ]
    return pd.concat(map(pd.DataFrame, rows))


def _distance(answer: Response, finest: Response) -> Array:
    """Return (S,) the largest distance [m] of the answer's points from the finest strips, across these.

    What points slide along the strip does not show in a shape and is left out. Exact to second order.
    """
    curve = CubicSpline(finest.stations, finest.solution.shape[: len(answer.rotation)], axis=2)
    gap, along = answer.solution.shape - curve(answer.stations), curve(answer.stations, 1)
    across = (along[..., 0] * gap[..., 1] - along[..., 1] * gap[..., 0]) / np.linalg.norm(along, axis=-1)
    return np.asarray(np.abs(across).max(axis=(1, 2)))


STUDY = Study(
    parts=(
        Part(ask=lambda: {"shapes": _snapshots(REFINED, refined().finest)}),
        Part(at=lambda: SETTINGS, ask=_compared),
    ),
    claims=(
        Claim(
            claim="Conclusion: four control points approximate negligibly (shape within 1 % of the length)",
            formulation="{formulation}",
            quantity="the largest distance across the reference curve, over the length,",
            rows=_largest,
            value="distance",
            holds=lambda row: row["whole"] and row["distance"] < BOUND,
        ),
    ),
    figures={"fig03_snapshots": _figure},
)
