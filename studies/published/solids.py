"""Pivots as solids and as beams: states, limits of refinement, and deviations of one from the other."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd

from fe_reference import SolidPath, SolidStrip, solve_solids
from studies.answers.adapters import answer_static
from studies.answers.settings import Settings, SplineSettings
from studies.cases.problem import Problem
from studies.kinds import Array

#: Elements along the length of the mesh with fineness 1, which has one over thickness and half width. With
#: 27 nodes and full integration a thin strip needs more of them.
COARSEST = {"serendipity": 8, "lagrange": 16}
#: Observed order of the error in the size of the elements, and that of the singularities at the clamps.
ORDER, SINGULAR = 2.0, 1.5
#: A fine spline, and the effects that stand for the width of the strips.
FINE, PLATES = SplineSettings(control_points=12), ("clamped_width", "anticlastic")
#: What the limits are of.
VALUES = ["torque_Nm", "com_x_m", "com_y_m"]


def meshed(pivot: Problem, mesh: tuple[int, int, int], **how: Any) -> SolidStrip:
    """Return the strips of a pivot as solids; `how` has law and element."""
    return SolidStrip(
        length=pivot.length,
        width=float(pivot.width or 0.0),
        thickness=float(pivot.thickness or 0.0),
        youngs_modulus=pivot.youngs_modulus,
        poisson_ratio=pivot.poisson_ratio,
        mesh=mesh,
        **how,
    )


def turned(pivot: Problem, strip: SolidStrip, degrees: Sequence[float]) -> SolidPath:
    """Return the path of a pivot on strips of solid elements, through the rotations `degrees` (S,) [deg]."""
    ends = [(each.start, each.end) for each in pivot.strips]
    return solve_solids(strip, ends, np.radians(degrees).tolist(), centre=pivot.bodies[0].centre)


def states_of(path: SolidPath, **labels: Any) -> pd.DataFrame:
    """Return the states of a path of solids behind labels."""
    values = {
        "unknowns": path.unknowns,
        "rotation_rad": path.rotation,
        "torque_Nm": path.torque,
        "com_x_m": path.centre[:, 0],
        "com_y_m": path.centre[:, 1],
        "strain": path.largest_strain,
    }
    return pd.DataFrame(labels | values)


def limits_of(
    rows: pd.DataFrame, orders: tuple[float, float], other: Any = 0.0, **labels: Any
) -> pd.DataFrame:
    """Return the limits of the states of meshes for the first order, behind labels, with their uncertainty.

    The uncertainty, in the unit of the limit, is the largest of three numbers: the change of the limit
    without the finest mesh, its change with the second order, and the difference `other`.
    """
    meshes = refined(rows)
    found = limit(meshes, orders[0])
    others = found - limit(meshes[:-1], orders[0]), found - limit(meshes, orders[1]), other + 0.0 * found
    unsure = np.abs(others).max(axis=0)
    values = dict(zip(VALUES, found.T, strict=True)) | {
        "uncertainty": unsure[:, 0] / np.abs(found[:, 0]),
        "uncertainty_m": np.hypot(unsure[:, 1], unsure[:, 2]),
    }
    return pd.DataFrame(labels | {"rotation_rad": np.sort(rows["rotation_rad"].unique())} | values)


def refined(rows: pd.DataFrame) -> list[tuple[float, Array]]:
    """Return fineness [1], and torque [N m] and place [m] of the states (S, 3), of the meshes, the coarsest
    first."""
    ordered = rows.sort_values("rotation_rad").groupby("fineness")
    return [(float(str(fineness)), mesh[VALUES].to_numpy()) for fineness, mesh in ordered]


def limit(meshes: list[tuple[float, Array]], order: float = ORDER) -> Array:
    """Return the limit (S, 3) [N m, m] of the two finest meshes for an order of the error [1]."""
    (coarse, before), (fine, after) = meshes[-2:]
    found: Array = after + (after - before) / ((fine / coarse) ** order - 1.0)
    return found


def beam_states(
    case: Problem, settings: Settings, effects: Iterable[str], count: int, **labels: Any
) -> pd.DataFrame:
    """Return states at equal rotations, but for that at rest, of a beam model behind labels."""
    answer = answer_static(replace(case, effects=case.effects.plus(*effects)), settings).whole()
    chosen = slice(case.increments // count, None, case.increments // count)
    values = {
        "rotation_rad": answer.rotation[chosen],
        "torque_Nm": answer.torque[chosen],
        "com_x_m": answer.centre[chosen, 0],
        "com_y_m": answer.centre[chosen, 1],
    }
    return pd.DataFrame(labels | values)


def deviation(own: pd.DataFrame, solid: pd.DataFrame, **labels: Any) -> pd.DataFrame:
    """Return the deviations of states from those of solids, or of other beams, behind labels."""
    place, true = (each[["com_x_m", "com_y_m"]].to_numpy() for each in (own, solid))
    values = {
        "rotation_rad": solid["rotation_rad"].to_numpy(),
        "error_torque": own["torque_Nm"].to_numpy() / solid["torque_Nm"].to_numpy() - 1.0,
        "error_trajectory": np.hypot(*(place - true).T) / math.hypot(*(true[-1] - true[0])),
        "uncertainty": solid.get("uncertainty", pd.Series(np.nan, solid.index)).to_numpy(),
    }
    return pd.DataFrame(labels | values)
