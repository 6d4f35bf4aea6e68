"""The benchmark pivot as three-dimensional solids, and how far every beam model deviates from them.

Strips are blocks between rigid end faces. Meshes are refined in length, thickness and width together, with
20-node and 27-node elements, and for two material laws.
"""

from collections.abc import Iterator

import pandas as pd
from matplotlib.figure import Figure

from studies.answers.settings import FeSettings, Settings
from studies.cases.problem import named_case
from studies.engine import Answer, Claim, Part, Study, Tables
from studies.published import budget
from studies.published.solids import (
    COARSEST,
    FINE,
    ORDER,
    PLATES,
    SINGULAR,
    beam_states,
    deviation,
    limit,
    limits_of,
    meshed,
    refined,
    states_of,
    turned,
)
from studies.record.marks import Level
from studies.record.panels import ROTATION, Axis, Curves, Panel, sheet
from studies.record.style import BLACK, BLUE, GREEN, RED, Look

#: Rotations of the states [deg]; from the fourth one on beams are compared.
STATES, COMPARED = (1.0, 2.5, 5.0, *(9.0 * k for k in range(1, 11))), 3
#: Law, element and fineness of every mesh.
STIFF, SOFT = "st-venant-kirchhoff", "neo-hookean"
MESHES = (
    *((STIFF, "serendipity", fineness) for fineness in (2, 3, 4, 5)),
    *((STIFF, "lagrange", fineness) for fineness in (2, 3)),
    *((SOFT, "serendipity", fineness) for fineness in (2, 3, 4)),
)
#: Beam models: settings, effects that are added, and look.
STRONG = FeSettings(elements=160, element="reissner")
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


def _mesh(law: str, element: str, fineness: int) -> Answer:
    """Return the states of one mesh."""
    pivot, mesh = named_case(), (COARSEST[element] * fineness, fineness, fineness)
    path = turned(pivot, meshed(pivot, mesh, law=law, element=element), STATES)
    return {"meshes": states_of(path, law=law, element=element, fineness=fineness)}


def _limits(tables: Tables) -> Iterator[pd.DataFrame]:
    """Yield the limits of refinement of each law, with their uncertainty.

    The limit is that of the two finest meshes with 20 nodes, for the order `ORDER`. The orders of its
    uncertainty are `ORDER` and `SINGULAR`; the other difference is that of the elements with 27 nodes.
    """
    meshes = dict(iter(tables["meshes"].groupby(["law", "element"], sort=False)))
    serendipity, lagrange = (limit(refined(meshes[STIFF, element])) for element in COARSEST)
    for law in (STIFF, SOFT):
        yield limits_of(meshes[law, "serendipity"], (ORDER, SINGULAR), serendipity - lagrange, law=law)


def _beam(name: str) -> Answer:
    """Return the states of a beam model."""
    settings, effects, _ = MODELS[name]
    return {"models": beam_states(named_case(), settings, effects, len(STATES) - COMPARED, model=name)}


def _variant(name: str) -> Answer:
    """Return the states of a model of the budget."""
    settings, effects = budget.VARIANTS[name]
    return {"variants": beam_states(named_case(), settings, effects, len(STATES) - COMPARED, model=name)}


def _deviations(tables: Tables) -> Iterator[pd.DataFrame]:
    """Yield the deviations of the beam models and of the other material law from the solids."""
    limits = {
        law: rows.iloc[COMPARED:].reset_index() for law, rows in tables["limits"].groupby("law", sort=False)
    }
    models = dict(iter(tables["models"].groupby("model", sort=False)))
    for name, rows in (*models.items(), (f"solid, {SOFT}", limits[SOFT])):
        yield deviation(rows, limits[STIFF], model=name)


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
        Part(at=lambda: budget.VARIANTS, ask=_variant),
    ),
    made={
        "limits": lambda tables: pd.concat(_limits(tables)),
        "deviations": lambda tables: pd.concat(_deviations(tables)),
        "budget": lambda tables: budget.budget(tables, len(STATES) - COMPARED),
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
    figures={"budget": budget.draw, "solid_pivot": _figure},
)
