"""Audit of a design: what each effect is worth, in its scene or beyond it, and which are sufficient."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from operator import attrgetter
from typing import Any, TypeVar

import numpy as np

from studies.answers.settings import FeSettings, Settings, SplineSettings
from studies.cases.design import Design
from studies.cases.effects import OF_SIDES
from studies.cases.mechanism import Mechanism
from studies.cases.problem import Problem
from studies.effects.scenes import Answer, Outcome, Run, Variant, strayed, tried
from studies.errors import Unanswered
from studies.kinds import Progress
from studies.record.progress import silent


@dataclass(frozen=True, kw_only=True)
class Audit:
    """What an audit found.

    Attributes:
        tolerance: allowed change [1]. run: what every scene was asked.
        full: the full scene, with no change. rows: one effect removed or simplified each.
        beyond: effects that planar beams neglect, and the scene too, with their cost.
        sufficient: the scene without all that can go together within the tolerance; the full one if nothing
            can.
    """

    tolerance: float
    run: Run
    full: Outcome
    rows: tuple[Outcome, ...]
    beyond: list[dict[str, Any]]
    sufficient: Outcome


def audit(design: Design, settings: SplineSettings, tolerance: float, progress: Progress = silent) -> Audit:
    """Return the answers of the full scene and of scenes that neglect effects, and the least sufficient
    scene.

    The full scene is that of the design, with weight and rotary inertia of the sections. If one of these two
    alone makes the design unstable, it is not included but has a row of its own. Changes are relative to the
    full scene.

    Args:
        tolerance: largest relative change that is accepted [1].

    Raises:
        BadInput: the model rejects the full scene. Unanswered: the full scene has no answer.
    """
    upset = _upsetting(design, settings)
    scene = Variant.full(design.effects, [row.variant.added[0] for row in upset])
    run = Run.of(scene.of(design), settings)
    base = run.answer(run.design)
    names = scene.effects.names
    rows = []
    for done, name in enumerate(names):
        progress(done, len(names) + 1)
        rows.append(run.outcome(scene.without([name]), base))
    progress(len(names), len(names) + 1)
    full = sufficient = run.outcome(scene, base)
    spare = sorted((row for row in rows if row.largest <= tolerance), key=attrgetter("largest"))
    while spare:
        found = run.outcome(scene.without(row.variant.dropped[0] for row in spare), base)
        if found.largest <= tolerance:
            sufficient = found
            break
        spare.pop()
    return Audit(
        tolerance=tolerance,
        run=run,
        full=full,
        rows=(*rows, *upset),
        beyond=prices(run.design),
        sufficient=sufficient,
    )


def _upsetting(design: Design, settings: SplineSettings) -> list[Outcome]:
    """Return a row for each effect beside the design's own that makes a stable design unstable at rest."""
    rows: list[Outcome] = []
    for variant in Variant.beside(design.effects):
        try:
            Run.of(variant.of(design), settings)
        except Unanswered as error:
            Run.of(design, settings)  # refused for its own sake, if it is
            rows.append(Outcome(variant=variant, status="unstable", reason=str(error)))
    return rows


Either = TypeVar("Either", bound=Problem | Mechanism)

#: What stands for all of them at once, and for shear.
ALL, SHEAR = "all three", "shear"
CHANGED = ("trajectory", "stiffness", "torque", "stress", "first_mode")
#: Control points by which sections are priced, and elements by which shear is.
CONTROL_POINTS, ELEMENTS = 10, 160


def with_sections(design: Either, names: tuple[str, ...] = OF_SIDES) -> Either:
    """Return a design with these effects beside its own, its sections as the rectangles of their A and I;
    roots are those of one block."""
    tables = {"root_compliance": {"root": "monolithic"}} | dict(design.effects.tables)
    effects = replace(design.effects, tables=tables).plus(*names)
    return _sided(replace(design, effects=effects))


def _sided(design: Either) -> Either:
    """Return a design whose strips have the sides of the rectangles with their A and I."""
    if isinstance(design, Problem):
        known = design.width is not None
        return design if known else replace(design, outer_fibre=None, **design.rectangle())
    strips = [each if each.width is not None else replace(each, **each.rectangle()) for each in design.strips]
    return replace(design, strips=tuple(strips))


def prices(design: Design) -> list[dict[str, Any]]:
    """Return how far each effect beside the design's own moves its answers, a row an effect: sections by the
    splines, shear by elements.

    Keys: effect; status: "converged", "refused" or "not_converged"; reason in a line; changes, NaN where
    there are none: trajectory (largest distance of a body's centre along the path over the largest travel),
    stiffness (at the begin of the rotation), torque and stress (at its end), first_mode (frequency at rest),
    and the largest.

    Raises:
        BadInput: the splines refuse the design. Unanswered: it has no answer without these effects.
    """
    spline = SplineSettings(control_points=CONTROL_POINTS)
    design = _sided(design)
    own = Answer.of(design, spline)
    missing = tuple(name for name in OF_SIDES if name not in design.effects.names)
    asked = {name: (name,) for name in missing} | ({ALL: missing} if len(missing) > 1 else {})
    found = [_price(name, with_sections(design, added), spline, lambda: own) for name, added in asked.items()]
    stiff = FeSettings(elements=ELEMENTS)
    sheared = replace(stiff, element="reissner")
    return [*found, _price(SHEAR, design, sheared, lambda: Answer.of(design, stiff))]


def _changes(found: Answer, own: Answer) -> dict[str, float]:
    """Return how far answers are from the own ones."""
    pairs = (
        (found.stiffness[0], own.stiffness[0]),
        (found.torque[-1], own.torque[-1]),
        (found.stress[-1], own.stress[-1]),
        (found.mode, own.mode),
    )
    ratios = [one / other - 1.0 if other else np.nan for one, other in pairs]
    changes = (strayed(found.path, own.path, own.path[:, 0]), *ratios)
    # rounded to nine decimals, behind which both models have round-off
    return {name: round(float(change), 9) + 0.0 for name, change in zip(CHANGED, changes, strict=True)}


def _price(effect: str, design: Design, settings: Settings, own: Callable[[], Answer]) -> dict[str, Any]:
    """Return a row of `prices`; without changes where there was no answer."""
    found, status, reason = tried(lambda: (own(), Answer.of(design, settings)))
    changes = dict.fromkeys(CHANGED, np.nan) if found is None else _changes(found[1], found[0])
    largest = np.fmax.reduce(np.abs([*changes.values()]))
    return {"effect": effect, "status": status, **changes, "largest": largest, "reason": reason}
