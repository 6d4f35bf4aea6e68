"""Figs 4 and 5 of the paper: path of the body's centre, torque, stiffness over the rotation, and errors."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from studies.answers.metrics import relative_error, trajectory_error
from studies.answers.reference import errors
from studies.engine import Answer, Claim, Part, Row, Study, Tables
from studies.paper.formulations import FE, LOOKS, MEANING, NAMED, PAPER, REFINED, path_of, refined
from studies.record.marks import Doubt, Level, Words
from studies.record.panels import ROTATION, Axis, Curves, Panel, key, sheet
from studies.record.style import page

BOUND = 0.01


def _centres(name: str) -> Answer:
    """Return a formulation's path, its error against the refined elements, and a summary; of these elements
    the uncertainty."""
    path = path_of(name)
    error = errors(path, refined())["trajectory"]
    columns = {"com_x_m": path.centre[:, 0], "com_y_m": path.centre[:, 1], "error_trajectory": error}
    table = pd.DataFrame({"formulation": name, "rotation_rad": path.rotation, **columns})
    if name == REFINED:
        known = {"quantity": "trajectory", "uncertainty": refined().uncertainty["trajectory"]}
        return {"paths": table, "reference": known}
    summary = {
        "formulation": name,
        "meaning": MEANING[name],
        "status": path.status,
        "error_end": error[-1],
        "error_largest": error.max(),
        "difference_to_fe20_end": trajectory_error(path.centre, path_of(FE).centre)[-1],
        "centre_shift_end_m": float(np.linalg.norm(path.centre_shift[-1])),
    }
    return {"paths": table, "summary": summary}


def _trajectories(tables: Tables) -> Figure:
    """Draw the paths beside their errors over the rotation."""
    drawn, paths = page(9.5, 5.6), tables["paths"]
    panels = drawn.subplot_mosaic([["path", "error"], ["end", "error"]])
    last = 1e3 * paths.query("formulation == @REFINED")[["com_x_m", "com_y_m"]].to_numpy()[-1]
    x = Axis("com_x_m", "x of the centre of mass [mm]", factor=1e3)
    y = Axis("com_y_m", "y [mm]", factor=1e3)
    near_x, near_y = (
        replace(axis, limits=(value - below, value + above))
        for axis, value, below, above in ((x, last[0], 0.8, 2.2), (y, last[1], 0.3, 1.4))
    )
    curves = Curves(paths, LOOKS, along="rotation_rad", more={"markersize": 3.5})
    Panel(x, y, (curves,), title="Path from 0 to 90°")(panels["path"])
    Panel(near_x, near_y, (curves,), title="Its end, enlarged")(panels["end"])
    for name in ("path", "end"):
        panels[name].set_aspect("equal")
    marks = (
        Curves(paths.query("formulation != @REFINED"), LOOKS),
        Doubt(tables["reference"]["uncertainty"].max()),
        Level(BOUND, words="the paper's 1 %"),
    )
    error = Axis("error_trajectory", "distance to the refined path / travel [1]", log=True)
    Panel(ROTATION, error, marks, title="Error of the path")(panels["error"])
    key(drawn, panels.values(), columns=4)
    return drawn


FIG04 = Study(
    parts=(Part(at=lambda: NAMED, ask=_centres),),
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


#: "Negligible" is read as the width of a line in a printed plot, about this part of the full scale.
NEGLIGIBLE = 0.03
#: Quantities of Fig 5, their columns and what stands along their axes.
DRAWN = {
    "torque": ("torque_Nm", "driving torque [N m]"),
    "stiffness": ("stiffness_Nm_per_rad", "stiffness dT/dθ [N m / rad]"),
}


def _curves(name: str) -> Answer:
    """Return torque and stiffness of a formulation with their errors and a summary; of the refined elements
    the uncertainties."""
    path = path_of(name)
    error = {of: values for of, values in errors(path, refined()).items() if of in DRAWN}
    columns = {column: getattr(path, of) for of, (column, _) in DRAWN.items()}
    columns |= {f"error_{of}": values for of, values in error.items()}
    table = pd.DataFrame({"formulation": name, "rotation_rad": path.rotation, **columns})
    if name == REFINED:
        known = [{"quantity": of, "uncertainty": refined().uncertainty[of]} for of in DRAWN]
        return {"curves": table, "reference": known}
    half, torque, stiffness = len(refined().rotation) // 2, error["torque"], error["stiffness"]
    summary = {
        "formulation": name,
        "meaning": MEANING[name],
        "status": path.status,
        "error_torque_half": torque[half] if half < len(torque) else np.nan,
        "error_torque_end": torque[-1],
        "error_torque_largest": float(np.abs(torque).max()),
        "error_stiffness_end": stiffness[-1],
        "error_stiffness_largest": float(np.abs(stiffness).max()),
        "axial_energy_end_J": path.axial_energy[-1],
        "bending_energy_end_J": path.bending_energy[-1],
        "max_stress_end_Pa": path.max_stress[-1],
    }
    return {"curves": table, "summary": summary}


def _stiffnesses(tables: Tables) -> Figure:
    """Draw torque and stiffness above their errors over the rotation."""
    columns = [_curves_and_errors(tables, quantity, *shown) for quantity, shown in DRAWN.items()]
    return sheet(9.0, 7.0, list(zip(*columns, strict=True)), legend=4)


def _curves_and_errors(tables: Tables, quantity: str, column: str, label: str) -> tuple[Panel, Panel]:
    """Return the panel of a quantity, limited to what can be compared there, and that of its error."""
    curves = tables["curves"]
    highest = 1.8 * curves.query("formulation == @REFINED")[column].max()
    locked = curves.query("formulation == @PAPER")[column].max()
    unit = label[label.index("[") + 1 : -1]
    words = f"as the paper:\nup to {locked:.0f} {unit}"
    above = (
        Curves(curves, LOOKS, more={"markevery": 2}),
        Words(words, (0.03, 0.86), placed=True, colour=LOOKS[PAPER].colour),
    )
    below = (
        Curves(curves.query("formulation != @REFINED and rotation_rad > 0"), LOOKS),
        Level(NEGLIGIBLE, words="3 %"),
        Doubt(tables["reference"].query("quantity == @quantity")["uncertainty"].max()),
    )
    error = Axis(f"error_{quantity}", f"|error of the {quantity}| [1]", log=True)
    return Panel(ROTATION, Axis(column, label, limits=(0.0, highest)), above), Panel(ROTATION, error, below)


def _to_twenty(tables: Tables) -> Iterator[Row]:
    """Yield the differences of each formulation to 20 elements, which the paper compares with."""
    paths = dict(list(tables["curves"].groupby("formulation")))
    for name, status in tables["summary"].query("formulation != @FE")[["formulation", "status"]].to_numpy():
        for of, (column, _) in DRAWN.items():
            off = relative_error(paths[name][column].to_numpy(), paths[FE][column].to_numpy())
            row = {"formulation": name, "of": of, "largest": np.abs(off).max(), "end": off[-1]}
            yield row | {"converged": status == "converged"}


FIG05 = Study(
    parts=(Part(at=lambda: NAMED, ask=_curves),),
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
