"""Fig 5 of the paper: stiffness against rotation, the torque it belongs to, and the errors of both."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from studies.answers.metrics import relative_error
from studies.answers.reference import Reference, errors
from studies.answers.response import Response
from studies.engine.study import Answer, Finding, Part, Study, Tables
from studies.kinds import Array
from studies.paper import formulations
from studies.paper.formulations import CASE, FE, REFINED, SETTINGS
from studies.record.style import LOOKS, page, uncertain

#: "Negligible" is read as the width of a line in a printed plot, about this part of the full scale.
NEGLIGIBLE = 0.03


def _compared(name: str) -> Answer:
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


def _refined() -> Answer:
    """Return the reference: its curves and its uncertainties."""
    limit = formulations.refined()
    nothing = np.zeros(len(limit.rotation))
    uncertainties = [
        {"quantity": name, "uncertainty": limit.uncertainty[name]} for name in ("torque", "stiffness")
    ]
    return {"curves": _curve(REFINED, limit, nothing, nothing), "reference": uncertainties}


def _figure(tables: Tables) -> Figure:
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
        f"as the paper:\nup to {locked:,.0f}",
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


STUDY = Study(
    cases=(CASE,),
    parts=(Part(ask=_refined), Part(at=lambda: SETTINGS, ask=_compared)),
    figures={"fig05_stiffness": _figure},
)
