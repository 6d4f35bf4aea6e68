"""Convergence of the finite elements with their number: errors, observed orders, limit and uncertainty."""

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from studies.answers.reference import QUANTITIES, Reference
from studies.cases.problem import named_case
from studies.convergence.sweep import element_sweep
from studies.engine.study import Answer, Claim, Part, Study, Tables
from studies.paper.formulations import CASE
from studies.record.style import ELEMENTS, page

MESHES = (5, 10, 20, 40, 80, 160, 320)

#: Order of both elements, and how far the observed one may be from it to be called so.
ORDER, ALLOWANCE = 2.0, 0.1


def _refined(element: str) -> Answer:
    """Return the errors of every mesh of an element, and the limits."""
    rows, limit = element_sweep(named_case(CASE), MESHES, element)
    return {"meshes": rows, "limits": _limits(element, limit)}


def _figure(tables: Tables) -> Figure:
    """Draw the errors over the number of elements, one panel a quantity."""
    drawn = page(11.5, 3.9)
    panels = drawn.subplots(1, len(QUANTITIES))
    for panel, quantity in zip(panels, QUANTITIES, strict=True):
        for element, look in ELEMENTS.items():
            rows = tables["meshes"][tables["meshes"]["element"] == element]
            panel.loglog(rows["elements"], rows[f"error_{quantity}"], **look.keywords())
        _second_order(panel, tables["meshes"], f"error_{quantity}")
        panel.set(xlabel="elements a strip", ylabel=f"largest error of the {quantity} [1]")
        panel.set_xticks(MESHES, labels=[str(mesh) for mesh in MESHES], minor=False)
        panel.minorticks_off()
    handles, labels = panels[0].get_legend_handles_labels()
    drawn.legend(handles, labels, loc="outside lower center", ncols=3)
    return drawn


def _second_order(panel: Axes, meshes: pd.DataFrame, column: str) -> None:
    """Draw the slope of second order, a little below the errors so that it can be seen."""
    first = meshes.sort_values("elements").iloc[0]
    counts = np.array([MESHES[0], MESHES[-1]])
    slope = 0.5 * first[column] * (MESHES[0] / counts) ** ORDER
    panel.loglog(counts, slope, ":", color="#444444", label="order 2")


def _limits(element: str, limit: Reference) -> list[dict[str, Any]]:
    """Return the end values in the limit of refinement with their relative uncertainty."""
    values = {
        "com_x_m": (limit.centre[-1, 0], "trajectory"),
        "com_y_m": (limit.centre[-1, 1], "trajectory"),
        "torque_Nm": (limit.torque[-1], "torque"),
        "stiffness_Nm_per_rad": (limit.stiffness[-1], "stiffness"),
        "max_stress_Pa": (limit.stress[-1], "stress"),
    }
    return [
        {
            "element": element,
            "quantity": quantity,
            "limit": value,
            "relative_uncertainty": limit.uncertainty[kind],
        }
        for quantity, (value, kind) in values.items()
    ]


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


STUDY = Study(
    cases=(CASE,),
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
    figures={"elements": _figure},
)
