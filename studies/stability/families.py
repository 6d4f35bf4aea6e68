"""Six families of hard cases: rotation, slenderness, geometry, axial modes; steps and ratios of swings."""

import math
from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from itertools import chain, product
from typing import Any

from studies.answers.adapters import answer_modes
from studies.answers.settings import FeSettings, SplineSettings
from studies.cases.design import Design
from studies.cases.mechanism import Strip
from studies.cases.problem import STRIPS, TABLE_1, Problem, named_case
from studies.cases.section import of_moments
from studies.engine import Row
from studies.record.store import Digits
from studies.stability import verdict
from studies.stability.verdict import DEFAULT, FE, LOCKING_FREE, PATHS, SIX, Question, Try, family

#: Rotations [deg] and numbers of increments; a reference so far needs more points than at a quarter turn.
ROTATIONS, INCREMENTS = (-180, -90, 90, 135, 150, 165, 180, 200, 220, 240, 260), (1, 2, 5, 20, 200)
FAR: Any = {name: (SplineSettings(control_points=n), {}) for name, n in (("refined", 16), ("check", 14))}


def _rotated() -> Iterator[Question]:
    """Yield every rotation in every number of increments."""
    for degrees, count in product(ROTATIONS, INCREMENTS):
        design = replace(named_case(), rotation=math.radians(degrees), increments=count)
        yield verdict.of_path(f"{degrees} deg in {count}", degrees, count, design, **FAR)


ROTATION = family(_rotated)
"""Rotation to a half turn and beyond, in any number of increments."""

#: L/t of a rectangular section of Table 1's flexural rigidity, and rotations at which all are asked.
SLENDER, SLENDER_ROTATIONS = (10.0, 17.0, 30.0, 100.0, 300.0, 1e3, 3e3, 1e4, 3e4, 1e5), (10, 45, 90, 135)
_inextensible: Any = partial(replace, stretch="inextensible")
#: Slenderness that stands for inextensible strips.
INEXTENSIBLE = 1e6


def _slender_cases() -> Iterator[Question]:
    """Yield every slenderness at every rotation, and strips that cannot stretch."""
    rigid = PATHS | {name: _inextensible(PATHS[name]) for name in (DEFAULT, LOCKING_FREE, SIX)}
    far: Any = {
        "refined": (_inextensible(verdict.REFINED), {}),
        "check": (_inextensible(verdict.CHECK), {}),
    }
    for degrees in SLENDER_ROTATIONS:
        for slenderness in SLENDER:
            design = replace(slender(slenderness), rotation=math.radians(degrees))
            yield verdict.of_path(f"L/t = {slenderness:g}, {degrees} deg", slenderness, degrees, design)
        design = replace(slender(SLENDER[-1]), rotation=math.radians(degrees))
        yield verdict.of_path(f"inextensible, {degrees} deg", INEXTENSIBLE, degrees, design, rigid, **far)


def slender(slenderness: float) -> Problem:
    """Return Table 1 with strips of that L/t and the same flexural rigidity: the more slender, the wider."""
    given = named_case()
    area = 12.0 * given.second_moment_of_area * (slenderness / given.length) ** 2
    return replace(given, **of_moments(area, given.second_moment_of_area))


SLENDERNESS = family(_slender_cases)
"""Slenderness L/t from 10 to 1e5 and strips that cannot stretch."""

#: Distance of the crossing from the ground end over L, and angle of the strips to the ground [deg].
RATIOS_OF_CROSSING = (0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95)
INCLINATIONS = (10, 20, 30, 45, 60, 70, 80)
#: Rotations of pairs of strips that are no symmetric cross [deg]: half of what the pivot is driven to.
OTHER_ROTATION = 45.0


def _grid() -> Iterator[Question]:
    """Yield the pivots of all crossing ratios and inclinations, driven as the paper's."""
    for ratio, degrees in product(RATIOS_OF_CROSSING, INCLINATIONS):
        design = replace(named_case(), crossing_ratio=ratio, inclination=math.radians(degrees))
        yield verdict.of_path(f"cross {ratio:g}, {degrees:g} deg", ratio, degrees, design)


def _others() -> Iterator[Question]:
    """Yield parallel strips, unequal strips in length, stiffness and angle, strips curved at rest."""
    given = named_case()
    cross = verdict.as_mechanism(given, OTHER_ROTATION)
    first, second = cross.strips
    length = given.length
    (x, y), (end_x, end_y) = second.start, second.end
    shorter = (x + 0.3 * (end_x - x), y + 0.3 * (end_y - y))
    pairs = {
        "parallel strips, half a length apart": (first, _beside(first, length / 2.0)),
        "parallel strips, a tenth of a length apart": (first, _beside(first, length / 10.0)),
        "second strip 0.7 as long": (first, replace(second, start=shorter)),
        "strips at 45 and 59 degrees": (first, replace(second, start=(0.6 * second.start[0], 0.0))),
    }
    for factor in (10.0, 100.0):  # by its depth
        moments = of_moments(second.area * factor ** (1.0 / 3.0), second.second_moment_of_area * factor)
        pairs[f"second strip {factor:g} times as stiff"] = (first, replace(second, **moments))
    for one, other in ((0.05, 0.05), (0.05, -0.05), (-0.05, 0.05), (0.15, 0.15), (0.15, -0.15)):
        curved = (replace(first, rise=one * length), replace(second, rise=other * length))
        pairs[f"curved at rest, sagitta {one:+g} and {other:+g} L"] = curved
    for place, (name, strips) in enumerate(pairs.items()):
        yield verdict.of_path(name, place, 0.0, replace(cross, strips=strips))


def _beside(strip: Strip, by: float) -> Strip:
    """Return the second strip parallel to a first one."""
    (x, y), (end_x, end_y) = strip.start, strip.end
    return replace(strip, name=STRIPS[1], start=(x + by, y), end=(end_x + by, end_y))


GEOMETRY = family(lambda: chain(_grid(), _others()))
"""Geometry: crossing ratios and inclinations to their ends, parallel, unequal and curved strips."""

COUNTS = (4, 5, 6, 8, 10)
MODES, FLOATING = "axial modes,\npenalty stiffness 10", "axial modes,\nno penalty stiffness"
POINTS, PAPER_POINTS = "Gauss points,\nmixed stretch", "Gauss points,\nconsistent stretch"


def _discretised() -> Iterator[Question]:
    """Yield one path, asked with every count of axial modes, with and without penalty stiffness, and of Gauss
    points; elements confirm the reference."""
    tries: list[Try] = []

    def add(panel: str, model: str, other: int, settings: SplineSettings) -> None:
        tries.append(({"panel": panel, "x": settings.points, "y": other}, model, settings, {}))

    for n in COUNTS:
        plain = SplineSettings(control_points=n)
        for m in range(1, n):
            modes = replace(plain, axial_modes=m)
            add(MODES, verdict.VARIED, m, modes)
            add(FLOATING, verdict.VARIED, m, replace(modes, penalty_stiffness=0.0))
        for points in range(1, n + 3):
            few = replace(plain, gauss_points=points)
            add(POINTS, verdict.VARIED, points, few)
            add(PAPER_POINTS, verdict.PAPER, points, replace(few, stretch="consistent", measure="spatial"))
    design = replace(named_case(), rotation=math.radians(45.0))
    yield Question(place={"case": TABLE_1}, design=design, tries=tries)


AXIAL_MODES = family(_discretised)
"""Too few and too many axial modes, and too few Gauss points: singular ones are refused, with the reason."""

#: Columns of swings. The paper's measure is for the leapfrog alone.
SWINGING = (DEFAULT, LOCKING_FREE, FE)
#: What swings are held against: a spline, elements, and the steps of Table 1's motion [s].
FINE, INDEPENDENT = SplineSettings(control_points=9), FeSettings(elements=30)
FINE_STEP, COARSER_STEP = 2.5e-6, 5e-6
STEPS = (1e-7, 1e-6, 1e-5, 5e-5, 1e-4, 2e-4, 5e-4, 1e-3, 2e-3, 5e-3, 1e-2)
STARTS = (10, 45, 90, 135)
#: One swing of Table 1 from 90 degrees [s], over which the rotation is compared.
SWING = 0.012
#: Steps of a motion: at least, so that energy could drift; at most, so that the finest end in seconds.
FEWEST, MOST = 15, 1200


def _swinging(place: Row, step: float, **more: float) -> list[Try]:
    """Return the swings of all columns in steps of so long [s]."""
    implicit = {FE: {"integrator": "generalised-alpha"}}
    how = {name: {"step": step, **implicit.get(name, {}), **more} for name in SWINGING}
    return [(place, name, verdict.COLUMNS[name], own) for name, own in how.items()]


def _steps() -> Iterator[Question]:
    """Yield a swing from each start, asked in all steps: at least so many of them, and at most."""
    for degrees in STARTS:
        tries: list[Try] = []
        for step in STEPS:
            place = {"case": f"from {degrees} deg, {step:g} s", "x": step, "y": degrees}
            duration = min(max(round(SWING / step), FEWEST), MOST) * step
            tries += _swinging(place, step, duration=duration)
        yield Question(
            place={"case": f"from {degrees} deg"},
            design=named_case(),
            motion={"start": math.radians(degrees), "duration": SWING},
            tries=tries,
            refined=(FINE, {"step": FINE_STEP}),
            check=(FINE, {"step": COARSER_STEP}),
            arbiter=(INDEPENDENT, {}),
        )


STEP_SIZE = family(_steps)
"""Steps from 1e-7 to 1e-2 s: no gain of energy, and a warning where a step is too long."""

#: Factors on mass and moment of inertia of Table 1's body, and on the flexural rigidity of one strip.
FACTORS, STIFFER = (1e-6, 1e-4, 1e-2, 1.0, 1e2, 1e4, 1e6), (1e2, 1e4)
START_DEG = 30.0
#: Steps in a period of the first mode at rest: of the columns, of the reference and of its coarser twin.
STEPS_A_PERIOD, REFINED_STEPS, COARSER_STEPS = 200, 1600, 800
_MASS, _INERTIA = "body_mass", "body_moment_of_inertia"
KINDS = {"mass and inertia": (_MASS, _INERTIA), "mass alone": (_MASS,), "inertia alone": (_INERTIA,)}


def _designs() -> Iterator[tuple[str, str, float, Design]]:
    """Yield all designs with a ratio at its end: name, kind (a line of the map), factor (its place there)."""
    given = named_case()
    for (kind, names), factor in product(KINDS.items(), FACTORS):
        changed: Any = {name: factor * getattr(given, name) for name in names}
        yield f"body: {kind} x {factor:g}", kind, factor, replace(given, **changed)
    yield "strips 100 times as dense", "strips", 100.0, replace(given, density=100.0 * given.density)
    without = [name for name in given.effects.names if name != "strip_inertia"]
    yield "massless strips", "strips", 0.0, replace(given, effects=given.effects.renamed(without))
    cross = verdict.as_mechanism(given, START_DEG)
    for factor in STIFFER:  # of another material
        second = replace(cross.strips[1], youngs_modulus=factor * given.youngs_modulus)
        stiffer = replace(cross, strips=(cross.strips[0], second))
        yield f"second strip {factor:g} times as stiff", "stiffness", factor, stiffer


def _ratios() -> Iterator[Question]:
    """Yield the first swing of every design, in steps of the same part of its period."""
    for case, kind, factor, design in _designs():
        period = 1.0 / float(answer_modes(design, FINE, count=1).frequency[0])
        place = {"case": case, "kind": kind, "x": factor}
        fine = {"step": period / REFINED_STEPS}
        yield Question(
            place={"case": case, "period_s": period},
            design=design,
            motion={"start": math.radians(START_DEG), "duration": period},
            tries=_swinging(place, period / STEPS_A_PERIOD),
            refined=(FINE, fine),
            check=(FINE, {"step": period / COARSER_STEPS}),
            arbiter=(INDEPENDENT, {"integrator": "generalised-alpha", **fine}),
        )


RATIOS = family(
    _ratios,
    digits={"outcomes.error": Digits(relative=0.05, floor=1e-9, rows="outcome == 'right'")},
)
"""Ratios: bodies a million times lighter and heavier, massless and heavy strips, one strip far stiffer."""
