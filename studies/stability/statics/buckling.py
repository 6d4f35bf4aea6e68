"""Compression and buckling: the column and the elastica, frames that snap through, the pivot pushed down.

The spline follows the branch that crosses at a bifurcation. The elements do not: they are led onto it by a
small side load, or by a tilt of the body that is let go. The forces as printed have no potential, so there is
no stability to be asked of them.
"""

import math
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import pandas as pd
from matplotlib.figure import Figure

from studies.answers.settings import Settings
from studies.stability.columns import CHECK, COLUMNS, FE, FINER, INDEPENDENT, REFINED, UNCHECKED
from studies.stability.counts import counted
from studies.stability.frames import curves as curves_of
from studies.stability.frames import figure as figure_of
from studies.stability.frames.arcs import Arc
from studies.stability.frames.designs import CASE
from studies.stability.frames.questions import BucklingCase, answer, cases
from studies.stability.outcome import Found, judged
from studies.stability.statics.paths import TOLERANCE

CASES = (CASE,)


def compute(progress: Callable[[int, int], None]) -> dict[str, pd.DataFrame]:
    """Return outcomes (a row a case and model), references, counts, curves, critical points and branches."""
    outcomes, references = [], []
    chosen = list(cases())
    for done, case in enumerate(chosen):
        progress(done, len(chosen) + 1)
        rows, reference = _case(case)
        outcomes += rows
        references.append(reference)
    progress(len(chosen), len(chosen) + 1)
    curves = curves_of.tables()
    progress(len(chosen) + 1, len(chosen) + 1)
    table = pd.DataFrame(outcomes)
    return {"outcomes": table, "references": pd.DataFrame(references), "counts": counted(table), **curves}


def draw(tables: Mapping[str, pd.DataFrame]) -> dict[str, Figure]:
    """Draw load against deflection of the four."""
    return {"stability_buckling": figure_of.figure(tables)}


def _case(case: BucklingCase) -> tuple[list[dict[str, Any]], dict[str, Any]]:
    """Return the rows of all models, and that of the reference: in closed form, or the refined spline."""
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
    return rows, {**place, "model": FE, "refinement": spread, "independent": gap, "settled": settled, **known}


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
