"""Convergence of the splines: with their control points in every form, and with their slide stiffness."""

from collections.abc import Iterator
from functools import partial
from itertools import product
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure

from spline_model.pivot import SLIDE_STIFFNESS, swinging_slide_stiffness
from studies.answers.adapters import answer_static
from studies.answers.metrics import swing_frequency
from studies.answers.reference import QUANTITIES, largest_errors
from studies.answers.settings import SplineSettings
from studies.cases.problem import named_case
from studies.convergence.sweep import reaching, spline_row
from studies.engine import Answer, Claim, Part, Study, Tables, percent
from studies.paper import formulations
from studies.paper.formulations import refined
from studies.record.digits import Digits
from studies.record.marks import Doubt
from studies.record.panels import CONTROL_POINTS, Axis, Curves, Panel, sheet
from studies.record.style import BASES, BLACK, COUNT_COLOURS, STRETCH, Look, page

COUNTS = range(4, 13)
MEASURES = ("material", "spatial")
#: Error that is asked of trajectory and torque [1].
CLOSE = 1e-4


def _settings() -> list[SplineSettings]:
    """Return every discretisation of the map: basis, measure, stretch form, n, and m = 1 ... n - 1."""
    forms: list[tuple[str, int, str, int | None]] = []
    for n in COUNTS:
        forms += [(measure, n, "consistent", None) for measure in MEASURES]
        forms += [("material", n, stretch, m) for stretch in ("mixed", "inextensible") for m in range(1, n)]
    return [
        SplineSettings(basis=basis, measure=measure, control_points=n, stretch=stretch, axial_modes=m)
        for basis in BASES
        for measure, n, stretch, m in forms
    ]


def _default_modes(rows: pd.DataFrame) -> pd.DataFrame:
    """Return the rows of the default m = n - 2, and those of consistent stretch, which has no modes."""
    return rows[(rows["stretch"] == "consistent") | (rows["axial_modes"] == rows["control_points"] - 2)]


def _lines(tables: Tables) -> Figure:
    rows, limits = _default_modes(tables["map"]), tables["reference"]
    lines = []
    for quantity in ("trajectory", "torque"):
        y = Axis(f"error_{quantity}", f"largest error of the {quantity} [1]", log=True)
        doubt = Doubt(float(limits["uncertainty"][limits["quantity"] == quantity].max()))
        forms = [Curves(rows[rows["basis"] == basis], STRETCH, by=("stretch", "measure")) for basis in BASES]
        lines.append([Panel(CONTROL_POINTS, y, (curves, doubt)) for curves in forms])
    return sheet(9.5, 6.6, lines, columns=list(BASES.values()), legend=3)


def _maps(tables: Tables) -> Figure:
    figure = page(9.5, 4.4)
    panels = figure.subplots(1, 2, sharey=True)
    rows = tables["map"].query("stretch == 'mixed' and measure == 'material'")
    norm = LogNorm(1e-10, 1.0)
    for panel, (basis, label) in zip(panels, BASES.items(), strict=True):
        _map(panel, rows[rows["basis"] == basis], norm)
        panel.set_title(label)
        panel.set_xlabel("control points a strip, n")
    panels[0].set_ylabel("axial-force modes a strip, m")
    figure.suptitle("Numbers: decimal exponent of the error; rings: the default m = n - 2; x: not converged")
    figure.colorbar(panels[0].collections[0], ax=panels, label="largest error of the torque [1]")
    return figure


def _map(panel: Axes, rows: pd.DataFrame, norm: LogNorm) -> None:
    """Draw the errors as coloured squares with their decimal exponent; a failed point is a cross."""
    modes = np.arange(1, max(COUNTS))
    told: list[str] = ["axial_modes", "control_points", "error_torque"]
    for m, n, error in rows[told].itertuples(index=False):
        text = f"{np.log10(error):.0f}" if np.isfinite(error) else "x"
        colour = "white" if error < 1e-5 else "black"
        panel.text(n, m, text, ha="center", va="center", fontsize=7.5, color=colour)
    grid = rows.pivot(index=told[0], columns=told[1], values=told[2]).reindex(index=modes, columns=COUNTS)
    edges = np.arange(COUNTS[0] - 0.5, COUNTS[-1] + 1.0)
    panel.pcolormesh(edges, np.arange(0.5, len(modes) + 1.0), grid, norm=norm, cmap="viridis")
    panel.grid(False)
    panel.plot(COUNTS, np.array(COUNTS) - 2, "o", markersize=15, markerfacecolor="none", color="white")
    panel.set(xticks=list(COUNTS), yticks=list(modes))


def _forms(tables: Tables) -> Iterator[dict[str, Any]]:
    """Yield, for each basis and stretch form with its default modes, the error of the torque with four
    control points, the least of any, and from which count on trajectory and torque are close."""
    chosen = _default_modes(tables["map"]).query("measure == 'material'")
    for (basis, stretch), curve in chosen.groupby(["basis", "stretch"]):
        count = reaching(curve, "control_points", CLOSE)
        yield {
            "name": f"{BASES[str(basis)]}, {stretch} stretch",
            "four": curve.query("control_points == 4")["error_torque"].iloc[0],
            "best": curve["error_torque"].min(),
            "reaches": count is not None,
            "place": f" (within it from n = {count})" if count else "",
        }


MAP_STUDY = Study(
    parts=(
        Part(at=_settings, ask=lambda each: {"map": spline_row(named_case(), each, refined())}),
        Part(
            at=lambda: QUANTITIES,
            ask=lambda name: {"reference": {"quantity": name, "uncertainty": refined().uncertainty[name]}},
        ),
    ),
    claims=(
        Claim(
            claim="Four control points give the torque to 3 % on the whole path",
            formulation="{name}",
            quantity="the largest error of the torque with four control points",
            rows=_forms,
            value="four",
            most=0.03,
        ),
        Claim(
            claim=f"At most {COUNTS[-1]} control points give trajectory and torque to {percent(CLOSE)}",
            formulation="{name}",
            quantity="the smallest error of the torque{place}",
            rows=_forms,
            value="best",
            holds=lambda row: row["reaches"],
        ),
    ),
    figures={"control_points": _lines, "locking_map": _maps},
)
"""Convergence of the splines with their control points in every form: the locking map."""


#: Values in units of EI/L^2; EA is 3.5e3 of them for Table 1.
VALUES = (1e-3, 0.1, 1.0, 3.0, 10.0, 30.0, 100.0, 300.0, 1000.0)
COUNTED = range(4, 11)
#: Motions are dearer: fewer counts, and half the usual duration (two swings) [s].
MOVING_COUNTS = (4, 6, 8)
DURATION = 0.025

#: A default is called near the best when its error is at most this many times the least.
NEAR = 3.0

#: About what a default gives.
RING = Look(label="_", colour=BLACK, line="", marker="o", hollow=True)


def _defaults() -> list[dict[str, Any]]:
    """Return the models' own values."""
    own = [("statics", n, SLIDE_STIFFNESS) for n in COUNTED]
    own += [("motion", n, swinging_slide_stiffness(n)) for n in MOVING_COUNTS]
    return [dict(zip(("problem", "control_points", "slide_stiffness"), each, strict=True)) for each in own]


def _moving() -> list[tuple[int, float]]:
    """Return counts and values that are asked in motion: the default is among them."""
    return [(n, each) for n in MOVING_COUNTS for each in sorted({*VALUES, swinging_slide_stiffness(n)})]


def _slides(tables: Tables) -> Figure:
    """Draw the errors of torque, stiffness and rotation in motion over the slide stiffness."""
    static, moving = "Static path to 90°", f"{1e3 * DURATION:g} ms after the release"
    panels = (
        _slide(tables, "statics", "error_torque", "largest error of the torque [1]", static),
        _slide(tables, "statics", "error_stiffness", "largest error of the stiffness [1]", static),
        _slide(tables, "motion", "error_rotation_rad", "largest error of the rotation [rad]", moving),
    )
    return sheet(9.5, 4.4, [panels], legend=len(COUNTED))


def _slide(tables: Tables, problem: str, column: str, label: str, title: str) -> Panel:
    """Return the panel of one error, with a ring about that of each default."""
    rows, keys = tables[problem], ["control_points", "slide_stiffness"]
    looks = {n: Look(label=f"n = {n}", colour=COUNT_COLOURS[n], marker="o") for n in COUNTED}
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
    found = largest_errors(answer, refined()) if answer.converged else {}
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


SLIDE_STUDY = Study(
    parts=(
        Part(at=lambda: product(COUNTED, VALUES), ask=_static),
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
    digits={"findings.value": Digits(relative=1e-5)},  # places of a search
    figures={"slide_stiffness": _slides},
)
"""Errors against the slide stiffness: that of the strains which the axial-force modes do not see.

With n - 2 modes the control points of a straight strip can slide along it without strain energy; a stiffness
of these strains forbids it. Too little leaves the sliding slow, so that it takes part in a motion; too much
is locking again.
"""
