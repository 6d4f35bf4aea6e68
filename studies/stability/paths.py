"""Static paths of Table 1 at the ends of its range: far rotations, and slender and inextensible strips."""

import math
from collections.abc import Iterator
from dataclasses import replace
from itertools import product
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from studies.answers.adapters import answer_static
from studies.answers.response import Response
from studies.answers.settings import SplineSettings
from studies.cases.problem import Problem, named_case
from studies.cases.section import of_moments
from studies.engine import Part, Tables
from studies.record.digits import Digits
from studies.record.panels import Axis, Curves, Panel, sheet
from studies.record.style import GREEN, GREY, RED, YELLOW, Look
from studies.stability import family

ROTATIONS = (-180, -90, 90, 135, 150, 165, 180, 200, 220, 240, 260)
INCREMENTS = (1, 2, 5, 20, 200)
#: A reference at these rotations needs more points than at a quarter turn.
FAR, FAR_CHECK = SplineSettings(control_points=16), SplineSettings(control_points=14)


def _rotated() -> Iterator[family.StaticCase]:
    """Yield every rotation in every number of increments."""
    for degrees, count in product(ROTATIONS, INCREMENTS):
        design = replace(named_case(), rotation=math.radians(degrees), increments=count)
        yield family.StaticCase(
            name=f"{degrees} deg in {count}", x=degrees, y=count, design=design, refined=FAR, check=FAR_CHECK
        )


ROTATION = family.study(
    Part(at=_rotated, ask=family.outcomes_of),
)
"""Rotation to a half turn and beyond, in any number of increments."""

#: L/t of a rectangular section of Table 1's flexural rigidity, and rotations at which all are asked.
SLENDER, SLENDER_ROTATIONS = (10.0, 17.0, 30.0, 100.0, 300.0, 1e3, 3e3, 1e4, 3e4, 1e5), (10, 45, 90, 135)
#: Where inextensible strips stand on the map.
INEXTENSIBLE = 1e6
#: Factor between neighbouring designs, between which no digits may be lost.
NEIGHBOUR = 1.001


def _slender_cases() -> Iterator[family.StaticCase]:
    """Yield every slenderness at every rotation."""
    for degrees in SLENDER_ROTATIONS:
        for slenderness in SLENDER:
            design = replace(_slender(slenderness), rotation=math.radians(degrees))
            name = f"L/t = {slenderness:g}, {degrees} deg"
            yield family.StaticCase(name=name, x=slenderness, y=degrees, design=design)
        yield family.StaticCase(
            name=f"inextensible, {degrees} deg",
            x=INEXTENSIBLE,
            y=degrees,
            design=replace(_slender(SLENDER[-1]), rotation=math.radians(degrees)),
            settings={
                name: _inextensible(family.PATHS[name])
                for name in (family.DEFAULT, family.LOCKING_FREE, family.SIX)
            },
            refined=_inextensible(family.REFINED),
            check=_inextensible(family.CHECK),
        )


def _slender(slenderness: float) -> Problem:
    """Return Table 1 with strips of that L/t and the same flexural rigidity: the more slender, the wider."""
    given = named_case()
    area = 12.0 * given.second_moment_of_area * (slenderness / given.length) ** 2
    return replace(given, **of_moments(area, given.second_moment_of_area))


def _inextensible(settings: Any) -> SplineSettings:
    """Return the settings of a spline with strips that cannot stretch."""
    chosen: SplineSettings = replace(settings, stretch="inextensible")
    return chosen


def _limit_table(settings: Any) -> pd.DataFrame:
    """Return, slenderness by slenderness, the distance to the inextensible strip, the iterations and digits.

    With 1/EA the axial energy and all it changes go with (L/t)^-2. `constant` is the distance times (L/t)^2;
    `lost_digits` is what the torques of neighbouring designs differ by beyond that law.
    """
    rigid = answer_static(_slender(SLENDER[-1]), _inextensible(settings))
    rows = []
    for slenderness in SLENDER:
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


#: Looks of the outcomes.
LOOKS = {
    family.RIGHT: Look(label="right", colour=GREEN, line="", marker="o"),
    family.REFUSED: Look(label="refused, or said to be unresolved", colour=YELLOW, line="", marker="D"),
    family.WRONG: Look(label="wrong", colour=RED, line="", marker="X"),
    family.BAD_INPUT: Look(label="cannot be asked", colour=GREY, line="", marker="s"),
}


def _map(tables: Tables) -> Figure:
    """Draw one panel a model: a mark a case, by its outcome."""
    rows = tables["outcomes"]
    models = [model for model in family.ORDER if (rows["model"] == model).any()]
    x = Axis("x", "slenderness L/t [1]", log=True)
    y = Axis("y", "rotation [deg]", limits=(0.0, 145.0))
    small = {"markersize": 3.5}
    panels = [
        Panel(x, y, (Curves(rows[rows["model"] == model], LOOKS, by="outcome", more=small),), title=model)
        for model in models
    ]
    half = -(-len(panels) // 2)
    return sheet(8.8, 5.2, [panels[:half], panels[half:]], legend=4)


SLENDERNESS = family.study(
    Part(at=_slender_cases, ask=family.outcomes_of),
    # the approach of six control points to the inextensible strip
    Part(ask=lambda: {"limit": _limit_table(family.PATHS[family.SIX])}),
    digits={"constant": Digits(relative=1e-4)},  # the error times the square of the slenderness
    figures={"stability_slenderness": _map},
)
"""Slenderness L/t from 10 to 1e5 and strips that cannot stretch: errors, iterations and digits."""
