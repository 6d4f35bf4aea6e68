"""How an answer to a hard case ends, right, refused, wrong or bad input, and which models are asked."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, Self

import pandas as pd

from studies.answers.settings import Settings, SplineSettings
from studies.cases.mechanism import Mechanism
from studies.cases.problem import Problem
from studies.engine import Part, Row, Study
from studies.errors import BadInput
from studies.paper import formulations as named
from studies.paper.formulations import LOOKS, SETTINGS
from studies.record.digits import Digits

DEFAULT = "spline, default"
#: The locking-free spline where control points, axial modes or Gauss points are what a family varies.
VARIED = "spline, settings varied"
LOCKING_FREE, PAPER, PRINTED, FE, SIX = (
    LOOKS[name].label for name in (named.LOCKING_FREE, named.PAPER, named.PRINTED, named.FE, named.SIX)
)

#: Column -> settings. A peer is a column of the families when its settings are answered by
#: `studies.answers.adapters`, as these are: add it here.
COLUMNS: dict[str, Settings] = {
    DEFAULT: SplineSettings(),
    **{
        LOOKS[each].label: SETTINGS[each]
        for each in (named.LOCKING_FREE, named.PAPER, named.PRINTED, named.FE)
    },
}

#: Those of the families of paths, where the default takes as many control points as it needs: six beside it.
#: Motions and arcs of frames take six by default.
PATHS: dict[str, Settings] = {**COLUMNS, SIX: SETTINGS[named.SIX]}

#: Those of paths in arc length: finer splines, as the default reaches its end there.
EIGHT, TWELVE = "spline n = 8", "spline n = 12"
ARCS: dict[str, Settings] = {
    **COLUMNS,
    EIGHT: SplineSettings(control_points=8),
    TWELVE: SplineSettings(control_points=12),
}

#: All columns, in the order of tables and figures.
ORDER = (*PATHS, VARIED, EIGHT, TWELVE)

#: Columns that show the paper's own choices: what this suite has an answer say of its resolution does not
#: count there, as the paper has no such check.
UNCHECKED = (PAPER, PRINTED)

RIGHT, REFUSED, WRONG, BAD_INPUT = "right", "refused", "wrong", "bad input"

#: The four outcomes in the order of tables and legends; there is no fifth.
OUTCOMES = (RIGHT, REFUSED, WRONG, BAD_INPUT)


@dataclass(frozen=True, kw_only=True)
class Found:
    """What a model answered to a case, compared with what is known to be right.

    Attributes:
        error: the distance to the reference, or of an invariant to its value, over its scale [1].
        reached: whether the model says that it got to the end; if not, `reason` says why not.
        reason: what the model itself says about its answer; a limitation that it states makes an answer that
            is off a refusal, provided `states_limit` is set.
        warning: what the model's own check of its resolution finds; it states a limit, where it counts.
        fault: an invariant that the answer breaks, in words; what the model says does not excuse it.
        counters: work done, by kind. measured: what else the table has of the answer, by column.
    """

    error: float
    reached: bool = True
    reason: str = ""
    states_limit: bool = False
    warning: str = ""
    fault: str = ""
    counters: Mapping[str, int] = field(default_factory=dict)
    measured: Mapping[str, float] = field(default_factory=dict)

    @classmethod
    def of(cls, answer: Any, error: float, *, fault: str = "", **measured: float) -> Self:
        """Return what an answer, neutral or a model's, says of itself, with its error."""
        return cls(
            error=error,
            reached=getattr(answer.status, "value", answer.status) == "converged",
            reason=answer.message,
            warning=answer.resolution,
            fault=fault,
            counters=answer.counters,
            measured=measured,
        )


def judged(attempt: Callable[[], Found], tolerance: float, model: str = "") -> Row:
    """Return how `attempt` of a column ends, right within `tolerance` [1], as columns of a table.

    Stopped and warned, the latter whether it counts for this `model` or not, are there so that every model
    can be judged with its own warnings and without.

    An answer that is off, or not a finite number, is wrong unless the model said so itself. Bad input is a
    refusal of the question (`BadInput`); any other exception is a fault of the model, and wrong.
    """
    outcome = ""
    try:
        found = attempt()
    except Exception as fault:  # whatever escapes a model is an outcome to be counted, not the study's end
        outcome = BAD_INPUT if isinstance(fault, BadInput) else WRONG
        kind = "" if outcome == BAD_INPUT else f"{type(fault).__name__}: "
        found = Found(error=math.nan, reason=" ".join(f"{kind}{fault}".split()))
    warning = "" if model in UNCHECKED else found.warning
    work = found.counters
    return {
        "outcome": outcome or _outcome(found, tolerance, limited=found.states_limit or bool(warning)),
        "error": found.error,
        "reason": found.fault or (warning if found.reached else "") or found.reason or warning,
        "iterations": work.get("newton_iterations", work.get("iterations", 0)),
        "halvings": work.get("halved_increments", 0) + work.get("halved_steps", 0),
        "stopped": not found.reached,
        "warned": bool(found.warning),
        **found.measured,
    }


def _outcome(found: Found, tolerance: float, *, limited: bool) -> str:
    if found.fault:
        return WRONG
    # what a path or run holds up to where it stopped is judged as well: a refusal must leave a good state
    if math.isfinite(found.error) and found.error <= tolerance:
        return RIGHT if found.reached else REFUSED
    return REFUSED if limited else WRONG


#: Distances reproduce to six digits where the answer is right. Other answers end where round-off leads them.
_DISTANCE = Digits(floor=1e-9)
_RIGHT = Digits(floor=1e-9, rows=f"outcome == '{RIGHT}'")
DIGITS: dict[str, Digits | None] = {
    **dict.fromkeys(("largest_right_error", "refinement", "independent", "period_s"), _DISTANCE),
    **dict.fromkeys(("outcomes.error", "outcomes.found", "stopped", "warned"), _RIGHT),
}


def study(*parts: Part, **declared: Any) -> Study:
    """Return the study of a family whose parts give the table `outcomes`; `counts` follows from it.

    `digits` of its own come before `DIGITS`.
    """
    counts = {"counts": lambda tables: _counted(tables["outcomes"])}
    digits = DIGITS | declared.pop("digits", {})
    return Study(parts=parts, made=counts, digits=digits, **declared)


def _counted(outcomes: pd.DataFrame) -> pd.DataFrame:
    """Return a row a model of `outcomes`: cases tried, one column an outcome, largest right error."""
    ended = pd.crosstab(outcomes["model"], outcomes["outcome"])
    models = [model for model in ORDER if model in ended.index]
    found = ended.reindex(index=models, columns=list(OUTCOMES), fill_value=0).rename_axis(columns=None)
    found.insert(0, "tried", found.sum(axis=1))
    right = outcomes[outcomes["outcome"] == RIGHT]
    return found.assign(largest_right_error=right.groupby("model")["error"].max()).reset_index()


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
