"""Static paths of Table 1 at the ends of its range: far rotations, and slender and inextensible strips."""

import math
from collections.abc import Iterator
from dataclasses import replace
from itertools import product
from typing import Any

import numpy as np
import pandas as pd

from studies.answers.adapters import answer_static
from studies.answers.response import Response
from studies.answers.settings import SplineSettings
from studies.cases.problem import Problem, named_case
from studies.engine import Part
from studies.record.digits import Digits
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
#: Slenderness that stands for inextensible strips.
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
    return replace(given, area=area)


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


SLENDERNESS = family.study(
    Part(at=_slender_cases, ask=family.outcomes_of),
    # the approach of six control points to the inextensible strip
    Part(ask=lambda: {"limit": _limit_table(family.PATHS[family.SIX])}),
    digits={"constant": Digits(relative=1e-4)},  # the error times the square of the slenderness
)
"""Slenderness L/t from 10 to 1e5 and strips that cannot stretch: errors, iterations and digits."""
