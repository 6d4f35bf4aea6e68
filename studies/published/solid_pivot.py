"""Pivots as three-dimensional solids, how far every beam model deviates from them, and the error budget.

Strips are blocks between rigid end faces, or cut from one block with their supports: the benchmark pivot, a
pivot of spring steel, and one with strips as wide as long. Meshes are refined in length, thickness and width
together. The benchmark pivot has 20-node and 27-node elements and two laws.
"""

from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from studies.answers.adapters import answer_static
from studies.answers.settings import FeSettings, SplineSettings
from studies.cases.problem import TABLE_1
from studies.engine import Answer, Part, Row, Study, Tables, percent
from studies.published import benchmark
from studies.published.solids import PIVOT, SOFT, STIFF, VALUES, Design, compared, deviation, states_of
from studies.record.panels import ROTATION, Axis, Curves, Panel, sheet
from studies.record.style import BLUE, GREEN, GREY, ORANGE, RED, Look

#: Beam models that are drawn: settings, effects that are added, colour and line; and those of blocks.
FINE, STRONG = SplineSettings(control_points=12), FeSettings(elements=160, element="reissner")
CLAMPED, FLATTENED, SUPPORTS = "clamped_width", "anticlastic", "root_compliance"
BEAM, SOLID, OTHER_LAW = "beam", f"solid, {STIFF}", f"solid, {SOFT}"
Models = dict[str, tuple[Any, ...]]
STRIPS: Models = {
    BEAM: (FINE, (), BLUE, "-"),
    "beam, lateral clamping": (FINE, (CLAMPED,), BLUE, "--"),
    "beam, anticlastic stiffening": (FINE, (FLATTENED,), ORANGE, "-."),
    "beam, both plate effects": (FINE, (CLAMPED, FLATTENED), BLUE, ":"),
    "beam with shear": (STRONG, (), GREEN, "-"),
    "beam with shear, lateral clamping": (STRONG, (CLAMPED,), GREEN, "--"),
}
BLOCKS: Models = {
    "support compliance": (FINE, (SUPPORTS,)),
    "supports and lateral clamping": (FINE, (SUPPORTS, CLAMPED)),
}
LOOKS = {name: Look(label=name, colour=each[2], line=each[3]) for name, each in STRIPS.items()}
LOOKS |= {OTHER_LAW: Look(label="solid, neo-Hookean", colour=RED)}
#: Kinds of sources of error with their colours. Source -> the beam model whose difference from the refined
#: beam is its error: settings, effects that are added, kind.
METHOD, MODEL, UNSURE = "error of a discretisation", "neglected effect", "uncertainty"
COLOURS = {METHOD: BLUE, MODEL: ORANGE, UNSURE: GREY}
PUBLISHED = SplineSettings(control_points=4, measure="spatial", stretch="consistent")
SOURCES: Models = {
    "membrane locking, n = 4 as published": (PUBLISHED, (), METHOD),
    **{f"n = {n} without locking": (SplineSettings(control_points=n), (), METHOD) for n in (4, 6, 8)},
    "20 elements per strip": (FeSettings(elements=20), (), METHOD),
    "supports cut from one block": (FINE, (SUPPORTS,), MODEL),
    "plate action": (FINE, (CLAMPED, FLATTENED), MODEL),
    "shear": (STRONG, (), MODEL),
    "stretching": (SplineSettings(control_points=12, stretch="inextensible"), (), MODEL),
    "gravity": (FINE, ("gravity",), MODEL),
    "beams (refinement)": (SplineSettings(control_points=16), (), UNSURE),
}
STEEL, WIDE, THIN = "spring_steel_pivot", 0.08, 1e-3
DESIGNS = {
    PIVOT: Design(
        step=9.0,
        states=10,
        models=STRIPS | SOURCES,
        meshes=(
            *((fineness, STIFF, "serendipity") for fineness in (5, 4, 3, 2)),
            *((fineness, STIFF, "lagrange") for fineness in (3, 2)),
            *((fineness, SOFT, "serendipity") for fineness in (4, 3, 2)),
        ),
    ),
    "spring steel": Design(case=STEEL, models=STRIPS),
    "spring steel, b/L = 1": Design(case=STEEL, models=STRIPS, changes={"width": WIDE, "thickness": THIN}),
    "benchmark, one block": Design(models=STRIPS | BLOCKS, blocks=3.0, states=3, orders=(1.5, 1.0)),
}
DEVIATIONS = (
    Axis("error_torque", "deviation of the torque [%]", factor=100.0),
    Axis("error_trajectory", "deviation of the trajectory [1]", log=True),
)


def _mesh(name: str, fineness: int, law: str, element: str) -> Answer:
    """Return the states of one mesh."""
    strip = DESIGNS[name].strip(fineness, law, element)
    path = DESIGNS[name].solids(strip)
    labels = {"design": name, "law": law, "element": element, "fineness": fineness}
    return {"meshes": states_of(path, **labels, unknowns=len(strip.free), strain=path.largest_strain)}


def _beam(name: str, model: str) -> Answer:
    """Return the states of a beam model, but for that at rest."""
    pivot, (settings, effects, *_) = DESIGNS[name].pivot, DESIGNS[name].models[model]
    plus = replace(pivot, effects=pivot.effects.plus(*effects))
    states = states_of(answer_static(plus, settings).whole(), design=name, model=model)
    return {"models": states.iloc[1:]}


def _limits(tables: Tables) -> Iterator[pd.DataFrame]:
    """Yield the limits of refinement of each design and law, with their uncertainty."""
    for name, rows in tables["meshes"].groupby("design"):
        yield from (each.assign(design=name) for each in DESIGNS[str(name)].limits(rows))


def _deviations(tables: Tables) -> Iterator[pd.DataFrame]:
    """Yield the states of the models of strips and blocks, with their deviations from the solids of each
    design and the uncertainty of these."""
    for name in DESIGNS:
        models = compared(tables, name)
        solid = models[SOLID]
        for own in (models[each] for each in (*LOOKS, *BLOCKS) if each in models):
            states = own[["design", "model", "rotation_rad", *VALUES]]
            yield states.join(deviation(own, solid)).assign(uncertainty=solid["uncertainty"])


def budget(tables: Tables) -> Iterator[Row]:
    """Yield the sources of error with their largest errors over the compared rotations."""
    models = compared(tables, PIVOT)
    pairs = {source: (kind, source, BEAM) for source, (_, _, kind) in SOURCES.items()} | {
        "material law of solids": (MODEL, OTHER_LAW, SOLID),
        "beams against solids": (MODEL, BEAM, SOLID),
    }
    for source, (kind, model, against) in pairs.items():
        largest = deviation(models[model], models[against]).abs().max()
        yield {"source": source, "kind": kind, "against": against, **largest}
    solid, places = models[SOLID], models[SOLID][VALUES[1:]].to_numpy()
    place = solid["uncertainty_m"].max() / np.linalg.norm(places[-1] - places[0])
    errors = {"error_torque": solid["uncertainty"].max(), "error_trajectory": place}
    yield {"source": "solids (refinement)", "kind": UNSURE, "against": "", **errors}


def _budget_figure(tables: Tables) -> Figure:
    """Draw the largest errors of torque and trajectory as bars over decades."""
    rows = tables["budget"].sort_values("error_torque")
    panels = [partial(_bars, rows, name) for name in ("torque", "trajectory")]
    return sheet(9.5, 4.4, [panels], legend=len(COLOURS))


def _bars(rows: pd.DataFrame, name: str, panel: Axes) -> None:
    """Draw the errors of torque or trajectory as bars."""
    errors, colours = rows[f"error_{name}"], rows["kind"].map(COLOURS)
    bars = panel.barh(rows["source"], errors, left=0.0, color=colours, height=0.7, label=list(rows["kind"]))
    panel.bar_label(bars, list(map(percent, errors)), padding=2.0, fontsize=6.5)
    limits = 0.2 * errors.min(), 200.0 * errors.max()
    panel.set(xscale="log", xlim=limits, xlabel=f"largest error of the {name}")
    panel.grid(visible=False, axis="y")
    panel.tick_params(labelleft=name == "torque")
    panel.set_axisbelow(True)


def _figure(tables: Tables) -> Figure:
    """Draw the deviations of torque and trajectory of the benchmark pivot over the rotation."""
    curves = (Curves(tables["deviations"].query("design == @PIVOT"), LOOKS, by="model"),)
    return sheet(7.5, 3.4, [[Panel(ROTATION, axis, curves, title=PIVOT) for axis in DEVIATIONS]], legend=3)


STUDY = Study(
    cases=(TABLE_1, STEEL),
    parts=(
        Part(at=lambda: [(name, *each) for name, own in DESIGNS.items() for each in own.meshes], ask=_mesh),
        Part(at=lambda: [(name, each) for name, own in DESIGNS.items() for each in own.models], ask=_beam),
        Part(at=lambda: benchmark.BEAMS, ask=benchmark.beams),
    ),
    made={"limits": _limits, "deviations": _deviations, "budget": budget},
    figures={"budget": _budget_figure, "solid_pivot": _figure},
)
