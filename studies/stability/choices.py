"""What may be chosen, well or badly: the geometry, axial modes and Gauss points."""

import math
from collections.abc import Iterator
from dataclasses import replace
from functools import cache, partial

from studies.answers.adapters import answer_static
from studies.answers.response import Response
from studies.answers.settings import SplineSettings
from studies.cases.mechanism import Strip
from studies.cases.problem import STRIPS, TABLE_1, Problem, named_case
from studies.cases.section import of_moments
from studies.engine import Answer, Part
from studies.stability import family

#: Distance of the crossing from the ground end over L, and angle of the strips to the ground [deg].
RATIOS = (0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95)
INCLINATIONS = (10, 20, 30, 45, 60, 70, 80)

#: Rotations of pairs of strips that are no symmetric cross [deg]: half of what the pivot is driven to.
OTHER_ROTATION = 45.0


def _grid() -> Iterator[family.StaticCase]:
    """Yield the pivots of all crossing ratios and inclinations, driven as the paper's."""
    given = named_case()
    for ratio in RATIOS:
        for degrees in INCLINATIONS:
            design = replace(given, crossing_ratio=ratio, inclination=math.radians(degrees))
            yield family.StaticCase(
                name=f"cross {ratio:g}, {degrees:g} deg", x=ratio, y=degrees, design=design
            )


def _others() -> Iterator[family.StaticCase]:
    """Yield parallel strips, unequal strips in length, stiffness and angle, strips curved at rest."""
    given = named_case()
    cross = family.as_mechanism(given, OTHER_ROTATION)
    first, second = cross.strips
    length = given.length
    (x, y), (end_x, end_y) = second.start, second.end
    pairs = {
        "parallel strips, half a length apart": (first, _beside(first, length / 2.0)),
        "parallel strips, a tenth of a length apart": (first, _beside(first, length / 10.0)),
        "second strip 0.7 as long": (
            first,
            replace(second, start=(x + 0.3 * (end_x - x), y + 0.3 * (end_y - y))),
        ),
        "strips at 45 and 59 degrees": (first, replace(second, start=(0.6 * second.start[0], 0.0))),
        "second strip 10 times as stiff": (first, _thicker(second, 10.0)),
        "second strip 100 times as stiff": (first, _thicker(second, 100.0)),
        **{
            f"curved at rest, sagitta {one:+g} and {other:+g} L": (
                replace(first, rise=one * length),
                replace(second, rise=other * length),
            )
            for one, other in ((0.05, 0.05), (0.05, -0.05), (-0.05, 0.05), (0.15, 0.15), (0.15, -0.15))
        },
    }
    for place, (name, strips) in enumerate(pairs.items()):
        yield family.StaticCase(name=name, x=place, y=0.0, design=replace(cross, strips=strips))


def _beside(strip: Strip, by: float) -> Strip:
    """Return the second strip parallel to a first one."""
    (x, y), (end_x, end_y) = strip.start, strip.end
    return replace(strip, name=STRIPS[1], start=(x + by, y), end=(end_x + by, end_y))


def _thicker(strip: Strip, factor: float) -> Strip:
    """Return the strip with its depth grown so that it bends `factor` times as hard."""
    thicker = of_moments(strip.area * factor ** (1.0 / 3.0), strip.second_moment_of_area * factor)
    return replace(strip, **thicker)


GEOMETRY = family.study(
    Part(at=lambda: [*_grid(), *_others()], ask=family.outcomes_of),
)
"""Geometry: crossing ratios and inclinations to their ends, parallel, unequal and curved strips."""

COUNTS = (4, 5, 6, 8, 10)
ROTATION_DEG = 45.0

MODES = "axial modes,\nslide stiffness 10"
FLOATING = "axial modes,\nno slide stiffness"
POINTS = "Gauss points,\nmixed stretch"
PAPER_POINTS = "Gauss points,\nconsistent stretch"


@cache
def _reference() -> Response:
    """Return the refined path that all are held against."""
    return answer_static(_design(), family.REFINED)


def _outcome_of(panel: str, model: str, count: int, other: int, settings: SplineSettings) -> Answer:
    """Return how one discretisation ends."""
    attempt = partial(family.attempted, _design(), settings, _reference())
    place = {"panel": panel, "model": model, "x": count, "y": other}
    return {"outcomes": {**place, **family.judged(attempt, family.TOLERANCE, model)}}


def _independent() -> Answer:
    """Return how far finite elements are from the reference."""
    gap = family.attempted(_design(), family.INDEPENDENT, _reference()).error
    settled = "yes" if gap <= family.TOLERANCE / 5.0 else "no"
    return {"references": {"case": TABLE_1, "model": family.FE, "independent": gap, "settled": settled}}


def _design() -> Problem:
    return replace(named_case(), rotation=math.radians(ROTATION_DEG))


def _settings() -> Iterator[tuple[str, str, int, int, SplineSettings]]:
    """Yield every count of axial modes, with and without slide stiffness, and of Gauss points: the panel, the
    column it counts for, the place in the panel and the settings."""
    for n in COUNTS:
        plain = SplineSettings(control_points=n)
        for m in range(1, n):
            modes = replace(plain, axial_modes=m)
            yield MODES, family.VARIED, n, m, modes
            yield FLOATING, family.VARIED, n, m, replace(modes, slide_stiffness=0.0)
        for points in range(1, n + 3):
            few = replace(plain, gauss_points=points)
            yield POINTS, family.VARIED, n, points, few
            yield PAPER_POINTS, family.PAPER, n, points, replace(few, stretch="consistent", measure="spatial")


AXIAL_MODES = family.study(
    Part(at=_settings, ask=_outcome_of),
    Part(ask=_independent),
)
"""Too few and too many axial modes, and too few Gauss points: singular ones are refused, with the reason."""
