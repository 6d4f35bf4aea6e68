"""Slenderness L/h from 10 to 1e5 and strips that cannot stretch: errors, iterations and digits."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from studies.answers.adapters import answer_static
from studies.answers.response import Response
from studies.answers.settings import SplineSettings
from studies.cases.problem import Problem, named_case
from studies.engine.study import Part
from studies.record.style import BLACK, BLUE, GREY, ORANGE, page
from studies.stability import family, maps
from studies.stability.paths import StaticCase, outcomes_of

#: L/h of a rectangular section of Table 1's flexural rigidity.
SLENDERNESS = (10.0, 17.0, 30.0, 100.0, 300.0, 1e3, 3e3, 1e4, 3e4, 1e5)
#: Where inextensible strips stand on the map.
INEXTENSIBLE = 1e6
ROTATIONS = (10, 45, 90, 135)
#: Factor between neighbouring designs, between which no digits may be lost.
NEIGHBOUR = 1.001


def _cases() -> Iterator[StaticCase]:
    """Yield every slenderness at every rotation."""
    for degrees in ROTATIONS:
        for slenderness in SLENDERNESS:
            design = replace(_slender(slenderness), rotation=math.radians(degrees))
            name = f"L/h = {slenderness:g}, {degrees} deg"
            yield StaticCase(name=name, x=slenderness, y=degrees, design=design)
        rigid: dict[str, Any] = {
            name: _inextensible(settings)
            for name in (family.DEFAULT, family.LOCKING_FREE, family.SIX)
            if isinstance(settings := family.PATHS[name], SplineSettings)
        }
        yield StaticCase(
            name=f"inextensible, {degrees} deg",
            x=INEXTENSIBLE,
            y=degrees,
            design=replace(_slender(SLENDERNESS[-1]), rotation=math.radians(degrees)),
            settings=rigid,
            refined=_inextensible(family.REFINED),
            check=_inextensible(family.CHECK),
        )


def _slender(slenderness: float) -> Problem:
    """Return Table 1 with strips of that L/h and the same flexural rigidity: the more slender, the wider."""
    given = named_case(family.CASE)
    area = 12.0 * given.second_moment_of_area * (slenderness / given.length) ** 2
    return replace(given, area=area)


def _inextensible(settings: SplineSettings) -> SplineSettings:
    """Return the settings with strips that cannot stretch."""
    return replace(settings, stretch="inextensible")


def limit_table(settings: Any, chosen: Sequence[float] = SLENDERNESS) -> pd.DataFrame:
    """Return, slenderness by slenderness, the distance to the inextensible strip, the iterations and digits.

    With 1/EA the axial energy and all it changes go with (L/h)^-2. `constant` is the distance times (L/h)^2;
    `lost_digits` is what the torques of neighbouring designs differ by beyond that law.
    """
    rigid = answer_static(_slender(SLENDERNESS[-1]), _inextensible(settings))
    rows = []
    for slenderness in chosen:
        here = answer_static(_slender(slenderness), settings)
        beside = answer_static(_slender(slenderness * NEIGHBOUR), settings)
        gap = _gap(here, rigid)
        expected = gap * (1.0 - NEIGHBOUR**-2)
        rows.append(
            {
                "slenderness": slenderness,
                "error": gap,
                "constant": gap * slenderness**2,
                "iterations": here.counters["newton_iterations"],
                "iterations_inextensible": rigid.counters["newton_iterations"],
                "lost_digits": abs(_gap(here, beside) - expected),
            }
        )
    return pd.DataFrame(rows)


def _gap(one: Response, other: Response) -> float:
    """Return the largest difference of two torques over the largest of the second."""
    return float(np.abs(one.torque - other.torque).max() / np.abs(other.torque).max())


def _limit_figure(tables: Mapping[str, pd.DataFrame]) -> Figure:
    limit = tables["limit"]
    figure = page(7.4, 3.1)
    left, right = figure.subplots(1, 2)
    left.loglog(limit["slenderness"], limit["error"], "o-", color=BLUE, label="to the inextensible strip")
    left.loglog(
        limit["slenderness"], limit["lost_digits"], "s--", color=ORANGE, label="beyond the law, neighbours"
    )
    left.axhline(1e-9, color=GREY, linewidth=0.9, linestyle=":")
    left.set(xlabel="slenderness L/h [1]", ylabel="difference of torque [1]", title="Spline n = 6, 90°")
    left.legend(loc="upper right")
    right.semilogx(limit["slenderness"], limit["iterations"], "o-", color=BLUE, label="extensible")
    right.axhline(limit["iterations_inextensible"].iloc[0], color=BLACK, linestyle="--", label="inextensible")
    right.set(xlabel="slenderness L/h [1]", ylabel="Newton iterations of the path [1]", ylim=(0.0, 30.0))
    right.legend(loc="lower right")
    return figure


STUDY = family.study(
    Part(at=_cases, ask=outcomes_of),
    # the approach of six control points to the inextensible strip
    Part(ask=lambda: {"limit": limit_table(family.PATHS[family.SIX])}),
    figures={
        "stability_slenderness": lambda tables: maps.outcome_map(
            tables["outcomes"],
            title="Driven in 20 increments: torque and path within 5 % of the refined answer",
            xlabel="slenderness L/h [1]",
            ylabel="rotation [deg]",
            xscale="log",
            xlim=(5.0, 2.0 * INEXTENSIBLE),
            ylim=(0.0, 145.0),
            xticks=(10.0, 1e3, 1e5, INEXTENSIBLE),
            xticklabels=("10", "1e3", "1e5", "∞"),
            yticks=list(ROTATIONS),
        ),
        "stability_slenderness_limit": _limit_figure,
    },
)
