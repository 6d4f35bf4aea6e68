"""Fig 6 of the paper: the motion of the body's centre after the release from 90 degrees, and its errors."""

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from studies.answers.motion import Motion
from studies.answers.reference import Swing, SwingReference, sampled
from studies.answers.settings import SplineSettings
from studies.engine.study import Answer, Finding, Part, Study, Tables
from studies.paper import formulations
from studies.paper.formulations import FE, LOCKING_FREE, MEANING, PAPER, REFINED, SETTINGS
from studies.record.style import CHECK, LOOKS, page, uncertain

#: Formulations of Fig 6, and the refined spline that the reference, which it shares nothing with, is held to.
SPLINES = (PAPER, LOCKING_FREE, "n = 6")
REFINED_SPLINE = "n = 10"

#: "Slightly different" is read as a tenth of what the centre travels.
SLIGHT = 0.1

#: Every so many of the common instants is stored: some sixty a swing.
STORED = 2

QUANTITIES = (
    ("rotation_rad", "rotation [deg]", 180.0 / np.pi),
    ("com_x_m", "x of the centre [mm]", 1e3),
    ("com_y_m", "y of the centre [mm]", 1e3),
)


def _compared(name: str) -> Answer:
    """Return a motion with its differences to the limit of refinement, its summary and the findings."""
    motion, limit = _motion(name), formulations.refined_swing()
    return {
        "motions": _trace(name, sampled(motion, formulations.INSTANTS), limit.swing),
        "summary": _summary(name, motion, limit),
        "findings": _findings(name, motion, _motion(FE)) if name in SPLINES else [],
    }


def _refined() -> Answer:
    """Return the limit of refinement and its uncertainties: in rad, in m, relative for the frequency."""
    limit = formulations.refined_swing()
    largest = {
        "rotation_rad": float(limit.uncertainty.max()),
        "com_x_m": float(limit.centre_uncertainty[:, 0].max()),
        "com_y_m": float(limit.centre_uncertainty[:, 1].max()),
        "frequency": limit.frequency_uncertainty,
    }
    return {
        "motions": _trace(REFINED, limit.swing, limit.swing),
        "reference": [{"quantity": name, "uncertainty": value} for name, value in largest.items()],
    }


def _figure(tables: Tables) -> Figure:
    """Draw rotation, x and y over time beside the largest differences to the reference so far, and energy.

    Where curves cross the difference is nought, which says nothing of how far a swing has strayed.
    """
    drawn = page(8.8, 8.0)
    panels = drawn.subplots(4, 2, sharex=True)
    motions = tables["motions"]
    level = tables["reference"].set_index("quantity")["uncertainty"]
    for (value, error), (column, label, scale) in zip(panels, QUANTITIES, strict=False):
        for name, curve in motions.groupby("formulation", sort=False):
            look = _look(str(name))
            time = 1e3 * curve["time_s"]
            if name != REFINED_SPLINE:
                value.plot(time, scale * curve[column], **look)
            if name != REFINED:
                late = curve["time_s"] > 0.0
                error.semilogy(time[late], scale * curve[f"difference_{column}"].abs()[late].cummax(), **look)
        value.set_ylabel(label)
        error.set_ylabel(f"difference {label[label.index('[') :]}")
        uncertain(error, scale * level[column])
        error.minorticks_off()  # hundreds of marks that say nothing
    _energies(panels[3, 0], panels[3, 1], motions)
    panels[0, 0].set_title("After the release from 90°")
    panels[0, 1].set_title("Largest difference to refined elements so far")
    handles, labels = panels[0, 1].get_legend_handles_labels()
    refined = panels[0, 0].get_legend_handles_labels()
    first = refined[1].index(LOOKS[REFINED].label)
    drawn.legend(
        [refined[0][first], *handles], [refined[1][first], *labels], loc="outside lower center", ncols=3
    )
    return drawn


def _energies(value: Axes, error: Axes, motions: pd.DataFrame) -> None:
    """Draw the strain energy, and the change of the whole energy, over time."""
    for name, curve in motions.groupby("formulation", sort=False):
        look = _look(str(name))
        if name != REFINED_SPLINE:
            value.plot(1e3 * curve["time_s"], curve["strain_J"], **look)
        if name != REFINED:
            total = curve["strain_J"] + curve["kinetic_J"]
            late = curve["time_s"] > 0.0
            change = (total / total.iloc[0] - 1.0).abs()[late]
            error.semilogy(1e3 * curve["time_s"][late], change.clip(lower=1e-16).cummax(), **look)
    value.set(ylabel="strain energy [J]", xlabel="time [ms]")
    error.set(ylabel="change of energy [1]", xlabel="time [ms]")
    error.minorticks_off()


def _look(name: str) -> dict[str, Any]:
    """Return the line of a formulation; the reference is broad and lies below the others, which cover it."""
    look = (CHECK if name == REFINED_SPLINE else LOOKS[name]).keywords() | {"marker": ""}
    return look | ({"linewidth": 2.8, "zorder": 1.9} if name == REFINED else {})


def _motion(name: str) -> Motion:
    """Return the motion of one formulation: the splines' at a resolved step, the elements' at their own."""
    settings = SplineSettings(control_points=10) if name == REFINED_SPLINE else SETTINGS[name]
    return (
        formulations.resolved(settings)
        if isinstance(settings, SplineSettings)
        else formulations.released(settings)
    )


def _trace(name: str, swing: Swing, limit: Swing) -> pd.DataFrame:
    kept = slice(None, None, STORED)
    return pd.DataFrame(
        {
            "formulation": name,
            "time_s": swing.time[kept],
            "rotation_rad": swing.rotation[kept],
            "com_x_m": swing.centre[kept, 0],
            "com_y_m": swing.centre[kept, 1],
            "kinetic_J": swing.kinetic_energy[kept],
            "strain_J": swing.strain_energy[kept],
            "difference_rotation_rad": (swing.rotation - limit.rotation)[kept],
            "difference_com_x_m": (swing.centre - limit.centre)[kept, 0],
            "difference_com_y_m": (swing.centre - limit.centre)[kept, 1],
        }
    )


def _summary(name: str, motion: Motion, limit: SwingReference) -> dict[str, Any]:
    swing = sampled(motion, formulations.INSTANTS)
    return {
        "formulation": name,
        "meaning": MEANING.get(name, "material measure, mixed stretch: refined, a check of the reference"),
        "status": motion.status,
        "frequency_Hz": motion.frequency,
        "frequency_shift": motion.frequency / limit.frequency - 1.0,
        "error_rotation_rad": float(np.abs(swing.rotation - limit.swing.rotation).max()),
        "error_centre_m": float(np.linalg.norm(swing.centre - limit.swing.centre, axis=1).max()),
        "energy_error": motion.energy_error,
        "constraint_residual_m": float(motion.constraint_residual.max()),
        "integrator": motion.settings["integrator"],
        "step_s": motion.settings["step_s"],
    }


def _findings(name: str, motion: Motion, elements: Motion) -> list[Finding]:
    """Return the claims of Fig 6 held against a spline, compared with 20 elements as there."""
    twenty = sampled(elements, formulations.INSTANTS).centre
    distance = np.linalg.norm(sampled(motion, formulations.INSTANTS).centre - twenty, axis=1).max()
    distance /= np.linalg.norm(np.ptp(twenty, axis=0))  # the diagonal of the rectangle that the path fills
    shift = motion.frequency / elements.frequency - 1.0
    return [
        Finding(
            claim="Fig 6: the two time histories are slightly different "
            "(within 10 % of the travel over 0.05 s)",
            formulation=name,
            quantity="the largest distance to the centre of 20 finite elements, over its travel,",
            value=float(distance),
            holds=bool(motion.converged and distance < SLIGHT),
        ),
        Finding(
            claim="Fig 6: the spline swings at a higher frequency than 20 finite elements",
            formulation=name,
            quantity="the signed difference of the frequency to 20 finite elements",
            value=shift,
            holds=motion.converged and shift > 0.0,
        ),
    ]


STUDY = Study(
    parts=(Part(ask=_refined), Part(at=lambda: (*SPLINES, FE, REFINED_SPLINE), ask=_compared)),
    figures={"fig06_release": _figure},
)
