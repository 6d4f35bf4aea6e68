"""How an answer to a hard case ends, which models are asked, and families of such cases.

A family asks every model for the paths or swings of its designs, beside a reference: a spline refined far
beyond the default. It is settled where refinement moves it by less than half of the tolerance and finite
elements, which share nothing with it, agree with it within the tolerance.
"""

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, fields
from functools import partial
from typing import Any, Self

import numpy as np
import pandas as pd

from studies.answers.adapters import answer_release, answer_static
from studies.answers.metrics import differences
from studies.answers.motion import Motion
from studies.answers.reference import rotation_error
from studies.answers.response import Response
from studies.answers.settings import FeSettings, Settings, SplineSettings
from studies.cases.design import Design
from studies.cases.mechanism import Mechanism
from studies.cases.problem import Problem
from studies.engine import Answer, Part, Row, Study
from studies.errors import BadInput
from studies.paper import formulations as named
from studies.paper.formulations import LOOKS
from studies.record.store import Digits

DEFAULT = "spline, default"
#: The locking-free spline where control points, axial modes or Gauss points are what a family varies.
VARIED = "spline, settings varied"
LOCKING_FREE, PAPER, PRINTED, FE, SIX = (
    LOOKS[name].label for name in (named.LOCKING_FREE, named.PAPER, named.PRINTED, named.FE, named.SIX)
)
#: Finer splines, for paths in arc length: the default reaches its end there.
TWELVE = "spline n = 12"

#: Column -> settings. A peer is a column of the families when its settings are answered by
#: `studies.answers.adapters`, as these are: add it here.
SETTINGS: dict[str, Settings] = {
    DEFAULT: SplineSettings(),
    **{LOOKS[name].label: settings for name, settings in named.SETTINGS.items()},
    TWELVE: SplineSettings(control_points=12),
}
#: Those of all families; of paths, where the default takes as many control points as it needs (motions and
#: arcs of frames take six by default); and of paths in arc length.
COLUMNS, PATHS, ARCS = (
    {name: SETTINGS[name] for name in (DEFAULT, LOCKING_FREE, PAPER, PRINTED, FE, *more)}
    for more in ((), (SIX,), (TWELVE,))
)
#: All columns, in the order of tables and figures.
ORDER = (*PATHS, VARIED, TWELVE)

#: Columns that show the paper's own choices: what this suite has an answer say of its resolution does not
#: count there, as the paper has no such check.
UNCHECKED = (PAPER, PRINTED)

#: The four outcomes in the order of tables; there is no fifth.
OUTCOMES = RIGHT, REFUSED, WRONG, BAD_INPUT = "right", "refused", "wrong", "bad input"


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
        measured: what else the table has of the answer, by column.
    """

    error: float
    reached: bool = True
    reason: str = ""
    states_limit: bool = False
    warning: str = ""
    fault: str = ""
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
            measured=measured,
        )


def judged(attempt: Callable[[], Found], tolerance: float, model: str = "") -> Row:
    """Return how `attempt` of a column ends, right within `tolerance` [1], as columns of a table.

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
    return {
        "outcome": outcome or _outcome(found, tolerance, limited=found.states_limit or bool(warning)),
        "error": found.error,
        "reason": found.fault or (warning if found.reached else "") or found.reason or warning,
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
    **dict.fromkeys(("outcomes.error", "outcomes.found"), _RIGHT),
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
    """Return the pivot as a mechanism of two strips and a body, driven to `degrees` [deg]."""
    parts = {each.name: getattr(given, each.name) for each in fields(Mechanism)}
    return Mechanism(**parts | {"rotation": math.radians(degrees)})


#: Largest distance that counts as right [1], over the largest torque and displacement of a path, and over the
#: rotation at the start of a swing. The error of six control points grows to 0.03 at a half turn, and a step
#: of a twentieth of the swing's period errs by as much after one swing; another branch or motion is off by
#: more than 0.1.
TOLERANCE = 0.05
#: Largest gain of energy over that at the start: of the energy-consistent scheme, and of those that keep
#: energy in the limit of short steps only.
MOST_GAIN, MOST_GAIN_OF_OTHERS = 1e-8, 1e-2
#: Records of a motion.
RECORDS = 400
#: Keywords of a motion beside its start and duration: `step` [s] and `integrator`.
How = Mapping[str, Any]
#: Settings of a model, and how its motion is integrated.
Way = tuple[Settings, How]

#: References of paths: a refined spline, the one that bounds what refinement still changes, and finer
#: elements, asked where those of the column do not confirm it.
REFINED, CHECK = SplineSettings(control_points=14), SplineSettings(control_points=11)
ARBITER = FeSettings(elements=80)

#: One answer that is asked for: its place in the tables, the column it counts for, and how it is made.
Try = tuple[Row, str, Settings, How]


@dataclass(frozen=True, kw_only=True)
class Question:
    """A design, what is asked of it, and all who are asked.

    Attributes:
        place: of its reference in the tables. design: whose path is asked for, or with `motion` (start [rad]
            and duration [s]) its swing. tries: who is asked.
        refined, check: of the reference. arbiter: elements that decide where no column of theirs is right.
    """

    place: Row
    design: Design
    tries: Sequence[Try]
    motion: How | None = None
    refined: Way = (REFINED, {})
    check: Way = (CHECK, {})
    arbiter: Way = (ARBITER, {})

    def answer(self, settings: Settings, how: How) -> Any:
        """Return what a model answers."""
        if self.motion is None:
            return answer_static(self.design, settings)
        return answer_release(self.design, settings, records=RECORDS, **{**self.motion, **how})

    def found(self, settings: Settings, how: How, reference: Any) -> Found:
        """Return an answer compared with the reference."""
        answer = self.answer(settings, how)
        if self.motion is None:
            return Found.of(answer, _path_distance(answer, reference))
        if not len(answer.time):  # statics does not reach the start
            return Found.of(answer, 0.0)
        gain = float((answer.balance / answer.balance[0] - 1.0).max())
        much = gain > (MOST_GAIN_OF_OTHERS if how.get("integrator") else MOST_GAIN)
        fault = f"the energy grows by {gain:.2g} of itself" if much else ""
        return Found.of(answer, _swing_distance(answer, reference), fault=fault, energy_gain=gain)


def of_path(
    name: str, x: float, y: float, design: Design, settings: Mapping[str, Settings] = PATHS, **more: Any
) -> Question:
    """Return the question for a path.

    Args:
        name: of the family. x, y: place on the map, in the units of its axes. design: the case.
        settings: of the columns, by name. more: of `Question`, for an unusual reference.
    """
    place = {"case": name, "x": x, "y": y}
    tries: list[Try] = [(place, model, each, {}) for model, each in settings.items()]
    return Question(place=place, design=design, tries=tries, **more)


def _answers(question: Question) -> Answer:
    """Return how all who are asked end, a row each, and the row of the reference."""
    reference = question.answer(*question.refined)
    rows: list[Row] = []
    for place, model, settings, how in question.tries:
        attempt = partial(question.found, settings, how, reference)
        rows.append({**place, "model": model, **judged(attempt, TOLERANCE, model)})
    confirmed = (row["error"] for row in rows if (row["model"], row["outcome"]) == (FE, RIGHT))
    gap = min(confirmed, default=math.inf)
    if not gap <= TOLERANCE:
        gap = question.found(*question.arbiter, reference).error
    spread = question.found(*question.check, reference).error
    settled = reference.converged and spread <= TOLERANCE / 2.0 and gap <= TOLERANCE
    known = {"refinement": spread, "independent": gap, "settled": "yes" if settled else "no"}
    return {"outcomes": rows, "references": {**question.place, **known}}


def family(questions: Callable[[], Iterable[Question]], **declared: Any) -> Study:
    """Return the study of a family of questions."""
    return study(Part(at=questions, ask=_answers), **declared)


def _path_distance(path: Response, reference: Response) -> float:
    """Return the largest distance of two paths over the states that both have: of torque or place [1].

    Each over its largest value on the reference's path; infinite where the path is not of finite numbers.
    """
    apart = [each for each in differences(path, reference, ("path", "torque")).values() if each is not None]
    return max(apart, default=0.0) if np.isfinite(apart).all() else math.inf


def _swing_distance(motion: Motion, reference: Motion) -> float:
    """Return the largest difference of rotation at the motion's records, as far as the reference goes, over
    the rotation at the start [1]; infinite for a motion with one that is no number."""
    if not len(motion.time) or len(reference.time) < 2 or not np.isfinite(motion.rotation).all():
        return math.inf
    return rotation_error(motion, reference, motion.time) / abs(float(reference.rotation[0]))
