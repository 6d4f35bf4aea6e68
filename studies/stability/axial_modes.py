"""Too few and too many axial modes, and too few Gauss points: singular ones are refused, with the reason."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cache, partial

from studies.answers.adapters import answer_static
from studies.answers.response import Response
from studies.answers.settings import SplineSettings
from studies.cases.problem import Problem, named_case
from studies.engine.study import Answer, Part
from studies.stability import family, maps
from studies.stability.paths import TOLERANCE, attempted, distance

COUNTS = (4, 5, 6, 8, 10)
ROTATION_DEG = 45.0

MODES = "axial modes,\nslide stiffness 10"
FLOATING = "axial modes,\nno slide stiffness"
POINTS = "Gauss points,\nmixed stretch"
PAPER_POINTS = "Gauss points,\nconsistent stretch"
PANELS = (MODES, FLOATING, POINTS, PAPER_POINTS)


@dataclass(frozen=True, kw_only=True)
class _Setting:
    """One discretisation: its panel, place there, and which column it counts for."""

    panel: str
    model: str
    count: int
    other: int
    settings: SplineSettings


@cache
def _reference() -> Response:
    """Return the refined path that all are held against."""
    return answer_static(_design(), family.REFINED)


def _outcome(each: _Setting) -> Answer:
    """Return how one discretisation ends."""
    attempt = partial(attempted, _design(), each.settings, _reference(), checked=each.model != family.PAPER)
    place = {"panel": each.panel, "model": each.model, "x": each.count, "y": each.other}
    return {"outcomes": {**place, **family.judged(attempt, TOLERANCE)}}


def _independent() -> Answer:
    """Return how far finite elements are from the reference."""
    gap = distance(answer_static(_design(), family.INDEPENDENT), _reference())
    settled = "yes" if gap <= TOLERANCE / 5.0 else "no"
    return {"references": {"case": family.CASE, "model": family.FE, "independent": gap, "settled": settled}}


def _design() -> Problem:
    return replace(named_case(family.CASE), rotation=math.radians(ROTATION_DEG))


def settings() -> Iterator[_Setting]:
    """Yield every count of axial modes, with and without slide stiffness, and of Gauss points."""
    for n in COUNTS:
        plain = SplineSettings(control_points=n)
        for m in range(1, n):
            modes = replace(plain, axial_modes=m)
            yield _Setting(panel=MODES, model=family.VARIED, count=n, other=m, settings=modes)
            floating = replace(modes, slide_stiffness=0.0)
            yield _Setting(panel=FLOATING, model=family.VARIED, count=n, other=m, settings=floating)
        for points in range(1, n + 3):
            few = replace(plain, gauss_points=points)
            yield _Setting(panel=POINTS, model=family.VARIED, count=n, other=points, settings=few)
            paper = replace(few, stretch="consistent", measure="spatial")
            yield _Setting(panel=PAPER_POINTS, model=family.PAPER, count=n, other=points, settings=paper)


STUDY = family.study(
    Part(at=settings, ask=_outcome),
    Part(ask=_independent),
    figures={
        "stability_axial_modes": lambda tables: maps.outcome_map(
            tables["outcomes"],
            panels_by="panel",
            order=PANELS,
            title=f"Table 1 driven to {ROTATION_DEG:g}°: torque and path within 5 % of the refined answer",
            xlabel="control points [1]",
            ylabel="axial modes, Gauss points [1]",
            xlim=(3.0, 11.0),
            ylim=(0.0, 13.0),
            xticks=list(COUNTS),
        )
    },
)
