"""Fig 4 of the paper: the path of the body's centre of mass, and how far each formulation is off it."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from studies.answers.metrics import trajectory_error
from studies.answers.reference import errors
from studies.engine.study import Answer, Claim, Part, Study, Tables
from studies.paper import formulations
from studies.paper.formulations import CASE, FE, REFINED, SETTINGS
from studies.record.style import LOOKS, page, uncertain

BOUND = 0.01


def _compared(name: str) -> Answer:
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


def _refined() -> Answer:
    """Return the reference: its path and its uncertainty."""
    limit = formulations.refined()
    return {
        "paths": _path(REFINED, limit.rotation, limit.centre, np.zeros(len(limit.rotation))),
        "reference": {"quantity": "trajectory", "uncertainty": limit.uncertainty["trajectory"]},
    }


def _figure(tables: Tables) -> Figure:
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


STUDY = Study(
    cases=(CASE,),
    parts=(Part(ask=_refined), Part(at=lambda: SETTINGS, ask=_compared)),
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
    figures={"fig04_trajectory": _figure},
)
