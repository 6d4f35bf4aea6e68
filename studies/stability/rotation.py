"""Rotation to a half turn and beyond, in any number of increments, there and back."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from studies.answers.adapters import answer_static
from studies.answers.models import built, model_of
from studies.answers.settings import Settings, SplineSettings
from studies.cases.problem import Problem, named_case
from studies.engine.study import Part
from studies.record.style import BLACK, BLUE, GREY, ORANGE, page
from studies.stability import family, maps
from studies.stability.paths import StaticCase, outcomes_of

ROTATIONS = (-180, -90, 90, 135, 150, 165, 180, 200, 220, 240, 260)
INCREMENTS = (1, 2, 5, 20, 200)
#: A reference at these rotations needs more points than at a quarter turn.
FAR, FAR_CHECK = SplineSettings(control_points=16), SplineSettings(control_points=14)
#: Columns whose answers to other increments are compared with one another.
COMPARED = (family.SIX, family.FE)


def _cases() -> Iterator[StaticCase]:
    """Yield every rotation in every number of increments."""
    given = named_case(family.CASE)
    for degrees in ROTATIONS:
        for count in INCREMENTS:
            design = replace(given, rotation=math.radians(degrees), increments=count)
            yield StaticCase(
                name=f"{degrees} deg in {count}",
                x=degrees,
                y=count,
                design=design,
                refined=FAR,
                check=FAR_CHECK,
            )


def increments(model: str) -> list[dict[str, Any]]:
    """Return, for every number of increments, how far the torque at 90 degrees is from that of 20, and how
    far a path there and back ends from where it was: of the torque at each rotation, and at rest."""
    settings = family.PATHS[model]
    given = named_case(family.CASE)
    torque = answer_static(given, settings).torque[-1]
    rows = []
    for count in INCREMENTS:
        path = _there_and_back(given, settings, count)
        there, back = path[: count + 1], path[count:][::-1]
        rows.append(
            {
                "model": model,
                "increments": count,
                "torque_change": abs(there[-1] / torque - 1.0),
                "hysteresis": float(np.abs(there - back).max() / abs(torque)),
            }
        )
    return rows


def _there_and_back(given: Problem, settings: Settings, count: int) -> Any:
    """Return the torque at all states of a path to the end of the case's and back to rest."""
    model = model_of(settings)
    pivot, _ = built(model, given, settings, moving=False)
    legs = [given.rotation, 0.0]
    return np.asarray(model.statics.solve_statics(pivot, rotation=legs, increments=count).torque)


def _critical() -> list[dict[str, Any]]:
    """Return the critical points on the refined spline's path to the last rotation, or one row that says
    that there are none."""
    given = replace(named_case(family.CASE), rotation=math.radians(ROTATIONS[-1]), increments=52)
    model = model_of(family.REFINED)
    pivot, _ = built(model, given, FAR, moving=False)
    path = model.statics.solve_statics(
        pivot, rotation=given.rotation, increments=given.increments, method="multipliers",
        raise_on_failure=False,
    )  # fmt: skip
    rows = [
        {"kind": point.kind, "rotation_deg": math.degrees(point.rotation), "inertia": point.inertia}
        for point in path.critical_points
    ]
    reached = math.degrees(path.rotation[-1])
    end = {"kind": f"end: {path.message or 'reached'}", "rotation_deg": reached, "inertia": path.inertia[-1]}
    return [*rows, end]


def _increments_figure(tables: Mapping[str, pd.DataFrame]) -> Figure:
    figure = page(4.6, 3.2)
    panel = figure.subplots()
    for model, colour in ((family.SIX, BLUE), (family.FE, BLACK)):
        mine = tables["increments"].query("model == @model").sort_values("increments")
        for column, line, label in (
            ("torque_change", "o-", "torque at 90°"),
            ("hysteresis", "s--", "there and back"),
        ):
            panel.loglog(
                mine["increments"], mine[column].clip(1e-17), line, color=colour, label=f"{model}: {label}"
            )
    panel.axhline(1e-8, color=ORANGE, linewidth=0.9)
    panel.axhline(1e-9, color=GREY, linewidth=0.9, linestyle=":")
    panel.set(xlabel="increments [1]", ylabel="difference of torque [1]", ylim=(1e-17, 1e-6))
    panel.legend(loc="center left", fontsize=7)
    return figure


STUDY = family.study(
    Part(at=_cases, ask=outcomes_of),
    # the same path in any number of increments, and back again
    Part(at=lambda: COMPARED, ask=lambda model: {"increments": increments(model)}),
    # the critical points that the refined spline finds on its way
    Part(ask=lambda: {"critical": _critical()}),
    figures={
        "stability_rotation": lambda tables: maps.outcome_map(
            tables["outcomes"].assign(y=np.log10(tables["outcomes"]["y"])),
            title="Table 1 driven through a rotation: torque and path within 5 % of the refined answer",
            xlabel="rotation [deg]",
            ylabel="increments [1]",
            xlim=(-200.0, 280.0),
            ylim=(-0.3, 2.6),
            xticks=[-180, -90, 0, 90, 180],
            yticks=np.log10(INCREMENTS),
            yticklabels=INCREMENTS,
        ),
        "stability_increments": _increments_figure,
    },
)
