"""Too few and too many axial modes, and too few Gauss points: singular ones are refused, with the reason."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cache, partial

from studies.answers.adapters import answer_path
from studies.answers.settings import SplineSettings
from studies.cases.problem import Problem, named_case
from studies.engine.study import Answer, Part
from studies.stability import maps
from studies.stability.family import CASE, FE, INDEPENDENT, PAPER, REFINED, VARIED, family, judged
from studies.stability.statics.paths import TOLERANCE, StaticPath, attempted, distance

COUNTS = (4, 5, 6, 8, 10)
ROTATION_DEG = 45.0

MODES = "axial modes,\nslide stiffness 10"
FLOATING = "axial modes,\nno slide stiffness"
POINTS = "Gauss points,\nmixed stretch"
PAPER_POINTS = "Gauss points,\nconsistent stretch"
PANELS = (MODES, FLOATING, POINTS, PAPER_POINTS)


@dataclass(frozen=True, kw_only=True)
class Setting:
    """One discretisation: its panel, place there, and which column it counts for."""

    panel: str
    model: str
    count: int
    other: int
    settings: SplineSettings


@cache
def reference() -> StaticPath:
    """Return the refined path that all are held against."""
    return answer_path(_design(), REFINED)


def _outcome(each: Setting) -> Answer:
    """Return how one discretisation ends."""
    attempt = partial(attempted, _design(), each.settings, reference(), checked=each.model != PAPER)
    place = {"panel": each.panel, "model": each.model, "x": each.count, "y": each.other}
    return {"outcomes": {**place, **judged(attempt, TOLERANCE).row()}}


def independent() -> Answer:
    """Return how far finite elements are from the reference."""
    gap = distance(answer_path(_design(), INDEPENDENT), reference())
    settled = "yes" if gap <= TOLERANCE / 5.0 else "no"
    return {"references": {"case": CASE, "model": FE, "independent": gap, "settled": settled}}


def _design() -> Problem:
    return replace(named_case(CASE), rotation=math.radians(ROTATION_DEG))


def settings() -> Iterator[Setting]:
    """Yield every count of axial modes, with and without slide stiffness, and of Gauss points."""
    for n in COUNTS:
        plain = SplineSettings(control_points=n)
        for m in range(1, n):
            modes = replace(plain, axial_modes=m)
            yield Setting(panel=MODES, model=VARIED, count=n, other=m, settings=modes)
            floating = replace(modes, slide_stiffness=0.0)
            yield Setting(panel=FLOATING, model=VARIED, count=n, other=m, settings=floating)
        for points in range(1, n + 3):
            few = replace(plain, gauss_points=points)
            yield Setting(panel=POINTS, model=VARIED, count=n, other=points, settings=few)
            paper = replace(few, stretch="consistent", measure="spatial")
            yield Setting(panel=PAPER_POINTS, model=PAPER, count=n, other=points, settings=paper)


STUDY = family(
    Part(at=settings, ask=_outcome),
    Part(ask=independent),
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
