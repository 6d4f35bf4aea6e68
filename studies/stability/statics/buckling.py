"""Compression and buckling: the column and the elastica, frames that snap through, the pivot pushed down.

The spline follows the branch that crosses at a bifurcation. The elements do not: they are led onto it by a
small side load, or by a tilt of the body that is let go. The forces as printed have no potential, so there is
no stability to be asked of them.
"""

import math
from functools import partial

from studies.answers.settings import Settings
from studies.engine.study import Answer, Part
from studies.stability.columns import CHECK, COLUMNS, FE, FINER, INDEPENDENT, REFINED, UNCHECKED
from studies.stability.family import family
from studies.stability.frames import curves
from studies.stability.frames import figure as figure_of
from studies.stability.frames.arcs import Arc
from studies.stability.frames.questions import BucklingCase, answer, cases
from studies.stability.outcome import Found, judged
from studies.stability.statics.paths import TOLERANCE


def outcomes_of(case: BucklingCase) -> Answer:
    """Return the outcomes of all models, and the reference: in closed form, or the refined spline."""
    refined = case.value(answer(case, REFINED))
    reference = refined if math.isnan(case.exact) else case.exact
    spread = max(difference(case.value(answer(case, CHECK)), refined), difference(refined, reference))
    gap = difference(case.value(answer(case, INDEPENDENT)), reference)
    settled = "yes" if spread <= TOLERANCE / 5.0 and gap <= TOLERANCE else "no"
    place = {"case": case.name, "quantity": case.quantity}
    known = {"reference": reference, "published": case.published}
    rows = []
    for model, settings in (COLUMNS | FINER).items():
        values: list[float] = []
        attempt = partial(_attempt, case, settings, reference, values, checked=model not in UNCHECKED)
        verdict = judged(attempt, TOLERANCE)
        found = values[0] if values else math.nan
        load = case.frame.load
        rows.append({**place, "model": model, "load": load, "found": found, **known, **verdict.row()})
    reached = {"model": FE, "refinement": spread, "independent": gap, "settled": settled}
    return {"outcomes": rows, "references": {**place, **reached, **known}}


def difference(found: float, reference: float) -> float:
    """Return the difference over the reference, or as it is where that is zero [1]; nan if there is none."""
    return abs(found - reference) / (abs(reference) or 1.0)


def _attempt(
    case: BucklingCase, settings: Settings, reference: float, values: list[float], *, checked: bool
) -> Found:
    """Answer a case, note the number that was found, and compare it."""
    arc = answer(case, settings)
    value = case.value(arc)
    values.append(value)
    return _compared(arc, difference(value, reference), checked=checked)


def _compared(arc: Arc, error: float, *, checked: bool) -> Found:
    warning = arc.warning if checked else ""
    return Found(
        error=error,
        reached=arc.reached,
        reason=(warning if arc.reached else "") or arc.message,
        # a path that says where it stopped does not claim what lies beyond
        states_limit=bool(warning) or not arc.reached,
        counters=arc.counters,
    )


STUDY = family(
    Part(at=cases, ask=outcomes_of),
    Part(ask=curves.tables),
    figures={"stability_buckling": figure_of.figure},
)
