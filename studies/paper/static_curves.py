"""Figs 4 and 5 of the paper: path of the body's centre, torque, stiffness over the rotation, and errors."""

from dataclasses import replace

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from studies.answers.metrics import relative_error, trajectory_error
from studies.answers.reference import Reference, errors
from studies.answers.response import Response
from studies.engine import Answer, Claim, Part, Row, Study, Tables, finding
from studies.kinds import Array
from studies.paper import formulations
from studies.paper.formulations import FE, REFINED, SETTINGS
from studies.record.marks import Doubt, Level, Words
from studies.record.panels import ROTATION, Axis, Curves, Panel, key, sheet
from studies.record.style import LOOKS, page

BOUND = 0.01


def _compared_paths(name: str) -> Answer:
    """Return a formulation's path, its error against the refined elements, and a summary."""
    answer, limit = formulations.answer(name), formulations.refined()
    error = errors(answer, limit)["trajectory"]
    difference = trajectory_error(answer.centre, formulations.answer(FE).centre)
    summary = {
        "formulation": name,
        "meaning": formulations.MEANING[name],
        "status": answer.status,
        "error_end": error[-1],
        "error_largest": error.max(),
        "difference_to_fe20_end": difference[-1],
        "centre_shift_end_m": float(np.linalg.norm(answer.centre_shift[-1])),
    }
    return {"paths": _path(name, answer.rotation, answer.centre, error), "summary": summary}


def _refined_path() -> Answer:
    """Return the reference: its path and its uncertainty."""
    limit = formulations.refined()
    return {
        "paths": _path(REFINED, limit.rotation, limit.centre, np.zeros(len(limit.rotation))),
        "reference": {"quantity": "trajectory", "uncertainty": limit.uncertainty["trajectory"]},
    }


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
    Panel(
        ROTATION,
        Axis("error_trajectory", "distance to the refined path / travel [1]", log=True),
        (
            Curves(paths.query("formulation != @REFINED"), LOOKS),
            Doubt(tables["reference"]["uncertainty"].max()),
            Level(BOUND, words="the paper's 1 %"),
        ),
        title="Error of the path",
    )(panels["error"])
    key(drawn, panels.values(), columns=4)
    return drawn


def _path(name: str, rotation: np.ndarray, centre: np.ndarray, error: np.ndarray) -> pd.DataFrame:
    return pd.DataFrame(
        {
            "formulation": name,
            "rotation_rad": rotation,
            "com_x_m": centre[:, 0],
            "com_y_m": centre[:, 1],
            "error_trajectory": error,
        }
    )


FIG04 = Study(
    parts=(Part(ask=_refined_path), Part(at=lambda: SETTINGS, ask=_compared_paths)),
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


def _compared_curves(name: str) -> Answer:
    """Return torque and stiffness of a formulation with their errors, its summary and the findings."""
    answer, limit = formulations.answer(name), formulations.refined()
    error = errors(answer, limit)
    half = len(limit.rotation) // 2
    summary = {
        "formulation": name,
        "meaning": formulations.MEANING[name],
        "status": answer.status,
        "error_torque_half": error["torque"][half] if half < len(error["torque"]) else np.nan,
        "error_torque_end": error["torque"][-1],
        "error_torque_largest": float(np.abs(error["torque"]).max()),
        "error_stiffness_end": error["stiffness"][-1],
        "error_stiffness_largest": float(np.abs(error["stiffness"]).max()),
        "axial_energy_end_J": answer.axial_energy[-1],
        "bending_energy_end_J": answer.bending_energy[-1],
        "max_stress_end_Pa": answer.max_stress[-1],
    }
    return {
        "curves": _curve(name, answer, error["torque"], error["stiffness"]),
        "summary": summary,
        "findings": [] if name == FE else _findings(name, answer, formulations.answer(FE)),
    }


def _refined_curves() -> Answer:
    """Return the reference: its curves and its uncertainties."""
    limit = formulations.refined()
    nothing = np.zeros(len(limit.rotation))
    uncertainties = [
        {"quantity": name, "uncertainty": limit.uncertainty[name]} for name in ("torque", "stiffness")
    ]
    return {"curves": _curve(REFINED, limit, nothing, nothing), "reference": uncertainties}


def _stiffnesses(tables: Tables) -> Figure:
    """Draw torque and stiffness above their errors over the rotation."""
    columns = [
        _curves_and_errors(tables, "torque", "torque_Nm", "driving torque [N m]"),
        _curves_and_errors(tables, "stiffness", "stiffness_Nm_per_rad", "stiffness dT/dθ [N m / rad]"),
    ]
    return sheet(9.0, 7.0, list(zip(*columns, strict=True)), legend=4)


def _curves_and_errors(tables: Tables, quantity: str, column: str, label: str) -> tuple[Panel, Panel]:
    """Return the panel of a quantity, limited to what can be compared there, and that of its error."""
    curves = tables["curves"]
    refined = curves.query("formulation == @REFINED")
    locked = curves.query("formulation == @formulations.PAPER")[column].max()
    unit = label[label.index("[") + 1 : -1]
    above = Panel(
        ROTATION,
        Axis(column, label, limits=(0.0, 1.8 * refined[column].max())),
        (
            Curves(curves, LOOKS, more={"markevery": 2}),
            Words(
                f"as the paper:\nup to {locked:.0f} {unit}",
                (0.03, 0.86),
                placed=True,
                colour=LOOKS[formulations.PAPER].colour,
            ),
        ),
    )
    below = Panel(
        ROTATION,
        Axis(f"error_{quantity}", f"|error of the {quantity}| [1]", log=True),
        (
            Curves(curves.query("formulation != @REFINED and rotation_rad > 0"), LOOKS),
            Level(NEGLIGIBLE, words="3 %"),
            Doubt(tables["reference"].query("quantity == @quantity")["uncertainty"].max()),
        ),
    )
    return above, below


def _findings(name: str, answer: Response, against: Response) -> list[Row]:
    """Return the claims of Fig 5 held against one formulation, compared with 20 elements as there."""
    off = {of: relative_error(getattr(answer, of), getattr(against, of)) for of in ("torque", "stiffness")}
    found = [
        finding(
            claim=f"Fig 5: the differences are negligible ({of} within 3 % at every rotation)",
            formulation=name,
            quantity=f"the largest difference of the {of} to 20 finite elements",
            value=float(np.abs(difference).max()),
            holds=bool(answer.converged and np.abs(difference).max() < NEGLIGIBLE),
        )
        for of, difference in off.items()
    ]
    stiffer = finding(
        claim="Fig 5: the spline overestimates the stiffness (at the end of the movement)",
        formulation=name,
        quantity="the signed difference of the stiffness to 20 finite elements at the end",
        value=float(off["stiffness"][-1]),
        holds=bool(answer.converged and off["stiffness"][-1] > 0.0),
    )
    return [*found, stiffer]


def _curve(
    name: str, path: Response | Reference, torque_error: Array, stiffness_error: Array
) -> pd.DataFrame:
    return pd.DataFrame(
        {
            "formulation": name,
            "rotation_rad": path.rotation,
            "torque_Nm": path.torque,
            "stiffness_Nm_per_rad": path.stiffness,
            "error_torque": torque_error,
            "error_stiffness": stiffness_error,
        }
    )


FIG05 = Study(
    parts=(Part(ask=_refined_curves), Part(at=lambda: SETTINGS, ask=_compared_curves)),
    figures={"fig05_stiffness": _stiffnesses},
)
"""Fig 5 of the paper: stiffness against rotation, the torque it belongs to, and the errors of both."""
