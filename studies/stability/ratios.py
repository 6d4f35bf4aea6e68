"""Ratios: bodies a million times lighter and heavier, massless and heavy strips, one strip far stiffer."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

from studies.answers.adapters import answer_modes, answer_release
from studies.cases.design import Design
from studies.cases.mechanism import Mechanism, Strip
from studies.cases.problem import Problem, named_case
from studies.engine.study import Answer, Part
from studies.stability import family, maps, swings
from studies.stability.geometry import as_mechanism

#: Factors on mass and moment of inertia of Table 1's body, and on the flexural rigidity of one strip.
FACTORS = (1e-6, 1e-4, 1e-2, 1.0, 1e2, 1e4, 1e6)
STIFFER = (1e2, 1e4)
START_DEG = 30.0
#: Steps in a period of the first mode at rest: of the columns, of the reference and of its coarser twin.
STEPS, REFINED_STEPS, COARSER_STEPS = 200, 1600, 800
#: Columns that are asked: the explicit scheme's steps follow the strips, whatever the body.
ASKED = tuple(name for name in swings.SWINGING if name != family.EXPLICIT)
STRIP_INERTIA = "strip_inertia"
KINDS = ("mass and inertia", "mass alone", "inertia alone")


@dataclass(frozen=True, kw_only=True)
class _Ratio:
    """A design with a ratio at its end: name, kind (a line of the map) and factor (its place there)."""

    name: str
    kind: str
    factor: float
    design: Design


def _cases() -> Iterator[_Ratio]:
    """Yield all designs."""
    given = named_case(family.CASE)
    for kind in KINDS:
        for factor in FACTORS:
            design = replace(
                given,
                body_mass=given.body_mass * (1.0 if kind == KINDS[2] else factor),
                body_moment_of_inertia=given.body_moment_of_inertia * (1.0 if kind == KINDS[1] else factor),
            )
            yield _Ratio(name=f"body: {kind} x {factor:g}", kind=kind, factor=factor, design=design)
    heavy = replace(given, density=100.0 * given.density)
    yield _Ratio(name="strips 100 times as dense", kind="strips", factor=100.0, design=heavy)
    without = [name for name in given.effects.names if name != STRIP_INERTIA]
    massless = replace(given, effects=given.effects.renamed(without))
    yield _Ratio(name="massless strips", kind="strips", factor=0.0, design=massless)
    for factor in STIFFER:
        name = f"second strip {factor:g} times as stiff"
        yield _Ratio(name=name, kind="stiffness", factor=factor, design=_stiffer(given, factor))


def _stiffer(given: Problem, factor: float) -> Mechanism:
    """Return the pivot with a second strip of another material, `factor` times as stiff."""
    cross = as_mechanism(given, START_DEG)
    strips: list[Strip] = [
        cross.strips[0],
        replace(cross.strips[1], youngs_modulus=factor * given.youngs_modulus),
    ]
    return replace(cross, strips=tuple(strips))


def _outcomes_of(case: _Ratio) -> Answer:
    """Return the outcomes of a design, with the gain of energy, and its reference."""
    start = math.radians(START_DEG)
    period = 1.0 / float(answer_modes(case.design, swings.REFINED, count=1).frequency[0])
    asked: dict[str, Any] = {"start": start, "duration": period}
    reference = swings.refined_swing(case.design, step=period / REFINED_STEPS, **asked)
    coarser = swings.refined_swing(case.design, step=period / COARSER_STEPS, **asked)
    rows, gap = [], math.inf
    for name in ASKED:
        verdict = swings.judged_swing(name, case.design, reference, step=period / STEPS, **asked)
        place = {"case": case.name, "kind": case.kind, "x": case.factor, "model": name}
        rows.append({**place, **verdict})
        if name == family.FE and verdict["outcome"] == family.RIGHT:
            gap = verdict["error"]
    if not gap <= swings.TOLERANCE:
        finer: dict[str, Any] = {"integrator": "generalised-alpha", "step": period / REFINED_STEPS}
        other = answer_release(case.design, swings.INDEPENDENT, **finer, **asked)
        gap = swings.rotation_error(other, reference)
    refinement = swings.rotation_error(coarser, reference)
    settled = reference.converged and refinement < swings.TOLERANCE / 2.0 and gap <= swings.TOLERANCE
    known = {"case": case.name, "period_s": period, "refinement": refinement, "independent": gap}
    return {"outcomes": rows, "references": {**known, "settled": "yes" if settled else "no"}}


STUDY = family.study(
    Part(at=_cases, ask=_outcomes_of),
    figures={
        "stability_ratios": lambda tables: maps.listed(
            tables["outcomes"],
            [case.name for case in _cases()],
            title=f"Release from {START_DEG:g}°, one period in {STEPS} steps: rotation within 5 %, "
            "no gain of energy",
        )
    },
)
