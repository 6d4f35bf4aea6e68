"""Pivots as three-dimensional solids, how far every beam model deviates from them, and the error budget.

Strips are blocks between rigid end faces, or cut from one block with their supports. Meshes are refined in
length, thickness and width together. The benchmark pivot has 20-node and 27-node elements and two laws.
"""

from collections.abc import Iterable, Iterator, Mapping
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
from studies.engine import Answer, Claim, Part, Row, Study, Tables, percent
from studies.published import benchmark
from studies.published.solids import SINGULAR, SOFT, STIFF, VALUES, Design, compared, deviation, states_of
from studies.record.panels import ROTATION, Axis, Curves, Panel, sheet
from studies.record.style import BLACK, BLUE, GREEN, GREY, ORANGE, RED, Look

#: Beam models that are drawn: settings, effects that are added, colour and line; those for blocks.
FINE, STRONG = SplineSettings(control_points=12), FeSettings(elements=160, element="reissner")
CLAMPED, FLATTENED, SUPPORTS = "clamped_width", "anticlastic", "root_compliance"
Models = dict[str, tuple[Any, ...]]
STRIPS: Models = {
    "beam": (FINE, (), BLUE, "-"),
    "beam, lateral clamping": (FINE, (CLAMPED,), BLUE, "--"),
    "beam, anticlastic stiffening": (FINE, (FLATTENED,), ORANGE, "-."),
    "beam, both plate effects": (FINE, (CLAMPED, FLATTENED), BLUE, ":"),
    "beam with shear": (STRONG, (), GREEN, "-"),
    "beam with shear, lateral clamping": (STRONG, (CLAMPED,), GREEN, "--"),
}
BLOCKS: Models = {
    "support compliance": (FINE, (SUPPORTS,), BLACK, "-."),
    "supports and lateral clamping": (FINE, (SUPPORTS, CLAMPED), BLACK, "--"),
}
LOOKS = {name: Look(label=name, colour=each[2], line=each[3]) for name, each in (STRIPS | BLOCKS).items()}
LOOKS |= {f"solid, {SOFT}": Look(label="solid, neo-Hookean", colour=RED)}
#: Beam models that only the error budget compares.
PUBLISHED = SplineSettings(control_points=4, measure="spatial", stretch="consistent")
BUDGETED: Models = {
    "4 control points, as published": (PUBLISHED, ()),
    **{f"{n} control points": (SplineSettings(control_points=n), ()) for n in (4, 6, 8, 16)},
    "20 elements": (FeSettings(elements=20), ()),
    "inextensible": (SplineSettings(control_points=12, stretch="inextensible"), ()),
    "supports": (FINE, (SUPPORTS,)),
    "gravity": (FINE, ("gravity",)),
}
PIVOT, STEEL = "benchmark", "spring_steel_pivot"
BENCHMARK = Design(
    step=9.0,
    states=10,
    models=STRIPS | BUDGETED,
    meshes=(
        *((fineness, STIFF, "serendipity") for fineness in (5, 4, 3, 2)),
        *((fineness, STIFF, "lagrange") for fineness in (3, 2)),
        *((fineness, SOFT, "serendipity") for fineness in (4, 3, 2)),
    ),
)
OTHERS = {
    "spring steel": Design(case=STEEL, models=STRIPS),
    "spring steel, b/L = 1": Design(case=STEEL, models=STRIPS, width=0.08),
    "benchmark, one block": Design(models=STRIPS | BLOCKS, blocks=3.0, states=3, orders=(SINGULAR, 1.0)),
}
DESIGNS = {PIVOT: BENCHMARK, **OTHERS}
#: Kinds of sources of error with their colours; source -> its kind, and the two models that differ.
METHOD, MODEL, UNSURE = "error of a discretisation", "neglected effect", "uncertainty"
COLOURS = {METHOD: BLUE, MODEL: ORANGE, UNSURE: GREY}
BEAM, SOLID = "16 control points", f"solid, {STIFF}"
SOURCES: dict[str, tuple[str, str, str]] = {
    "membrane locking, n = 4 as published": (METHOD, "4 control points, as published", BEAM),
    **{f"n = {n} without locking": (METHOD, f"{n} control points", BEAM) for n in (4, 6, 8)},
    "20 elements per strip": (METHOD, "20 elements", BEAM),
    "supports cut from one block": (MODEL, "supports", BEAM),
    "plate action": (MODEL, "beam, both plate effects", BEAM),
    "shear": (MODEL, "beam with shear", BEAM),
    "stretching": (MODEL, "inextensible", BEAM),
    "gravity": (MODEL, "gravity", BEAM),
    "material law of solids": (MODEL, f"solid, {SOFT}", SOLID),
    "beams against solids": (MODEL, "beam", SOLID),
    "beams (refinement)": (UNSURE, "beam", BEAM),
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
    """Yield the states of the models that are drawn, with their deviations from the solids of each design
    and the uncertainty of these."""
    for name in tables["limits"]["design"].unique():
        models = compared(tables, name)
        solid = models[SOLID]
        for own in (models[each] for each in LOOKS if each in models):
            states = own[["design", "model", "rotation_rad", *VALUES]]
            yield states.join(deviation(own, solid)).assign(uncertainty=solid["uncertainty"])


def budget(tables: Tables) -> Iterator[Row]:
    """Yield the sources of error with their largest errors over the compared rotations."""
    models = compared(tables, PIVOT)
    for source, (kind, model, against) in SOURCES.items():
        largest = deviation(models[model], models[against]).abs().max()
        yield {"source": source, "kind": kind, "model": model, "against": against, **largest}
    solid, places = models[SOLID], models[SOLID][VALUES[1:]].to_numpy()
    place = solid["uncertainty_m"].max() / np.linalg.norm(places[-1] - places[0])
    errors = {"error_torque": solid["uncertainty"].max(), "error_trajectory": place}
    yield {"source": "solids (refinement)", "kind": UNSURE, "model": SOLID, "against": "", **errors}


def _budget_figure(tables: Tables) -> Figure:
    """Draw the largest errors of torque and trajectory as bars over decades."""
    rows = tables["budget"].sort_values("error_torque", ignore_index=True)
    panels = [partial(_bars, rows, name) for name in ("torque", "trajectory")]
    return sheet(9.5, 4.4, [panels], legend=len(COLOURS))


def _bars(rows: pd.DataFrame, name: str, panel: Axes) -> None:
    """Draw the errors of torque or trajectory as bars."""
    errors = rows[f"error_{name}"]
    low = 10.0 ** np.floor(np.log10(errors.min()) - 0.5)
    for kind, colour in COLOURS.items():
        own = errors[rows["kind"] == kind]
        bars = panel.barh(own.index, own, left=0.0, color=colour, height=0.7, label=kind)
        panel.bar_label(bars, [percent(each) for each in own], padding=2.0, fontsize=6.5)
    panel.set_yticks(rows.index, labels=rows["source"] if name == "torque" else [""] * len(rows))
    panel.set(xscale="log", xlim=(low, 200.0 * errors.max()), xlabel=f"largest error of the {name}")
    panel.grid(visible=False, axis="y")
    panel.set_axisbelow(True)


def _figure(table: str, designs: Iterable[str], tables: Tables) -> Figure:
    """Draw the deviations of torque and trajectory over the rotation, a row for each design."""
    rows = tables[table]
    curves = {name: (Curves(rows[rows["design"] == name], LOOKS, by="model"),) for name in designs}
    grid = [[Panel(ROTATION, axis, own, title=name) for axis in DEVIATIONS] for name, own in curves.items()]
    return sheet(7.5, 1.0 + 2.4 * len(grid), grid, legend=3)


def _parts(designs: Mapping[str, Design]) -> tuple[Part, ...]:
    """Return the questions for the meshes and the beam models of designs."""
    return (
        Part(at=lambda: [(name, *each) for name in designs for each in designs[name].meshes], ask=_mesh),
        Part(at=lambda: [(name, each) for name in designs for each in designs[name].models], ask=_beam),
    )


STUDY = Study(
    parts=(*_parts({PIVOT: BENCHMARK}), Part(at=lambda: benchmark.BEAMS, ask=benchmark.beams)),
    made={"limits": _limits, "deviations": _deviations, "budget": budget},
    claims=(
        Claim(
            claim="Solids have an uncertainty of at most 0.02 % in torque from 9 degrees on",
            formulation="{law} at {rotation_rad:.4f} rad",
            quantity="the uncertainty of the torque",
            rows=lambda tables: tables["limits"][tables["limits"]["rotation_rad"] > 0.15],
            value="uncertainty",
            most=2e-4,
        ),
    ),
    figures={"budget": _budget_figure, "solid_pivot": partial(_figure, "deviations", [PIVOT])},
)
OTHER_DESIGNS = Study(
    cases=(TABLE_1, STEEL),
    parts=_parts(OTHERS),
    made={"limits": _limits, "states": _deviations},
    figures={"solid_designs": partial(_figure, "states", OTHERS)},
)
"""Other pivots as three-dimensional solids: spring steel, a wide strip, and supports cut from one block."""
