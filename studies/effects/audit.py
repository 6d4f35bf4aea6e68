"""Audit of a design: what each effect is worth, in its scene or beyond it, and the cheapest scene."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import Any

import numpy as np

from studies.answers.adapters import answer_release, answer_static
from studies.answers.settings import FeSettings, Settings, SplineSettings
from studies.cases.design import Design
from studies.cases.effects import OF_SIDES
from studies.cases.mechanism import Strip
from studies.effects.scenes import Answer, Run, Scene, strayed, tried
from studies.errors import Unanswered
from studies.kinds import Progress
from studies.record.progress import silent, watched

#: Timed rounds of all scenes, one after the other.
ROUNDS = 3
#: A scene that took so many times as long as the full one is not timed again, but for one below so many
#: seconds: its first call may have loaded kernels.
SLOW, QUICK = 3.0, 1.0


@dataclass(frozen=True, kw_only=True)
class Audit:
    """What an audit found.

    Attributes:
        tolerance: allowed change [1]. run: what every scene was asked.
        full: the full scene, with no change. rows: one effect removed or simplified each.
        tried: scenes without several effects, for the cheapest, which is the last one if it is within.
        beyond: effects that planar beams neglect, and the scene too, with their cost.
        cheapest: the scene with the fewest effects that is within the tolerance.
    """

    tolerance: float
    run: Run
    full: Scene
    rows: tuple[Scene, ...]
    tried: tuple[Scene, ...]
    beyond: list[dict[str, Any]]
    cheapest: Scene


def audit(design: Design, settings: SplineSettings, tolerance: float, progress: Progress = silent) -> Audit:
    """Return the answers of the full scene and of scenes that neglect effects, and the cheapest sufficient
    scene.

    The full scene is that of the design, with weight and rotary inertia of the sections. If one of these two
    alone makes the design unstable, it is not included but has a row of its own. Changes are relative to the
    full scene.

    Args:
        tolerance: largest relative change that is accepted [1].

    Raises:
        BadInput: the model rejects the full scene. Unanswered: the full scene has no answer.
    """
    own = Scene(effects=design.effects)
    upset = _upsetting(design, own, settings)
    added = [scene.added[0] for scene in own.beside() if scene.added not in [each.added for each in upset]]
    scene = Scene(effects=design.effects.plus(*added))
    run = Run.of(scene.of(design), settings)
    base = run.answer(run.design)
    full = run.asked(scene, base)
    names = scene.effects.names
    rows = []
    for name in watched(names, lambda done, total: progress(done, total + 2)):
        rows.append(run.asked(scene.without(name), base))
    tried = [*_fewer(rows, scene, run, base, tolerance)]
    full, *others = _timed([full, *rows, *tried], run)
    progress(len(names) + 1, len(names) + 2)
    return Audit(
        tolerance=tolerance,
        run=run,
        full=full,
        rows=(*others[: len(rows)], *upset),
        tried=tuple(others[len(rows) :]),
        beyond=prices(run.design),
        cheapest=others[-1] if tried and tried[-1].largest <= tolerance else full,
    )


def _upsetting(design: Design, own: Scene, settings: SplineSettings) -> list[Scene]:
    """Return the scenes with an effect beside its own that makes a stable design unstable at rest."""
    found: list[Scene] = []
    for scene in own.beside():
        try:
            Run.of(scene.of(design), settings)
        except Unanswered as error:
            Run.of(design, settings)  # refused for its own sake, if it is
            found.append(replace(scene, status="unstable", reason=str(error)))
    return found


def _fewer(rows: Sequence[Scene], scene: Scene, run: Run, full: Answer, tolerance: float) -> Iterator[Scene]:
    """Yield the scene without all effects that can each be removed, then without all but the most important
    of them, and so on until one is within the tolerance."""
    within = sorted((row for row in rows if row.largest <= tolerance), key=lambda row: row.largest)
    names = [row.dropped[0] for row in within]
    while names:
        found = run.asked(scene.without(*names), full)
        yield found
        if found.largest <= tolerance:
            return
        names.pop()


def _timed(scenes: Sequence[Scene], run: Run) -> list[Scene]:
    """Return the scenes with their median times of path and motion, taken round by round in turn; slow ones
    keep their first time."""
    slow = max(SLOW * scenes[0].wall_s, QUICK)
    walls: list[list[float]] = [[] if each.wall_s <= slow else [each.wall_s] for each in scenes]
    for _, (each, own) in product(range(ROUNDS), list(zip(scenes, walls, strict=True))):
        if each.wall_s <= slow:
            design = each.of(run.design)
            motion = answer_release(design, run.settings, duration=run.duration, step=run.step)
            own.append(answer_static(design, run.settings).wall_s + motion.wall_s)
    return [replace(each, wall_s=float(np.median(own))) for each, own in zip(scenes, walls, strict=True)]


#: What stands for all of them at once, and for shear.
ALL, SHEAR = "all three", "shear"
CHANGED = ("trajectory", "stiffness", "torque", "stress", "first_mode")
#: Control points by which sections are priced, and elements by which shear is.
CONTROL_POINTS, ELEMENTS = 10, 160


def with_sections(design: Design, names: tuple[str, ...] = OF_SIDES) -> Design:
    """Return a design with these effects beside its own, its sections as the rectangles of their A and I;
    roots are those of one block."""
    tables = {"root_compliance": {"root": "monolithic"}} | dict(design.effects.tables)
    effects = replace(design.effects, tables=tables).plus(*names)
    return _sided(replace(design, effects=effects))


def _sided(design: Design) -> Design:
    """Return a design whose strips have the sides of the rectangles with their A and I."""

    def sides(strip: Strip) -> dict[str, Any]:
        return {"outer_fibre": None, **strip.rectangle()} if strip.width is None else {}

    return design.changed(sides)


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
