"""Figs 3 to 5 of the paper: snapshots, path of the body's centre, torque, stiffness, and errors of each."""

from collections.abc import Iterable, Iterator
from dataclasses import replace

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from scipy.interpolate import CubicSpline

from studies.answers.metrics import relative_error, trajectory_error
from studies.answers.reference import errors
from studies.answers.response import Response
from studies.cases.problem import named_case
from studies.engine import Answer, Claim, Part, Row, Study, Tables
from studies.kinds import Array
from studies.paper import formulations
from studies.paper.formulations import FE, LOCKING_FREE, LOOKS, PAPER, REFINED, path_of, refined
from studies.record.panels import ROTATION, Axis, Curves, Doubt, Level, Panel, sheet
from studies.record.style import Look

#: The paper's 1 %: of the travel, and of the length for shapes.
BOUND = 0.01
#: Parts of the path at which the pivot is drawn.
SNAPSHOTS = (0.0, 0.25, 0.5, 0.75, 1.0)

#: In the snapshots the finite elements are points over the splines' lines, so that both can be seen, and the
#: two strips of a formulation have its look.
STRIPS = {
    (name, strip): replace(LOOKS[name], line=line, marker=marker)
    for name, line, marker in ((PAPER, "-", ""), (LOCKING_FREE, "-", ""), (REFINED, "", "o"))
    for strip in (1, 2)
}
POINTS, RIGID = {"markersize": 2.6, "markevery": 16}, {"linewidth": 4.0, "zorder": 0}
BODY = Look(label="_body", colour="#b0b0b0")
PLACE = Axis("x_m", "x [mm]", factor=1e3, limits=(-24.0, 70.0))
HEIGHT = Axis("y_m", "y [mm]", factor=1e3, limits=(-6.0, 90.0), ticks=(0, 30, 60, 90))


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


def _shapes(tables: Tables) -> Figure:
    """Draw the snapshots in a row and the distance of the strips over the rotation below."""
    rotations = sorted(tables["shapes"]["rotation_rad"].unique())
    pivots = [_pivot(tables["shapes"].query("rotation_rad == @rotation")) for rotation in rotations]
    pivots[1:] = [replace(each, y=replace(HEIGHT, label="")) for each in pivots[1:]]
    error = Panel(
        ROTATION,
        Axis("distance", "largest distance / length [1]", log=True),
        (
            Curves(tables["distances"].query("rotation_rad > 0"), LOOKS),
            Level(BOUND, words="1 %"),
        ),
        title="Distance of the strips to those of the refined finite elements",
    )
    return sheet(9.5, 5.8, [pivots, [error] * len(pivots)], heights=(1.0, 1.2), legend=4)


def _pivot(shapes: pd.DataFrame) -> Panel:
    """Return ground, strips and body of one snapshot; the formulations lie over one another."""
    ends = shapes.query("formulation == @REFINED and station in (0.0, 1.0)")
    rigid = [Curves(each, BODY, along="strip", more=RIGID) for _, each in ends.groupby("station")]
    strips = Curves(shapes, STRIPS, by=("formulation", "strip"), along="station", more=POINTS)
    title = f"{np.degrees(shapes['rotation_rad'].iloc[0]):.3g}°"
    return Panel(PLACE, HEIGHT, (strips, *rigid), title=title, equal=True)


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

    Sliding along the strip does not change a shape and is not counted. Exact to second order.
    """
    curve = CubicSpline(finest.stations, finest.solution.shape[: len(answer.rotation)], axis=2)
    gap, along = answer.solution.shape - curve(answer.stations), curve(answer.stations, 1)
    across = (along[..., 0] * gap[..., 1] - along[..., 1] * gap[..., 0]) / np.linalg.norm(along, axis=-1)
    return np.asarray(np.abs(across).max(axis=(1, 2)))


FIG03 = Study(
    parts=(
        Part(ask=lambda: {"shapes": _snapshots(REFINED, refined().finest)}),
        Part(at=lambda: formulations.SETTINGS, ask=_compared),
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
    figures={"fig03_snapshots": _shapes},
)
"""Fig 3 of the paper: snapshots of the pivot, both models superposed, and the distance of their strips."""


def _along(name: str, table: str, quantities: Iterable[str], columns: Row, summary: Row) -> Answer:
    """Return a formulation's path with the errors of quantities, and a summary; of the refined elements the
    uncertainties."""
    path, limit = path_of(name), refined()
    found = errors(path, limit)
    known = {"formulation": name, "rotation_rad": path.rotation, **columns}
    rows = pd.DataFrame(known | {f"error_{of}": found[of] for of in quantities})
    if name == REFINED:
        unsure = [{"quantity": q, "uncertainty": limit.uncertainty[q]} for q in quantities]
        return {table: rows, "reference": unsure}
    return {table: rows, "summary": {"formulation": name, "status": path.status, **summary}}


def _centres(name: str) -> Answer:
    """Return the way of the body's centre."""
    centre = path_of(name).centre
    columns = {"com_x_m": centre[:, 0], "com_y_m": centre[:, 1]}
    end = trajectory_error(centre, path_of(FE).centre)[-1]
    return _along(name, "paths", ["trajectory"], columns, {"difference_to_fe20_end": end})


def _trajectories(tables: Tables) -> Figure:
    """Draw the paths beside their errors over the rotation."""
    paths = tables["paths"]
    last = 1e3 * paths.query("formulation == @REFINED")[["com_x_m", "com_y_m"]].to_numpy()[-1]
    x = Axis("com_x_m", "x of the centre of mass [mm]", factor=1e3)
    y = Axis("com_y_m", "y [mm]", factor=1e3)
    near_x, near_y = (
        replace(axis, limits=(value - below, value + above))
        for axis, value, below, above in ((x, last[0], 0.8, 2.2), (y, last[1], 0.3, 1.4))
    )
    curves = Curves(paths, LOOKS, along="rotation_rad", more={"markersize": 3.5})
    whole = Panel(x, y, (curves,), title="Path from 0 to 90°", equal=True)
    end = Panel(near_x, near_y, (curves,), title="Its end, enlarged", equal=True)
    marks = (
        Curves(paths.query("formulation != @REFINED"), LOOKS),
        Doubt(tables["reference"]["uncertainty"].max()),
        Level(BOUND, words="the paper's 1 %"),
    )
    y = Axis("error_trajectory", "distance to the refined path / travel [1]", log=True)
    error = Panel(ROTATION, y, marks, title="Error of the path")
    return sheet(9.5, 5.6, [[whole, error], [end, error]], legend=4)


FIG04 = Study(
    parts=(Part(at=lambda: formulations.NAMED, ask=_centres),),
    claims=(
        Claim(
            claim="Fig 4: the two trajectories differ by less than 1 % at the end of the movement",
            formulation="{formulation}",
            quantity="the difference to 20 elements at the end, over the centre's displacement,",
            rows=lambda tables: tables["summary"].query("formulation != @FE"),
            value="difference_to_fe20_end",
            holds=lambda row: row["status"] == "converged" and row["difference_to_fe20_end"] < BOUND,
        ),
    ),
    figures={"fig04_trajectory": _trajectories},
)
"""Fig 4 of the paper: the path of the body's centre of mass, and how far each formulation is off it."""


#: "Negligible" is read as the width of a line in a published plot, about this part of the full scale.
NEGLIGIBLE = 0.03
#: Quantities of Fig 5, their columns and what stands along their axes.
OF_FIG05 = {
    "torque": ("torque_Nm", "driving torque [N m]"),
    "stiffness": ("stiffness_Nm_per_rad", "stiffness dT/dθ [N m / rad]"),
}


def _curves(name: str) -> Answer:
    """Return torque and stiffness."""
    path = path_of(name)
    columns = {column: getattr(path, of) for of, (column, _) in OF_FIG05.items()}
    return _along(name, "curves", OF_FIG05, columns, {"max_stress_end_Pa": path.max_stress[-1]})


def _stiffnesses(tables: Tables) -> Figure:
    """Draw torque and stiffness above their errors over the rotation."""
    columns = [_curves_and_errors(tables, quantity, *shown) for quantity, shown in OF_FIG05.items()]
    return sheet(9.0, 7.0, list(zip(*columns, strict=True)), legend=4)


def _curves_and_errors(tables: Tables, quantity: str, column: str, label: str) -> tuple[Panel, Panel]:
    """Return the panel of a quantity, limited to what can be compared there, and that of its error."""
    curves = tables["curves"]
    highest = 1.8 * curves.query("formulation == @REFINED")[column].max()
    above = Curves(curves, LOOKS, more={"markevery": 2})
    below = (
        Curves(curves.query("formulation != @REFINED and rotation_rad > 0"), LOOKS),
        Level(NEGLIGIBLE, words="3 %"),
        Doubt(tables["reference"].query("quantity == @quantity")["uncertainty"].max()),
    )
    error = Axis(f"error_{quantity}", f"|error of the {quantity}| [1]", log=True)
    return Panel(ROTATION, Axis(column, label, limits=(0.0, highest)), (above,)), Panel(
        ROTATION, error, below
    )


def _to_twenty(tables: Tables) -> Iterator[Row]:
    """Yield the differences of each formulation to 20 elements, which the paper compares with."""
    paths = dict(list(tables["curves"].groupby("formulation")))
    for name, status in tables["summary"].query("formulation != @FE")[["formulation", "status"]].to_numpy():
        for of, (column, _) in OF_FIG05.items():
            off = relative_error(paths[name][column].to_numpy(), paths[FE][column].to_numpy())
            row = {"formulation": name, "of": of, "largest": np.abs(off).max(), "end": off[-1]}
            yield row | {"converged": status == "converged"}


FIG05 = Study(
    parts=(Part(at=lambda: formulations.NAMED, ask=_curves),),
    claims=(
        Claim(
            claim="Fig 5: the differences are negligible ({of} within 3 % at every rotation)",
            formulation="{formulation}",
            quantity="the largest difference of the {of} to 20 finite elements",
            rows=_to_twenty,
            value="largest",
            holds=lambda row: row["converged"] and row["largest"] < NEGLIGIBLE,
        ),
        Claim(
            claim="Fig 5: the spline overestimates the stiffness (at the end of the movement)",
            formulation="{formulation}",
            quantity="the signed difference of the stiffness to 20 finite elements at the end",
            rows=lambda tables: (row for row in _to_twenty(tables) if row["of"] == "stiffness"),
            value="end",
            holds=lambda row: row["converged"] and row["end"] > 0.0,
        ),
    ),
    figures={"fig05_stiffness": _stiffnesses},
)
"""Fig 5 of the paper: stiffness against rotation, the torque it belongs to, and the errors of both."""
