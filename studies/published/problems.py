"""Published problems: what others printed, our answers by model, and whether they meet it.

A published problem is added by one case file in `cases` and its name in `PROBLEMS`. Left out, as numbers
could not be had with what they belong to: NAFEMS 3DNLG-1 (load, section and modulus are in print, as are tip
deflections of 142.6 to 144.1 at a load of 4000, but the outline of the Z is in pictures alone); the bistable
beam of Ma and Chen (its thickness is not in print, and who repeats it chose one that gives the printed peak);
the four-bar coefficients of Jensen and Howell for cross-axis pivots; rates of catalogue pivots (diameters and
rates to 10 % without the strips' thickness) and the shift of the Free-Flex pivot (a chart); and the turn of
the parallelogram's stage (of the size of its mesh's error).
"""

from collections.abc import Iterator
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from studies.engine.study import Answer, Claim, Part, Study, Tables
from studies.errors import BadInput
from studies.published.case import (
    AT_LEAST,
    AT_MOST,
    BEAM,
    CLAMPED_WIDTH,
    EQUAL,
    SHEAR,
    SHEARED,
    Value,
    published,
)
from studies.published.solve import ours
from studies.record.style import BLACK, BLUE, GREY, ORANGE, page

PROBLEMS = (
    "parallelogram",
    "princeton_flatwise",
    "princeton_edgewise",
    "tip_force",
    "own_weight",
    "short_cantilever",
    "column",
    "williams_toggle",
    "williams_shallow_toggle",
    "lees_frame",
    "clamped_hinged_arch",
    "catalogue_pivot",
)
COLOURS = {"spline": BLUE, "fe": BLACK, "fe-shear": ORANGE}
MARKERS = {BEAM: "o", CLAMPED_WIDTH: "s", SHEAR: "^", SHEARED: "D"}
#: Differences below it are drawn at it [1].
FLOOR = 1e-6


def asked() -> Iterator[tuple[str, str, str]]:
    """Yield every problem with the models and the kinds of answer that are asked for.

    Of the elements, one kind has shear and the other none.
    """
    for name in PROBLEMS:
        problem = published(name)
        for model in problem.models:
            for answer in problem.answers:
                if model == "spline" or (model == "fe-shear") == (SHEAR in answer):
                    yield name, model, answer


def compared(name: str, model: str, answer: str) -> Answer:
    """Return a row a value: as it is in print, as it was found, and whether it is met."""
    problem = published(name)
    return {"values": [_row(name, model, answer, value) for value in problem.values]}


def _row(name: str, model: str, answer: str, value: Value) -> dict[str, Any]:
    problem = published(name)
    try:
        found, message = ours(name, model, answer, value), ""
    except BadInput as refusal:
        found, message = np.nan, str(refusal)
    limit = value.limits[answer]
    error = (found - value.published) / (abs(value.published) or 1.0)
    return {
        "problem": problem.title,
        "case": name,
        "model": model,
        "answer": answer,
        "quantity": value.quantity,
        "at": value.at,
        "load": value.load,
        "unit": value.unit,
        "bound": value.bound,
        "published": value.published,
        "uncertainty": value.uncertainty,
        "found": found,
        "error": error,
        "limit": limit,
        "within": "yes" if met(value, found, limit) else "no",
        "message": message,
        "source": problem.source,
    }


def met(value: Value, found: float, limit: float) -> bool:
    """Return whether a number meets a value in print: within its uncertainty and the limit."""
    slack = value.uncertainty + limit * abs(value.published)
    over = {EQUAL: abs(found - value.published), AT_MOST: found - value.published}
    over[AT_LEAST] = value.published - found
    return bool(over[value.bound] <= slack * (1.0 + 1e-12))


def figure(tables: Tables) -> Figure:
    """Draw the differences to the values in print, a line a problem, beside the limits."""
    drawn = page(7.5, 4.6)
    panel = drawn.subplots()
    rows = tables["values"]
    rows = rows[rows["bound"] == EQUAL]
    titles = list(dict.fromkeys(published(name).title for name in PROBLEMS))
    titles = [title for title in titles if title in set(rows["problem"])]
    for (model, answer), mine in rows.groupby(["model", "answer"], sort=False):
        place = [titles.index(title) for title in mine["problem"]]
        panel.plot(
            np.maximum(np.abs(mine["error"]), FLOOR), place, linestyle="", marker=MARKERS[str(answer)],
            markersize=5.0, fillstyle="none", color=COLOURS[str(model)], label=f"{model}, {answer}",
        )  # fmt: skip
    for title, mine in rows.groupby("problem"):
        slack = (mine["limit"] + mine["uncertainty"] / np.maximum(np.abs(mine["published"]), 1e-300)).max()
        if 0.0 < slack < 1.0:
            panel.plot(slack, titles.index(str(title)), "|", markersize=14.0, color=GREY)
    panel.set(xscale="log", xlabel="difference to the value in print [1]; bar: limit and uncertainty")
    panel.set_yticks(range(len(titles)), titles)
    panel.invert_yaxis()
    drawn.legend(*panel.get_legend_handles_labels(), loc="outside lower center", ncols=4)
    return drawn


STUDY = Study(
    cases=tuple(f"published/cases/{name}" for name in PROBLEMS),
    parts=(Part(at=asked, ask=compared),),
    claims=(
        Claim(
            claim="Values in print are met within their uncertainty and the limit of their case file",
            formulation="{problem}, {model}, {answer}",
            quantity="the difference of {quantity} at load {load:.3g}, {at:g}",
            rows=lambda tables: tables["values"],
            value="error",
            holds=lambda row: row["within"] == "yes",
        ),
    ),
    figures={"published_problems": figure},
)
