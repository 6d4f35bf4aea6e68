"""Errors against the slide stiffness: that of the strains which the axial-force modes do not see.

With n - 2 modes the control points of a straight strip can slide along it without strain energy; a stiffness
of these strains forbids it. Too little leaves the sliding slow, so that it takes part in a motion; too much
is locking again.
"""

from collections.abc import Iterator
from functools import partial
from itertools import product
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from spline_model.pivot import SLIDE_STIFFNESS, swinging_slide_stiffness
from studies.answers.adapters import answer_static
from studies.answers.metrics import swing_frequency
from studies.answers.reference import QUANTITIES, largest_errors
from studies.answers.settings import SplineSettings
from studies.cases.problem import named_case
from studies.engine.study import Answer, Claim, Part, Study, Tables
from studies.paper import formulations
from studies.record.panels import Axis, Curves, Panel, sheet
from studies.record.style import BLACK, COUNT_COLOURS, Look

#: Values in units of EI/L^2; EA is 3.5e3 of them for Table 1.
VALUES = (1e-3, 0.1, 1.0, 3.0, 10.0, 30.0, 100.0, 300.0, 1000.0)
COUNTS = range(4, 11)
#: Motions are dearer: fewer counts, and half the usual duration (two swings) [s].
MOVING_COUNTS = (4, 6, 8)
DURATION = 0.025

#: A default is called near the best when its error is at most this many times the least.
NEAR = 3.0

#: About what a default gives.
RING = Look(label="_", colour=BLACK, line="", marker="o", hollow=True)


def _defaults() -> list[dict[str, Any]]:
    """Return the models' own values."""
    own = [("statics", n, SLIDE_STIFFNESS) for n in COUNTS]
    own += [("motion", n, swinging_slide_stiffness(n)) for n in MOVING_COUNTS]
    return [dict(zip(("problem", "control_points", "slide_stiffness"), each, strict=True)) for each in own]


def _moving() -> list[tuple[int, float]]:
    """Return counts and values that are asked in motion: the default is among them."""
    return [(n, each) for n in MOVING_COUNTS for each in sorted({*VALUES, swinging_slide_stiffness(n)})]


def _figure(tables: Tables) -> Figure:
    """Draw the errors of torque, stiffness and rotation in motion over the slide stiffness."""
    static, moving = "Static path to 90°", f"{1e3 * DURATION:g} ms after the release"
    panels = (
        _panel(tables, "statics", "error_torque", "largest error of the torque [1]", static),
        _panel(tables, "statics", "error_stiffness", "largest error of the stiffness [1]", static),
        _panel(tables, "motion", "error_rotation_rad", "largest error of the rotation [rad]", moving),
    )
    return sheet(9.5, 4.4, [panels], legend=len(COUNTS))


def _panel(tables: Tables, problem: str, column: str, label: str, title: str) -> Panel:
    """Return the panel of one error, with a ring about that of each default."""
    rows, keys = tables[problem], ["control_points", "slide_stiffness"]
    looks = {n: Look(label=f"n = {n}", colour=COUNT_COLOURS[n], marker="o") for n in COUNTS}
    defaults = rows.merge(tables["defaults"].query("problem == @problem")[keys], on=keys)
    rings = Curves(defaults, RING, more={"markersize": 8.0})
    return Panel(
        Axis("slide_stiffness", "slide stiffness [EI/L²]", log=True),
        Axis(column, label, log=True),
        (Curves(rows, looks, by="control_points"), rings),
        title=title,
    )


def _static(n: int, value: float) -> Answer:
    """Return the row of one static path: status and largest errors against the limit of the elements."""
    settings = SplineSettings(control_points=n, slide_stiffness=value)
    answer = answer_static(named_case(), settings)
    row: dict[str, Any] = {"control_points": n, "slide_stiffness": value, "status": answer.status}
    found = largest_errors(answer, formulations.refined()) if answer.converged else {}
    return {"statics": row | {f"error_{name}": found.get(name, np.nan) for name in QUANTITIES}}


def _motion(n: int, value: float) -> Answer:
    """Return the row of one motion: status, largest error of the rotation and shift of the frequency."""
    instants = formulations.INSTANTS[formulations.INSTANTS <= DURATION]
    exact = formulations.refined_swing().swing.rotation[: len(instants)]
    motion = formulations.resolved(SplineSettings(control_points=n, slide_stiffness=value), duration=DURATION)
    shift = motion.frequency / swing_frequency(instants, exact).value - 1.0
    row = {
        "control_points": n,
        "slide_stiffness": value,
        "status": motion.status,
        "error_rotation_rad": formulations.rotation_error(motion, exact, instants),
        "frequency_shift": shift if motion.converged else np.nan,
    }
    return {"motion": row}


def _defaults_beside_best(tables: Tables, problem: str, column: str) -> Iterator[dict[str, Any]]:
    """Yield, for each count, the default and the best of the values, and the error of one over the other."""
    own = tables["defaults"].query("problem == @problem").set_index("control_points")["slide_stiffness"]
    for n, curve in tables[problem].groupby("control_points"):
        by_value = curve.set_index("slide_stiffness")[column].dropna()
        best, default = float(by_value.index[int(by_value.argmin())]), float(own[n])
        yield {"n": n, "default": default, "best": best, "excess": by_value[default] / by_value[best]}


STUDY = Study(
    parts=(
        Part(at=lambda: product(COUNTS, VALUES), ask=_static),
        Part(at=_moving, ask=_motion),
        Part(ask=lambda: {"defaults": _defaults()}),
    ),
    claims=tuple(
        Claim(
            claim=f"The default slide stiffness is near the best for the {what} (within {NEAR:g} x)",
            formulation="n = {n}",
            quantity="the error with {default:.3g} EI/L^2 over the least, with {best:g},",
            rows=partial(_defaults_beside_best, problem=problem, column=column),
            value="excess",
            most=NEAR,
        )
        for problem, column, what in (
            ("statics", "error_torque", "torque on the path"),
            ("motion", "error_rotation_rad", "rotation in motion"),
        )
    ),
    figures={"slide_stiffness": _figure},
)
