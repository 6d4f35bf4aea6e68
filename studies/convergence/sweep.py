"""Sweeps over refinement: one row a discretisation with its largest errors, failed ones included."""

from collections.abc import Iterable
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from studies.answers.adapters import answer_static
from studies.answers.metrics import observed_order
from studies.answers.reference import QUANTITIES, Reference, largest_errors, limit_of
from studies.answers.response import Response
from studies.answers.settings import FeSettings, SplineSettings
from studies.cases.design import Design
from studies.cases.problem import named_case
from studies.engine import Answer, Claim, Part, Study, Tables
from studies.kinds import Progress
from studies.paper.formulations import FE, LOOKS, SIX
from studies.record.marks import Doubt
from studies.record.panels import CONTROL_POINTS, MESH, Axis, Curves, Panel, sheet
from studies.record.progress import silent, watched
from studies.record.style import ELEMENTS

ERROR_COLUMNS = tuple(f"error_{name}" for name in QUANTITIES)

#: Meshes above this one are answered but not extrapolated from: their stiffness carries too much round-off.
FINEST = 160


def spline_row(problem: Design, setting: SplineSettings, against: Reference) -> dict[str, Any]:
    """Return what a spline is, how it ended, its errors, its work.

    Columns: basis, measure, stretch, control_points, axial_modes (none for consistent stretch), status,
    reached_rad (end of the converged part of the path), error_trajectory, error_torque, error_stiffness,
    error_stress (largest magnitudes over the path; empty when the path was not completed),
    newton_iterations, message.
    """
    return _described(setting) | _outcome(answer_static(problem, setting), against)


def element_sweep(
    problem: Design, elements: Iterable[int], element: str, progress: Progress = silent
) -> tuple[pd.DataFrame, Reference]:
    """Return one row a mesh with its errors against the limit of the meshes themselves, and that limit.

    Columns: element, elements, status, reached_rad, the four errors, their observed orders (from the pair of
    this mesh and the one before), newton_iterations, message.

    Raises:
        NoReference: a mesh does not reach the end of the path.
    """
    counts = list(elements)
    answers = [
        answer_static(problem, FeSettings(elements=count, element=element))
        for count in watched(counts, progress)
    ]
    limit = limit_of([answer for answer in answers if answer.settings["elements"] <= FINEST])
    rows = [
        {"element": element, "elements": count} | _outcome(answer, limit)
        for count, answer in zip(counts, answers, strict=True)
    ]
    return with_orders(pd.DataFrame(rows), "elements"), limit


def with_orders(table: pd.DataFrame, count: str) -> pd.DataFrame:
    """Return `table`, sorted by the column `count`, with the observed order of each error beside it."""
    table = table.sort_values(count).reset_index(drop=True)
    for name in QUANTITIES:
        values, counts = table[f"error_{name}"].to_numpy(float), table[count].to_numpy(float)
        orders = [np.nan] + [
            observed_order(values[i - 1], values[i], counts[i] / counts[i - 1]) for i in range(1, len(values))
        ]
        table[f"order_{name}"] = orders
    return table


def reaching(
    table: pd.DataFrame, count: str, accuracy: float, quantities: Iterable[str] = ("trajectory", "torque")
) -> int | None:
    """Return the smallest `count` from which on all errors of these quantities are within `accuracy`.

    None when no count of the table does; a failed row counts as an error of any size.
    """
    worst = table[[f"error_{name}" for name in quantities]].max(axis=1, skipna=False).fillna(np.inf)
    within = (worst <= accuracy)[::-1].cummin()[::-1]
    counts = table.loc[within, count]
    return None if counts.empty else int(counts.min())


def _described(setting: SplineSettings) -> dict[str, Any]:
    modes = setting.axial_modes
    if modes is None and setting.stretch != "consistent":
        modes = setting.points - 2
    return {
        "basis": setting.basis,
        "measure": setting.measure,
        "stretch": setting.stretch,
        "control_points": setting.points,
        "axial_modes": modes,
    }


def _outcome(answer: Response, against: Reference) -> dict[str, Any]:
    row: dict[str, Any] = {"status": answer.status, "reached_rad": answer.rotation[-1]}
    row |= dict.fromkeys(ERROR_COLUMNS, np.nan)
    if answer.converged:
        row |= {f"error_{name}": value for name, value in largest_errors(answer, against).items()}
    return row | {"newton_iterations": answer.counters["newton_iterations"], "message": answer.message}


def drawn(splines: pd.DataFrame, elements: pd.DataFrame, limit: Reference) -> Figure:
    """Draw the largest errors over the number of control points (above) and of elements (below).

    Args:
        splines, elements: rows of `spline_row` and of `element_sweep`.
        limit: the reference, for its uncertainty.
    """
    above, below = [], []
    for quantity in QUANTITIES:
        y = Axis(f"error_{quantity}", f"error of the {quantity} [1]", log=True)
        doubt = Doubt(limit.uncertainty[quantity])
        above.append(Panel(CONTROL_POINTS, y, (Curves(splines, LOOKS[SIX]), doubt)))
        below.append(Panel(MESH, y, (Curves(elements, LOOKS[FE]), doubt)))
    above[0], below[0] = replace(above[0], title="spline"), replace(below[0], title="finite elements")
    return sheet(11.5, 6.0, (above, below))


MESHES = (5, 10, 20, 40, 80, 160, 320)

#: Order of both elements, and how far the observed one may be from it to be called so.
ORDER, ALLOWANCE = 2.0, 0.1


def _refined(element: str) -> Answer:
    """Return the errors of every mesh of an element."""
    return {"meshes": element_sweep(named_case(), MESHES, element)[0]}


def _at(tables: Tables, count: int) -> list[dict[str, Any]]:
    """Return error and observed order of each quantity and element on one mesh."""
    rows = tables["meshes"].query("elements == @count").to_dict("records")
    return [
        {
            "name": ELEMENTS[row["element"]].label,
            "of": name,
            "error": row[f"error_{name}"],
            "order": row[f"order_{name}"],
        }
        for row in rows
        for name in QUANTITIES
    ]


ELEMENT_STUDY = Study(
    parts=(Part(at=lambda: ELEMENTS, ask=_refined),),
    claims=(
        Claim(
            claim="The {of} of the finite elements converges with order 2",
            formulation="{name}",
            quantity="the distance of the observed order (80 to 160 elements) from 2, over 2,",
            rows=lambda tables: _at(tables, 160),  # the last mesh above round-off
            value=lambda row: abs(row["order"] - ORDER) / ORDER,
            holds=lambda row: abs(row["order"] - ORDER) <= ALLOWANCE,
        ),
        Claim(
            claim="Twenty elements a strip give the {of} to 1 %",
            formulation="{name}",
            quantity="the largest error of 20 elements over the path",
            rows=lambda tables: _at(tables, 20),
            value="error",
            most=0.01,
        ),
    ),
)
"""Convergence of the finite elements with their number: errors and observed orders."""
