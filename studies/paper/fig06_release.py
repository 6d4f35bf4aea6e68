"""Fig 6 of the paper: the motion of the body's centre after the release from 90 degrees, and its errors."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from studies.answers.motion import Motion
from studies.answers.reference import SolvedMotion, SwingReference, sampled
from studies.answers.settings import SplineSettings
from studies.engine import Answer, Part, Row, Study, Tables, finding
from studies.paper import formulations
from studies.paper.formulations import FE, LOCKING_FREE, LOOKS, PAPER, REFINED, SETTINGS, SIX
from studies.record.panels import TIME, Axis, Curves, Doubt, Panel, sheet
from studies.record.style import GREEN, Look

#: Formulations of Fig 6, and the refined spline that the reference, which it shares nothing with, is held to.
SPLINES, REFINED_SPLINE = (PAPER, LOCKING_FREE, SIX), "n = 10"

#: "Slightly different" is read as a tenth of what the centre travels.
SLIGHT = 0.1

#: Every so many of the common instants is stored: some sixty a swing.
STORED = slice(None, None, 2)

QUANTITIES = (
    ("rotation_rad", "rotation [deg]", 180.0 / np.pi),
    ("com_x_m", "x of the centre [mm]", 1e3),
    ("com_y_m", "y of the centre [mm]", 1e3),
)

#: Lines of the figure: motions have too many points for markers.
LINES = {name: replace(LOOKS[name], marker="") for name in (REFINED, FE, *SPLINES)}
LINES[REFINED_SPLINE] = Look(label="spline n = 10", colour=GREEN, line=":")


def _compared() -> Answer:
    """Return motions with their differences to the limit of refinement, summaries and findings.

    `reference` has the uncertainties of the limit: in rad, in m, relative for the frequency. All of it is one
    point, since the limit takes most of the time.
    """
    limit = formulations.refined_swing()
    asked = {name: SETTINGS[name] for name in (*SPLINES, FE)}
    asked[REFINED_SPLINE] = SplineSettings(control_points=10)
    motions = {name: formulations.resolved(settings) for name, settings in asked.items()}
    traces = {name: sampled(motion, formulations.INSTANTS) for name, motion in motions.items()}
    return {
        "motions": pd.concat(_trace(name, each, limit) for name, each in {REFINED: limit, **traces}.items()),
        "summary": [_summary(name, motions[name], trace, limit) for name, trace in traces.items()],
        "findings": [row for name in SPLINES for row in _findings(name, motions, traces)],
        "reference": [{"quantity": name, "uncertainty": each} for name, each in limit.uncertainty.items()],
    }


def _figure(tables: Tables) -> Figure:
    """Draw rotation and x over time beside the largest differences to the reference so far, and energy.

    Where curves cross the difference is nought, which says nothing of how far a swing has strayed.
    """
    motions = tables["motions"].sort_values(["formulation", "time_s"])
    motions["energy_J"] = motions["strain_J"] + motions["kinetic_J"]
    whole = motions.groupby("formulation")["energy_J"]
    motions["change"] = (motions["energy_J"] / whole.transform("first") - 1.0).abs().clip(lower=1e-8)
    level = tables["reference"].set_index("quantity")["uncertainty"]
    rows = []
    for column, label, factor in QUANTITIES[:2]:
        far = Axis(f"difference_{column}", f"difference {label[label.index('[') :]}", factor=factor, log=True)
        so_far = _largest(motions, far, Doubt(factor * level[column]))
        rows.append([_values(motions, Axis(column, label, factor=factor)), so_far])
    change = _largest(motions, Axis("change", "change of energy [1]", log=True))
    rows.append([_values(motions, Axis("strain_J", "strain energy [J]")), change])
    titles = ("After the release from 90°", "Largest difference to refined elements so far")
    return sheet(8.8, 6.2, rows, columns=titles, legend=3)


def _values(motions: pd.DataFrame, y: Axis) -> Panel:
    """Return the panel of a quantity; the reference is broad and lies below the others, which cover it."""
    broad = Curves(motions, {REFINED: LINES[REFINED]}, more={"linewidth": 2.8, "zorder": 1.9})
    others = {name: look for name, look in LINES.items() if name not in (REFINED, REFINED_SPLINE)}
    return Panel(TIME, y, (broad, Curves(motions, others)))


def _largest(motions: pd.DataFrame, y: Axis, *marks: Doubt) -> Panel:
    """Return the panel of the largest size of a difference so far."""
    late = motions[motions["time_s"] > 0.0]
    so_far = late.assign(**{y.column: late[y.column].abs().groupby(late["formulation"]).cummax()})
    others = {name: look for name, look in LINES.items() if name != REFINED}
    return Panel(TIME, y, (Curves(so_far, others), *marks))


def _trace(name: str, swing: SolvedMotion, limit: SolvedMotion) -> pd.DataFrame:
    columns = {
        "formulation": name,
        "time_s": swing.time,
        "rotation_rad": swing.rotation,
        "com_x_m": swing.centre[:, 0],
        "com_y_m": swing.centre[:, 1],
        "kinetic_J": swing.kinetic_energy,
        "strain_J": swing.strain_energy,
        "difference_rotation_rad": swing.rotation - limit.rotation,
        "difference_com_x_m": (swing.centre - limit.centre)[:, 0],
        "difference_com_y_m": (swing.centre - limit.centre)[:, 1],
    }
    return pd.DataFrame(columns)[STORED]


def _summary(name: str, motion: Motion, trace: SolvedMotion, limit: SwingReference) -> Row:
    return {
        "formulation": name,
        "status": motion.status,
        "frequency_shift": motion.frequency / limit.frequency - 1.0,
        "error_rotation_rad": float(np.abs(trace.rotation - limit.rotation).max()),
    }


def _findings(name: str, motions: Mapping[str, Motion], traces: Mapping[str, SolvedMotion]) -> list[Row]:
    """Return the claims of Fig 6 held against a spline, compared with 20 elements as there."""
    motion, twenty = motions[name], traces[FE].centre
    distance = np.linalg.norm(traces[name].centre - twenty, axis=1).max()
    distance /= np.linalg.norm(np.ptp(twenty, axis=0))  # the diagonal of the rectangle that the path fills
    shift = motion.frequency / motions[FE].frequency - 1.0
    return [
        finding(
            claim="Fig 6: the two time histories are slightly different "
            "(within 10 % of the travel over 0.05 s)",
            formulation=name,
            quantity="the largest distance to the centre of 20 finite elements, over its travel,",
            value=float(distance),
            holds=bool(motion.converged and distance < SLIGHT),
        ),
        finding(
            claim="Fig 6: the spline swings at a higher frequency than 20 finite elements",
            formulation=name,
            quantity="the signed difference of the frequency to 20 finite elements",
            value=shift,
            holds=motion.converged and shift > 0.0,
        ),
    ]


STUDY = Study(
    parts=(Part(ask=_compared),),
    figures={"fig06_release": _figure},
)
