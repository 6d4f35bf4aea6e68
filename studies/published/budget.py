"""The error budget of the benchmark pivot: every source of error on one scale, for torque and trajectory."""

import math
from collections.abc import Iterator

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from studies.answers.settings import FeSettings, Settings, SplineSettings
from studies.engine import Row, Tables, percent
from studies.published.solids import FINE, deviation
from studies.record.style import BLUE, GREY, ORANGE, page

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
METHOD, MODEL, UNSURE = "error of a discretisation", "neglected effect", "uncertainty"
COLOURS = {METHOD: BLUE, MODEL: ORANGE, UNSURE: GREY}
#: Source -> its kind, and the two models whose difference it is.
BEAM, SOLID, SOFT = "16 control points", "solid, st-venant-kirchhoff", "solid, neo-hookean"
SOURCES: dict[str, tuple[str, str, str]] = {
    "membrane locking, n = 4 as published": (METHOD, "4 control points, as published", BEAM),
    "n = 4 without locking": (METHOD, "4 control points", BEAM),
    "n = 6 without locking": (METHOD, "6 control points", BEAM),
    "n = 8 without locking": (METHOD, "8 control points", BEAM),
    "20 elements per strip": (METHOD, "20 elements", BEAM),
    "supports cut from one block": (MODEL, "supports", BEAM),
    "plate action": (MODEL, "beam, both plate effects", BEAM),
    "shear": (MODEL, "beam with shear", BEAM),
    "stretching": (MODEL, "inextensible", BEAM),
    "gravity": (MODEL, "gravity", BEAM),
    "material law of solids": (MODEL, SOFT, SOLID),
    "beams against solids": (MODEL, "beam", SOLID),
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


def draw(tables: Tables) -> Figure:
    """Return the figure of the largest errors of torque and trajectory as bars over decades."""
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
