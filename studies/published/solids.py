"""Pivots as solids and as beams: states, limits of refinement, and deviations of one from the other."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import pandas as pd

from fe_reference import SolidPath, SolidStrip, solve_solids
from studies.answers.metrics import relative_error, richardson, trajectory_error
from studies.cases.problem import TABLE_1, Problem, named_case
from studies.engine import Tables
from studies.kinds import Array

STIFF, SOFT = "st-venant-kirchhoff", "neo-hookean"
#: The pivot of the paper among the designs.
PIVOT = "benchmark"
#: First rotations [deg], which Newton's method needs. Models are compared beyond them [rad].
FIRST, COMPARED = (1.0, 2.5, 5.0), math.radians(6.0)
#: What the limits are of, and what a mesh has of a pivot.
VALUES = ["torque_Nm", "com_x_m", "com_y_m"]
SHARED = ("length", "width", "thickness", "youngs_modulus", "poisson_ratio")


@dataclass(frozen=True, kw_only=True)
class Design:
    """A pivot as solids.

    Attributes:
        case: name of the case. changes: of its values, by their names.
        blocks: sides of the blocks of the supports over the thickness; 0 for rigid end faces.
        step: between the rotations that are compared [deg]. states: their number.
        models: of beams, by name; settings and effects that are added come first.
        meshes: fineness, law and element of every mesh.
        orders: of the error in the size of the elements: as observed, which gives the limit, and that of the
            singularities, which gives its uncertainty. At the corners between strip and block the stress is
            more singular than at a rigid face.
    """

    case: str = TABLE_1
    changes: Mapping[str, Any] = field(default_factory=dict)
    blocks: float = 0.0
    step: float = 10.0
    states: int = 6
    models: Mapping[str, tuple[Any, ...]] = field(default_factory=dict)
    meshes: tuple[tuple[int, str, str], ...] = tuple((n, STIFF, "serendipity") for n in (4, 3, 2))
    orders: tuple[float, float] = (2.0, 1.5)

    @property
    def pivot(self) -> Problem:
        """The pivot with the compared rotations."""
        turned = {"rotation": np.radians(self.step * self.states), "increments": self.states}
        return replace(named_case(self.case), **turned, **self.changes)

    def strip(self, fineness: int, law: str = STIFF, element: str = "serendipity") -> SolidStrip:
        """Return the strips as solids."""
        given: dict[str, Any] = {name: getattr(self.pivot, name) for name in SHARED}
        support = self.blocks * given["thickness"]
        return SolidStrip(**given, law=law, element=element, fineness=fineness, support=support)

    def solids(self, strip: SolidStrip) -> SolidPath:
        """Return the path of the pivot on strips as solids."""
        degrees = (*FIRST, *(self.step * k for k in range(1, self.states + 1)))
        ends = [(each.start, each.end) for each in self.pivot.strips]
        return solve_solids(strip, ends, np.radians(degrees).tolist(), centre=self.pivot.bodies[0].centre)

    def limits(self, meshes: pd.DataFrame) -> Iterator[pd.DataFrame]:
        """Yield the limits of the states of meshes for each law, with their uncertainty.

        The limit is that of the two finest meshes with 20 nodes. The uncertainty is the largest of three: the
        change of the limit without the finest mesh, its change with the other order, and its difference to
        the limit of meshes with 27 nodes, where there are any.
        """
        first, second = self.orders
        elements = meshes[meshes["law"] == STIFF].groupby("element")
        apart = np.ptp([limit(rows, first) for _, rows in elements], axis=0)
        for law, rows in meshes[meshes["element"] == "serendipity"].groupby("law"):
            found = limit(rows, first)
            others = limit(rows, first, finest=False), limit(rows, second)
            unsure = np.max([apart, *np.abs(found - np.array(others))], axis=0)
            values = dict(zip(VALUES, found.T, strict=True)) | {
                "uncertainty": unsure[:, 0] / np.abs(found[:, 0]),
                "uncertainty_m": np.hypot(unsure[:, 1], unsure[:, 2]),
            }
            yield pd.DataFrame({"law": law, "rotation_rad": np.sort(rows["rotation_rad"].unique())} | values)


def states_of(path: Any, **labels: Any) -> pd.DataFrame:
    """Return the states of a path of solids or beams behind labels."""
    values = dict(zip(VALUES, (path.torque, *path.centre.T), strict=True))
    return pd.DataFrame(labels | {"rotation_rad": path.rotation} | values)


def limit(rows: pd.DataFrame, order: float, *, finest: bool = True) -> Array:
    """Return the limits (S, 3) [N m, m, m] of the two finest meshes, or of the two before the finest.

    rows: one per mesh and state; order: of convergence.
    """
    meshes = list(rows.sort_values("rotation_rad").groupby("fineness"))
    (coarse, before), (fine, after) = meshes[-2:] if finest else meshes[-3:-1]
    ratio = float(str(fine)) / float(str(coarse))
    return richardson(before[VALUES].to_numpy(), after[VALUES].to_numpy(), order=order, ratio=ratio)


def compared(tables: Tables, design: str) -> dict[str, pd.DataFrame]:
    """Return the states of a design, of its beam models and of the limits of solids, by model."""
    solids = tables["limits"].assign(model="solid, " + tables["limits"]["law"])
    rows = pd.concat([tables["models"], solids])
    chosen = rows[(rows["design"] == design) & (rows["rotation_rad"] > COMPARED)]
    return {str(name): own.reset_index(drop=True) for name, own in chosen.groupby("model")}


def deviation(own: pd.DataFrame, solid: pd.DataFrame) -> pd.DataFrame:
    """Return the deviations of states from those of solids, or of other beams."""
    (torque, *place), (expected, *places) = (each[VALUES].to_numpy().T for each in (own, solid))
    trajectory = trajectory_error(np.transpose(place), np.transpose(places))
    return pd.DataFrame({"error_torque": relative_error(torque, expected), "error_trajectory": trajectory})
