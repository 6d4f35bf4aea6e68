"""Convergence of the finite elements with their number: errors, observed orders, limit and uncertainty."""

from collections.abc import Callable, Mapping

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from studies.answers.reference import Reference
from studies.cases.problem import named_case
from studies.convergence.sweep import QUANTITIES, element_sweep
from studies.paper.findings import Finding, table
from studies.record.style import ELEMENTS, page

CASE = "cross_axis_pivot"
CASES = (CASE,)

MESHES = (5, 10, 20, 40, 80, 160, 320)

#: Order of both elements, and how far the observed one may be from it to be called so.
ORDER, ALLOWANCE = 2.0, 0.1


def compute(progress: Callable[[int, int], None]) -> dict[str, pd.DataFrame]:
    """Return the errors of every mesh of both elements, the limits, and findings on order and accuracy."""
    problem = named_case(CASE)
    meshes, limits, found = [], [], []
    for index, element in enumerate(ELEMENTS):
        rows, limit = element_sweep(problem, MESHES, element)
        progress(index + 1, len(ELEMENTS))
        meshes.append(rows)
        limits.append(_limits(element, limit))
        found += _findings(element, rows)
    return {"meshes": pd.concat(meshes), "limits": pd.concat(limits), "findings": table(found)}


def draw(tables: Mapping[str, pd.DataFrame]) -> dict[str, Figure]:
    """Draw the errors over the number of elements, one panel a quantity."""
    figure = page(9.5, 3.9)
    panels = figure.subplots(1, len(QUANTITIES))
    for panel, quantity in zip(panels, QUANTITIES, strict=True):
        for element, look in ELEMENTS.items():
            rows = tables["meshes"][tables["meshes"]["element"] == element]
            panel.loglog(rows["elements"], rows[f"error_{quantity}"], **look.keywords())
        _second_order(panel, tables["meshes"], f"error_{quantity}")
        panel.set(xlabel="elements a strip", ylabel=f"largest error of the {quantity} [1]")
        panel.set_xticks(MESHES, labels=[str(mesh) for mesh in MESHES], minor=False)
        panel.minorticks_off()
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3)
    return {"elements": figure}


def _second_order(panel: Axes, meshes: pd.DataFrame, column: str) -> None:
    """Draw the slope of second order, a little below the errors so that it can be seen."""
    first = meshes.sort_values("elements").iloc[0]
    counts = np.array([MESHES[0], MESHES[-1]])
    slope = 0.5 * first[column] * (MESHES[0] / counts) ** ORDER
    panel.loglog(counts, slope, ":", color="#444444", label="order 2")


def _limits(element: str, limit: Reference) -> pd.DataFrame:
    """Return the end values in the limit of refinement with their relative uncertainty."""
    values = {
        "com_x_m": (limit.centre[-1, 0], "trajectory"),
        "com_y_m": (limit.centre[-1, 1], "trajectory"),
        "torque_Nm": (limit.torque[-1], "torque"),
        "stiffness_Nm_per_rad": (limit.stiffness[-1], "stiffness"),
    }
    return pd.DataFrame(
        [
            {
                "element": element,
                "quantity": quantity,
                "limit": value,
                "relative_uncertainty": limit.uncertainty[kind],
            }
            for quantity, (value, kind) in values.items()
        ]
    )


def _findings(element: str, rows: pd.DataFrame) -> list[Finding]:
    """Return whether the order is 2, from the last meshes above round-off, and the error of 20."""
    name = ELEMENTS[element].label
    found = []
    for quantity in QUANTITIES:
        order = float(rows.query("elements == 160")[f"order_{quantity}"].iloc[0])
        found.append(
            Finding(
                claim=f"The {quantity} of the finite elements converges with order 2",
                formulation=name,
                quantity="the distance of the observed order (80 to 160 elements) from 2, over 2,",
                value=abs(order - ORDER) / ORDER,
                holds=abs(order - ORDER) <= ALLOWANCE,
            )
        )
        error = float(rows.query("elements == 20")[f"error_{quantity}"].iloc[0])
        found.append(
            Finding(
                claim=f"Twenty elements a strip give the {quantity} to 1 %",
                formulation=name,
                quantity="the largest error of 20 elements over the path",
                value=error,
                holds=error <= 0.01,
            )
        )
    return found
