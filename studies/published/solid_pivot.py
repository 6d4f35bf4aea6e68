"""The benchmark pivot as three-dimensional solids, and how far every beam model deviates from them.

Strips are blocks between rigid end faces. Meshes are refined in length, thickness and width together, with
20-node and 27-node elements, and for two material laws.
"""

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from fe_reference import SolidPath, SolidStrip, solve_solids
from studies.answers.adapters import answer_static
from studies.answers.settings import FeSettings, Settings, SplineSettings
from studies.cases.problem import Problem, named_case
from studies.engine import Answer, Claim, Part, Study, Tables
from studies.kinds import Array
from studies.record.marks import Level
from studies.record.panels import ROTATION, Axis, Curves, Panel, sheet
from studies.record.style import BLACK, BLUE, GREEN, RED, Look

#: Rotations of the states [deg]; from the fourth one on beams are compared.
STATES, COMPARED = (1.0, 2.5, 5.0, *(9.0 * k for k in range(1, 11))), 3
#: Elements along the length of the mesh with fineness 1, which has one over thickness and half width. With
#: 27 nodes and full integration a thin strip needs more of them.
COARSEST = {"serendipity": 8, "lagrange": 16}
#: Law, element and fineness of every mesh.
STIFF, SOFT = "st-venant-kirchhoff", "neo-hookean"
MESHES = (
    *((STIFF, "serendipity", fineness) for fineness in (2, 3, 4, 5)),
    *((STIFF, "lagrange", fineness) for fineness in (2, 3)),
    *((SOFT, "serendipity", fineness) for fineness in (2, 3, 4)),
)
#: What the limits are of.
VALUES = ["torque_Nm", "com_x_m", "com_y_m"]
#: Observed order of the error in the size of the elements, and that of the singularities at the clamps.
ORDER, SINGULAR = 2.0, 1.5
#: Beam models: settings, effects that are added, and look.
FINE, STRONG = SplineSettings(control_points=12), FeSettings(elements=160, element="reissner")
PLATES = ("clamped_width", "anticlastic")
MODELS: dict[str, tuple[Settings, tuple[str, ...], Look]] = {
    "beam": (FINE, (), Look(label="beam", colour=BLUE)),
    "beam, lateral clamping": (FINE, PLATES[:1], Look(label="lateral clamping", colour=BLUE, line="--")),
    "beam, both plate effects": (FINE, PLATES, Look(label="both plate effects", colour=BLUE, line=":")),
    "beam with shear": (STRONG, (), Look(label="shear", colour=GREEN)),
    "beam with shear, lateral clamping": (
        STRONG,
        PLATES[:1],
        Look(label="shear and lateral clamping", colour=GREEN, line="--"),
    ),
}
LOOKS = {name: look for name, (_, _, look) in MODELS.items()}
LOOKS |= {f"solid, {SOFT}": Look(label="solid, neo-Hookean", colour=RED)}
#: Deviation of the torque that the studies take for small, and largest uncertainty that a solid may have.
SMALL, SURE = 0.01, 2e-4


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
    """Return the path of a pivot on its strips as solids."""
    ends = [(each.start, each.end) for each in pivot.strips]
    return solve_solids(strip, ends, np.radians(degrees).tolist(), centre=pivot.bodies[0].centre)


def _mesh(law: str, element: str, fineness: int) -> Answer:
    """Return the states of one mesh."""
    pivot, mesh = named_case(), (COARSEST[element] * fineness, fineness, fineness)
    path = turned(pivot, meshed(pivot, mesh, law=law, element=element), STATES)
    return {"meshes": states_of(path, law=law, element=element, fineness=fineness)}


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


def _limits(tables: Tables) -> Iterator[pd.DataFrame]:
    """Yield the limits of refinement of each law, with their uncertainty.

    The limit is that of the two finest meshes with 20 nodes, for the order `ORDER`. The orders of its
    uncertainty are `ORDER` and `SINGULAR`; the other difference is that of the elements with 27 nodes.
    """
    meshes = dict(iter(tables["meshes"].groupby(["law", "element"], sort=False)))
    serendipity, lagrange = (limit(refined(meshes[STIFF, element])) for element in COARSEST)
    for law in (STIFF, SOFT):
        yield limits_of(meshes[law, "serendipity"], (ORDER, SINGULAR), serendipity - lagrange, law=law)


def limits_of(
    rows: pd.DataFrame, orders: tuple[float, float], other: Any = 0.0, **labels: Any
) -> pd.DataFrame:
    """Return the limits of the states of meshes for the first order, behind labels, with their uncertainty.

    The uncertainty is the largest of three: the change of the limit without the finest mesh, its change with
    the second order, and another difference.
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
    """Return fineness, and torque and place of the states (S, 3), of the meshes from the coarsest on."""
    ordered = rows.sort_values("rotation_rad").groupby("fineness")
    return [(float(str(fineness)), mesh[VALUES].to_numpy()) for fineness, mesh in ordered]


def limit(meshes: list[tuple[float, Array]], order: float = ORDER) -> Array:
    """Return what the two finest meshes tend to for an order of the error (S, 3)."""
    (coarse, before), (fine, after) = meshes[-2:]
    found: Array = after + (after - before) / ((fine / coarse) ** order - 1.0)
    return found


def _beam(name: str) -> Answer:
    """Return the states of a beam model."""
    settings, effects, _ = MODELS[name]
    return {"models": beam_states(named_case(), settings, effects, len(STATES) - COMPARED, model=name)}


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


def _deviations(tables: Tables) -> Iterator[pd.DataFrame]:
    """Yield the deviations of the beam models and of the other material law from the solids."""
    limits = {
        law: rows.iloc[COMPARED:].reset_index() for law, rows in tables["limits"].groupby("law", sort=False)
    }
    models = dict(iter(tables["models"].groupby("model", sort=False)))
    for name, rows in (*models.items(), (f"solid, {SOFT}", limits[SOFT])):
        yield deviation(rows, limits[STIFF], model=name)


def deviation(own: pd.DataFrame, solid: pd.DataFrame, **labels: Any) -> pd.DataFrame:
    """Return the deviations of states from those of solids at the same rotations, behind labels."""
    place, true = (each[["com_x_m", "com_y_m"]].to_numpy() for each in (own, solid))
    values = {
        "rotation_rad": solid["rotation_rad"].to_numpy(),
        "error_torque": own["torque_Nm"].to_numpy() / solid["torque_Nm"].to_numpy() - 1.0,
        "error_trajectory": np.hypot(*(place - true).T) / math.hypot(*(true[-1] - true[0])),
        "uncertainty": solid["uncertainty"].to_numpy(),
    }
    return pd.DataFrame(labels | values)


def _figure(tables: Tables) -> Figure:
    """Draw the deviations of torque and trajectory over the rotation."""
    rows = tables["deviations"].assign(percent=lambda table: 100.0 * table["error_torque"])
    curves = Curves(rows, LOOKS, by="model")
    exact = Level(0.0, colour=BLACK)
    torque = Panel(ROTATION, Axis("percent", "deviation of the torque [%]"), (curves, exact))
    trajectory = Axis("error_trajectory", "deviation of the trajectory [1]", log=True)
    return sheet(7.5, 3.4, [[torque, Panel(ROTATION, trajectory, (curves,))]], legend=3)


STUDY = Study(
    parts=(
        Part(at=lambda: reversed(MESHES), ask=_mesh),
        Part(at=lambda: MODELS, ask=_beam),
    ),
    made={
        "limits": lambda tables: pd.concat(_limits(tables)),
        "deviations": lambda tables: pd.concat(_deviations(tables)),
    },
    claims=(
        Claim(
            claim="Solids have an uncertainty of at most 0.02 % in torque from 9 degrees on",
            formulation="{law} at {rotation_rad:.4f} rad",
            quantity="the uncertainty of the torque",
            rows=lambda tables: tables["limits"][tables["limits"]["rotation_rad"] > 0.15],
            value="uncertainty",
            most=SURE,
        ),
        Claim(
            claim="Beam models agree with solids within 1 % in torque",
            formulation="{model} at {rotation_rad:.4f} rad",
            quantity="the deviation of the torque",
            rows=lambda tables: tables["deviations"],
            value="error_torque",
            least=-SMALL,
            most=SMALL,
        ),
    ),
    figures={"solid_pivot": _figure},
)
