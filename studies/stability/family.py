"""A family of hard cases: designs whose paths or swings every model is asked for, beside a reference.

The reference is a spline refined far beyond the default. It is settled where refinement moves it by less than
half of the tolerance and finite elements, which share nothing with it, agree with it within the tolerance.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from studies.answers.adapters import answer_release, answer_static
from studies.answers.metrics import differences
from studies.answers.motion import Motion
from studies.answers.reference import rotation_error
from studies.answers.response import Response
from studies.answers.settings import FeSettings, Settings, SplineSettings
from studies.cases.design import Design
from studies.engine import Answer, Row
from studies.stability.verdict import FE, PATHS, RIGHT, Found, judged

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

#: References of paths: a refined spline, the one whose distance to it bounds what refinement still changes,
#: and finer elements, asked where those of the column do not confirm it.
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
            return Found.of(answer, path_distance(answer, reference))
        if not len(answer.time):  # statics does not reach the start
            return Found.of(answer, 0.0)
        gain = float((answer.balance / answer.balance[0] - 1.0).max())
        much = gain > (MOST_GAIN_OF_OTHERS if how.get("integrator") else MOST_GAIN)
        fault = f"the energy grows by {gain:.2g} of itself" if much else ""
        return Found.of(answer, _swing_distance(answer, reference), fault=fault, energy_gain=gain)


def of_path(
    name: str,
    x: float,
    y: float,
    design: Design,
    own: Mapping[str, Settings] | None = None,
    finer: tuple[Way, Way] = ((REFINED, {}), (CHECK, {})),
) -> Question:
    """Return the question for a path that all columns of `PATHS` are asked: its name, its place on the map,
    settings of columns of its own, and settings of its reference and of the check of it."""
    place = {"case": name, "x": x, "y": y}
    settings = PATHS | dict(own or {})
    tries: list[Try] = [(place, model, each, {}) for model, each in settings.items()]
    return Question(place=place, design=design, tries=tries, refined=finer[0], check=finer[1])


def answers_of(question: Question) -> Answer:
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


def path_distance(path: Response, reference: Response) -> float:
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
