"""Geometry: crossing ratios and inclinations to their ends, parallel, unequal and curved strips."""

import math
from collections.abc import Iterator
from dataclasses import replace

from studies.cases.mechanism import Mechanism, Strip
from studies.cases.problem import Problem, named_case
from studies.engine.study import Part
from studies.stability import family, maps

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
    cross = as_mechanism(given, OTHER_ROTATION)
    first, second = cross.strips
    length = given.length
    apart = {"half a length": length / 2.0, "a tenth of a length": length / 10.0}
    short = replace(second, start=_between(second, 0.3))
    steep = replace(second, start=(0.6 * second.start[0], 0.0))
    designs = {
        **{
            f"parallel strips, {words} apart": _with(
                cross, second=replace(second, start=_shifted(first.start, by), end=_shifted(first.end, by))
            )
            for words, by in apart.items()
        },
        "second strip 0.7 as long": _with(cross, second=short),
        "strips at 45 and 59 degrees": _with(cross, second=steep),
        "second strip 10 times as stiff": _with(cross, second=_thicker(second, 10.0)),
        "second strip 100 times as stiff": _with(cross, second=_thicker(second, 100.0)),
        **{
            f"curved at rest, sagitta {one:+g} and {other:+g} L": _with(
                cross, first=replace(first, rise=one * length), second=replace(second, rise=other * length)
            )
            for one, other in ((0.05, 0.05), (0.05, -0.05), (-0.05, 0.05), (0.15, 0.15), (0.15, -0.15))
        },
    }
    for place, (name, design) in enumerate(designs.items()):
        yield family.StaticCase(name=name, x=place, y=0.0, design=design)


def as_mechanism(given: Problem, degrees: float) -> Mechanism:
    """Return the pivot as a mechanism of two strips and a body, driven to `degrees`."""
    return Mechanism(
        strips=given.strips,
        bodies=given.bodies,
        body=given.body,
        rotation=math.radians(degrees),
        increments=given.increments,
        effects=given.effects,
    )


def _with(cross: Mechanism, *, first: Strip | None = None, second: Strip | None = None) -> Mechanism:
    return replace(cross, strips=(first or cross.strips[0], second or cross.strips[1]))


def _shifted(point: tuple[float, float], by: float) -> tuple[float, float]:
    return point[0] + by, point[1]


def _between(strip: Strip, share: float) -> tuple[float, float]:
    """Return the point of a straight strip at a share of its length."""
    return (
        strip.start[0] + share * (strip.end[0] - strip.start[0]),
        strip.start[1] + share * (strip.end[1] - strip.start[1]),
    )


def _thicker(strip: Strip, factor: float) -> Strip:
    """Return the strip with its depth grown so that it bends `factor` times as hard."""
    return replace(
        strip,
        area=strip.area * factor ** (1.0 / 3.0),
        second_moment_of_area=strip.second_moment_of_area * factor,
    )


STUDY = family.study(
    Part(at=lambda: [*_grid(), *_others()], ask=family.outcomes_of),
    figures={
        "stability_geometry": lambda tables: maps.outcome_map(
            tables["outcomes"][tables["outcomes"]["case"].str.startswith("cross")],
            title="Driven to 90° in 20 increments: torque and path within 5 % of the refined answer",
            xlabel="crossing ratio [1]",
            ylabel="inclination of the strips [deg]",
            xlim=(0.0, 1.0),
            ylim=(0.0, 90.0),
            xticks=[0.0, 0.5, 1.0],
            yticks=list(INCLINATIONS),
        ),
        "stability_other_geometry": lambda tables: maps.listed(
            tables["outcomes"][~tables["outcomes"]["case"].str.startswith("cross")],
            [case.name for case in _others()],
            title=f"Other pairs of strips, driven to {OTHER_ROTATION:g}°",
        ),
    },
)
