"""The benchmark pivot as three-dimensional solids, and how far every beam model deviates from them.

Strips are blocks between rigid end faces. Meshes are refined in length, thickness and width together, with
20-node and 27-node elements, and for two material laws.
"""

import math
from collections.abc import Iterator

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from studies.answers.settings import FeSettings, Settings, SplineSettings
from studies.cases.problem import named_case
from studies.engine import Answer, Claim, Part, Row, Study, Tables, percent
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
from studies.record.style import BLACK, BLUE, GREEN, GREY, ORANGE, RED, Look, page

#: Laws of the material.
STIFF, SOFT = "st-venant-kirchhoff", "neo-hookean"

#: Models that only the budget compares: settings, and effects that are added.
VARIANTS: dict[str, tuple[Settings, tuple[str, ...]]] = {
    "4 control points, as published": (
        SplineSettings(control_points=4, measure="spatial", stretch="consistent"),
        (),
    ),
    "4 control points": (SplineSettings(control_points=4), ()),
    "6 control points": (SplineSettings(control_points=6), ()),
    "8 control points": (SplineSettings(control_points=8), ()),
    "16 control points": (SplineSettings(control_points=16), ()),
    "20 elements": (FeSettings(elements=20), ()),
    "inextensible": (SplineSettings(control_points=12, stretch="inextensible"), ()),
    "supports": (FINE, ("root_compliance",)),
    "gravity": (FINE, ("gravity",)),
}
#: Kinds of sources with their colours.
METHOD, NEGLECTED, UNSURE = "error of a discretisation", "neglected effect", "uncertainty"
COLOURS = {METHOD: BLUE, NEGLECTED: ORANGE, UNSURE: GREY}
#: Source -> its kind, and the two models whose difference it is.
BEAM, SOLID = "16 control points", f"solid, {STIFF}"
SOURCES: dict[str, tuple[str, str, str]] = {
    "membrane locking, n = 4 as published": (METHOD, "4 control points, as published", BEAM),
    "n = 4 without locking": (METHOD, "4 control points", BEAM),
    "n = 6 without locking": (METHOD, "6 control points", BEAM),
    "n = 8 without locking": (METHOD, "8 control points", BEAM),
    "20 elements per strip": (METHOD, "20 elements", BEAM),
    "supports cut from one block": (NEGLECTED, "supports", BEAM),
    "plate action": (NEGLECTED, "beam, both plate effects", BEAM),
    "shear": (NEGLECTED, "beam with shear", BEAM),
    "stretching": (NEGLECTED, "inextensible", BEAM),
    "gravity": (NEGLECTED, "gravity", BEAM),
    "material law of solids": (NEGLECTED, f"solid, {SOFT}", SOLID),
    "beams against solids": (NEGLECTED, "beam", SOLID),
    "beams (refinement)": (UNSURE, "beam", BEAM),
}


def budget(tables: Tables, states: int) -> Iterator[Row]:
    """Yield the sources with their largest errors over the last `states` rotations."""
    models = {
        str(name): rows for each in ("models", "variants") for name, rows in tables[each].groupby("model")
    }
    for law, rows in tables["limits"].groupby("law"):
        models[f"solid, {law}"] = rows.iloc[-states:]
    for source, (kind, model, against) in SOURCES.items():
        found = deviation(models[model], models[against])
        errors = {name: found[name].abs().max() for name in ("error_torque", "error_trajectory")}
        yield {"source": source, "kind": kind, "model": model, "against": against} | errors
    solid = models[SOLID]
    place = solid[["com_x_m", "com_y_m"]].to_numpy()
    errors = {
        "error_torque": solid["uncertainty"].max(),
        "error_trajectory": solid["uncertainty_m"].max() / math.hypot(*(place[-1] - place[0])),
    }
    yield {"source": "solids (refinement)", "kind": UNSURE, "model": SOLID, "against": ""} | errors


def _draw_budget(tables: Tables) -> Figure:
    """Draw the largest errors of torque and trajectory as bars over decades."""
    rows = tables["budget"].sort_values("error_torque")
    drawn = page(9.5, 4.4)
    panels = drawn.subplots(1, 2, sharey=True)
    for panel, name in zip(panels, ("torque", "trajectory"), strict=True):
        errors = rows[f"error_{name}"]
        low = 10.0 ** np.floor(np.log10(errors.min()) - 0.5)
        bars = panel.barh(rows["source"], errors, left=0.0, color=rows["kind"].map(COLOURS), height=0.7)
        panel.bar_label(bars, [percent(each) for each in errors], padding=2.0, fontsize=6.5)
        panel.set_xscale("log")
        panel.set(xlim=(low, 200.0 * errors.max()), xlabel=f"largest error of the {name}")
        panel.grid(visible=False, axis="y")
        panel.set_axisbelow(True)
    drawn.legend(
        handles=[Patch(color=colour, label=kind) for kind, colour in COLOURS.items()],
        loc="outside lower center",
        ncols=len(COLOURS),
    )
    return drawn


#: Rotations of the states [deg]; from the fourth one on beams are compared.
STATES, COMPARED = (1.0, 2.5, 5.0, *(9.0 * k for k in range(1, 11))), 3
#: Law, element and fineness of every mesh.
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
    settings, effects = VARIANTS[name]
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
        Part(at=lambda: VARIANTS, ask=_variant),
    ),
    made={
        "limits": lambda tables: pd.concat(_limits(tables)),
        "deviations": lambda tables: pd.concat(_deviations(tables)),
        "budget": lambda tables: budget(tables, len(STATES) - COMPARED),
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
    figures={"budget": _draw_budget, "solid_pivot": _figure},
)
