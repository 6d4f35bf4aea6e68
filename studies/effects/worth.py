"""What each effect is worth for four designs."""

import textwrap
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from studies.answers.settings import SplineSettings
from studies.cases.problem import Problem, named_case
from studies.cases.section import of_moments
from studies.effects.audit import audit
from studies.effects.scenes import CHANGES, SIZES
from studies.engine import Answer, Claim, Part, Study, Tables, records
from studies.record.marks import Level, Words
from studies.record.panels import Axis, Curves, Mark, Panel, sheet
from studies.record.style import BLACK, BLUE, GREEN, ORANGE, RED, Look

SETTINGS = SplineSettings(control_points=6)
TOLERANCE = 1e-3

WORTH = ("design", "scene", "dropped", "status", *CHANGES, "largest", *SIZES, "reason")
#: Looks of the changes.
SHOWN = {
    "trajectory": Look(label="path", colour=BLACK, line="", marker="o", hollow=True),
    "torque": Look(label="torque", colour=ORANGE, line="", marker="s", hollow=True),
    "swing_frequency": Look(label="frequency of the swing", colour=BLUE, line="", marker="D", hollow=True),
    "first_mode": Look(label="first mode at rest", colour=GREEN, line="", marker="x"),
}
#: Changes below the first of these are drawn on the edge; the last is the other edge.
LEAST, MOST = 1e-7, 30.0
CHANGE = Axis("change", "|change| [1]", log=True, least=LEAST, limits=(LEAST, MOST), ticks=(1e-6, 1e-3, 1.0))


def _designs() -> dict[str, Problem]:
    """Return the four designs: Table 1, ten times more slender, with a heavy and with a light body."""
    given = named_case()
    slender = of_moments(given.area / 10.0, given.second_moment_of_area / 1000.0)
    found = {"Table 1": given, "ten times more slender": replace(given, **slender)}
    for name, factor in (("heavier", 10.0), ("lighter", 0.1)):
        body: Any = {each: factor * getattr(given, each) for each in ("body_mass", "body_moment_of_inertia")}
        found[f"body ten times {name}"] = replace(given, **body)
    return found


def _audited(name: str) -> Answer:
    """Return the worth of a design's effects (a row a scene: changes, size, or why there is no answer), the
    times (of the full scene over the scene's) and the cheapest scene."""
    found = audit(_designs()[name], SETTINGS, TOLERANCE)
    full, *rows = ({"design": name, **found.row(each)} for each in (found.full, *found.rows))
    best = found.row(found.cheapest) | {"design": name, "tolerance": found.tolerance}
    timed = best | {"scene": "cheapest", "time_ratio": found.ratio, "wall_s": found.seconds[1]}
    best["effects"] = " ".join(best["effects"])
    return {
        "worth": pd.DataFrame([row | {"dropped": row["dropped"][0]} for row in rows])[list(WORTH)],
        "timings": pd.DataFrame([full, *rows, timed])[["design", "scene", "time_ratio", "wall_s"]],
        "cheapest": pd.DataFrame([best])[["design", "tolerance", "scene", "effects", "largest"]],
    }


def _worth(tables: Tables) -> Figure:
    """Draw the changes by every effect, one panel a design."""
    rows = tables["worth"].query("status != 'refused'")
    largest = rows.set_index("scene")[list(SHOWN)].abs().groupby("scene").max().max(axis=1)
    order = list(largest.sort_values(ascending=False).index)
    times = tables["timings"].set_index(["design", "scene"])["time_ratio"]
    panels = []
    for design in _designs():
        mine = rows[rows["design"] == design]
        changes = mine.melt(id_vars="scene", value_vars=list(SHOWN), var_name="what", value_name="change")
        curves = Curves(changes, SHOWN, by="what", more={"markersize": 5.5, "clip_on": False})
        words = _times(mine, times[design], order)
        marks: list[Mark] = [curves, Level(TOLERANCE, colour=RED, upright=True), *words]
        y = Axis("scene", "", names=order)
        panels.append(Panel(CHANGE, y, marks, title=textwrap.fill(design, 16)))
    title = f"Change by leaving out one effect of the full scene; line: {TOLERANCE:g}; left edge: no more"
    return sheet(9.5, 3.9, [panels], title=title, legend=len(SHOWN))


def _times(rows: pd.DataFrame, ratios: pd.Series, order: Sequence[str]) -> Iterator[Words]:
    """Yield how many times faster every scene is, or what there is of it without a motion."""
    for row in records(rows):
        ratio = float(ratios[row["scene"]])
        alone = "motion stops" if row["status"] == "not_converged" else "no motion"
        text = f"time x {1.0 / ratio:.2g}" if np.isfinite(ratio) else alone
        place = (MOST, order.index(row["scene"]))
        yield Words(text, place, by=(-2, 7), colour="#666666", side="right")


STUDY = Study(
    parts=(Part(at=_designs, ask=_audited, alone=True),),
    claims=(
        Claim(
            claim=f"The answer is within {TOLERANCE:g} without it",
            formulation="{design}, {scene}",
            quantity="the largest change of path, torque, frequencies and loss",
            rows=lambda tables: tables["worth"].query("status == 'converged'"),
            value="largest",
            most=TOLERANCE,
        ),
    ),
    varying=("cheapest",),
    figures={"effects_worth": _worth},
)
