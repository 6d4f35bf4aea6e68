"""What planar beams leave out, priced: how the answers of a design change with each such effect."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any, TypeVar

import numpy as np

from studies.answers.adapters import answer_modes, answer_static
from studies.answers.settings import FeSettings, Settings, SplineSettings
from studies.cases.design import Design
from studies.cases.effects import OF_SIDES
from studies.cases.mechanism import Mechanism
from studies.cases.problem import Problem
from studies.effects.scenes import Unanswered, reached, strayed
from studies.errors import BadInput

Either = TypeVar("Either", bound=Problem | Mechanism)

#: What stands for all of them at once, and for shear.
ALL, SHEAR = "all three", "shear"
CHANGED = ("trajectory", "stiffness", "torque", "stress", "first_mode")
#: Control points by which sections are priced, and elements by which shear is.
CONTROL_POINTS, ELEMENTS = 10, 160


def with_sections(design: Either, names: tuple[str, ...] = OF_SIDES) -> Either:
    """Return a design with these effects beside its own, its sections as the rectangles of their A and I;
    roots are those of one block."""
    effects = design.effects
    tables = {"root_compliance": {"root": "monolithic"}} | dict(effects.tables)
    more = [name for name in names if name not in effects.names]
    return _sided(replace(design, effects=replace(effects, names=(*effects.names, *more), tables=tables)))


def _sided(design: Either) -> Either:
    """Return a design whose strips have the sides of the rectangles with their A and I."""
    if isinstance(design, Problem):
        known = design.width is not None
        return design if known else replace(design, section_depth=None, **design.rectangle())
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
    own = _answers(design, spline)
    missing = tuple(name for name in OF_SIDES if name not in design.effects.names)
    asked = {name: (name,) for name in missing} | ({ALL: missing} if len(missing) > 1 else {})
    found = [_price(name, with_sections(design, added), spline, lambda: own) for name, added in asked.items()]
    stiff = FeSettings(elements=ELEMENTS)
    sheared = replace(stiff, element="reissner")
    return [*found, _price(SHEAR, design, sheared, lambda: _answers(design, stiff))]


def _answers(design: Design, settings: Settings) -> dict[str, Any]:
    """Return what a price is of: centres of bodies as the body turns, stiffness at the begin of that, torque
    and stress at its end, and first mode at rest [Hz]."""
    path, begin = reached(answer_static(design, settings)), -design.increments - 1
    modes = reached(answer_modes(design, settings, count=1)).frequency
    return {
        "centres": {name: each[begin:] for name, each in path.centres.items()},
        "stiffness": path.stiffness[begin],
        "torque": path.torque[-1],
        "stress": path.max_stress[-1],
        "first_mode": float(modes[0]) if len(modes) else np.nan,
    }


def _changes(found: Mapping[str, Any], own: Mapping[str, Any]) -> dict[str, float]:
    """Return how far answers are from the own ones."""
    begins = {name: path[:1] for name, path in own["centres"].items()}
    trajectory = _rounded(strayed(found["centres"], own["centres"], begins))
    others = {name: relative_change(found[name], own[name]) for name in CHANGED[1:]}
    return {CHANGED[0]: trajectory, **others}


def _price(
    effect: str, design: Design, settings: Settings, own: Callable[[], dict[str, Any]]
) -> dict[str, Any]:
    """Return a row of `prices`; without changes where there was no answer."""
    changes, status, reason = dict.fromkeys(CHANGED, np.nan), "converged", ""
    try:
        without = own()
        changes = _changes(_answers(design, settings), without)
    except BadInput as error:
        status, reason = "refused", str(error)
    except Unanswered as error:
        status, reason = "not_converged", str(error)
    largest = np.fmax.reduce(np.abs([*changes.values()]))
    return {"effect": effect, "status": status, **changes, "largest": largest, "reason": reason}


def relative_change(value: float, own: float) -> float:
    """Return a value over the own one less one, rounded; NaN where that is zero."""
    return _rounded(value / own - 1.0) if own != 0.0 else np.nan


def _rounded(change: float) -> float:
    """Return a change to nine decimals, behind which both models have round-off."""
    return round(float(change), 9) + 0.0
