"""Figs 4 and 5 of the paper: path of the body's centre, torque, stiffness over the rotation, and errors."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from studies.answers.metrics import relative_error, trajectory_error
from studies.answers.reference import Reference, errors
from studies.answers.response import Response
from studies.engine.study import Answer, Claim, Finding, Part, Study, Tables
from studies.kinds import Array
from studies.paper import formulations
from studies.paper.formulations import FE, REFINED, SETTINGS
from studies.record.style import LOOKS, page, uncertain

BOUND = 0.01


def _compared_paths(name: str) -> Answer:
    """Return a formulation's path, its error against the refined elements, and a summary."""
    answer, limit = formulations.answer(name), formulations.refined()
    error = errors(answer, limit).trajectory
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
    drawn = page(9.5, 5.6)
    panels = drawn.subplot_mosaic([["path", "error"], ["end", "error"]])
    plane, end, panel = panels["path"], panels["end"], panels["error"]
    for name, look in LOOKS.items():
        path = tables["paths"].query("formulation == @name")
        for view in (plane, end):
            view.plot(1e3 * path["com_x_m"], 1e3 * path["com_y_m"], **look.keywords(), markersize=3.5)
        moved = path[path["error_trajectory"] > 0.0]
        if name != REFINED:
            panel.semilogy(np.degrees(moved["rotation_rad"]), moved["error_trajectory"], **look.keywords())
    for view in (plane, end):
        view.set(xlabel="x of the centre of mass [mm]", ylabel="y [mm]", aspect="equal")
    plane.set_title("Path from 0 to 90°")
    last = 1e3 * tables["paths"].query("formulation == @REFINED")[["com_x_m", "com_y_m"]].to_numpy()[-1]
    end.set(xlim=last[0] + np.array([-0.8, 2.2]), ylim=last[1] + np.array([-0.3, 1.4]))
    end.set_title("Its end, enlarged")
    drawn.legend(*plane.get_legend_handles_labels(), loc="outside lower center", ncols=4)
    uncertain(panel, tables["reference"]["uncertainty"].max())
    panel.axhline(BOUND, color="#444444", linewidth=0.8)
    panel.annotate("the paper's 1 %", (2.0, BOUND), xytext=(0, 3), textcoords="offset points", fontsize=8)
    panel.set(
        xlabel="rotation [deg]", ylabel="distance to the refined path / travel [1]", xticks=range(0, 91, 15)
    )
    panel.set_title("Error of the path")
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
        "error_torque_half": error.torque[half] if half < len(error.torque) else np.nan,
        "error_torque_end": error.torque[-1],
        "error_torque_largest": float(np.abs(error.torque).max()),
        "error_stiffness_end": error.stiffness[-1],
        "error_stiffness_largest": float(np.abs(error.stiffness).max()),
        "axial_energy_end_J": answer.axial_energy[-1],
        "bending_energy_end_J": answer.bending_energy[-1],
        "max_stress_end_Pa": answer.max_stress[-1],
    }
    return {
        "curves": _curve(name, answer, error.torque, error.stiffness),
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
    drawn = page(9.0, 7.0)
    panels = drawn.subplots(2, 2, sharex=True)
    for column, (quantity, unit) in enumerate((("torque", "Nm"), ("stiffness", "Nm_per_rad"))):
        above, below = panels[:, column]
        for name, look in LOOKS.items():
            curve = tables["curves"].query("formulation == @name")
            degrees = np.degrees(curve["rotation_rad"])
            above.plot(degrees, curve[f"{quantity}_{unit}"], **look.keywords(), markevery=2)
            if name != REFINED:
                size = np.abs(curve[f"error_{quantity}"])
                below.semilogy(degrees[degrees != 0.0], size[degrees != 0.0], **look.keywords())
        _annotate(above, below, tables["curves"], f"{quantity}_{unit}")
        uncertain(below, tables["reference"].query("quantity == @quantity")["uncertainty"].max())
    panels[0, 0].set(ylabel="driving torque [N m]")
    panels[0, 1].set(ylabel="stiffness dT/dθ [N m / rad]")
    panels[1, 0].set(ylabel="|error of the torque| [1]")
    panels[1, 1].set(ylabel="|error of the stiffness| [1]")
    drawn.legend(*panels[0, 0].get_legend_handles_labels(), loc="outside upper center", ncols=4)
    return drawn


def _annotate(above: Axes, below: Axes, curves: pd.DataFrame, column: str) -> None:
    """Limit the upper panel to what can be compared there, and say where locking leaves it."""
    top = 1.8 * curves.query("formulation == @REFINED")[column].max()
    above.set_ylim(0.0, top)
    locked = curves.query("formulation == @formulations.PAPER")[column].max()
    above.annotate(
        f"as the paper:\nup to {locked:.0f} {'N m' if 'torque' in column else 'N m/rad'}",
        (0.03, 0.86),
        xycoords="axes fraction",
        color=LOOKS[formulations.PAPER].colour,
        fontsize=8,
    )
    below.axhline(NEGLIGIBLE, color="#444444", linewidth=0.8)
    below.annotate("3 %", (1.0, NEGLIGIBLE), xytext=(0, 3), textcoords="offset points", fontsize=8)
    below.set(xlabel="rotation [deg]", xticks=range(0, 91, 15))


def _findings(name: str, answer: Response, against: Response) -> list[Finding]:
    """Return the claims of Fig 5 held against one formulation, compared with 20 elements as there."""
    off = {of: relative_error(getattr(answer, of), getattr(against, of)) for of in ("torque", "stiffness")}
    found = [
        Finding(
            claim=f"Fig 5: the differences are negligible ({of} within 3 % at every rotation)",
            formulation=name,
            quantity=f"the largest difference of the {of} to 20 finite elements",
            value=float(np.abs(difference).max()),
            holds=bool(answer.converged and np.abs(difference).max() < NEGLIGIBLE),
        )
        for of, difference in off.items()
    ]
    stiffer = Finding(
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
