"""The sizing questions that the study asks, and the trade between two of them."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from studies.cases.problem import Problem, named_case
from studies.design.evaluate import Answers
from studies.design.task import CENTRE_SHIFT, VARIATION, Room, Task, variables_of

#: Designs to compare with: their case.
TABLE_ONE, SPRING_STEEL = "Table 1", "spring steel"
BASELINES: Mapping[str, str] = {TABLE_ONE: "cross_axis_pivot", SPRING_STEEL: "spring_steel_pivot"}

#: Range of Table 1's pivot to either side; at its 90 degrees the stress is above 14 GPa.
RANGE_DEG = 45.0
#: Increments of the path to the end of the range.
INCREMENTS = 12
#: Starts of every search: the design to compare with and points spread over the bounds.
STARTS = 8
#: Stress at which a strip of hardened spring steel lasts under repeated bending, a choice [Pa].
ALLOWABLE = 500e6
#: Strips no wider than half their length, in place of no wider than long.
NARROW = 0.5
#: Largest variations of stiffness for which the centre shift is made least [1].
TRADE = (0.07, 0.06, 0.05, 0.04, 0.03, 0.02, 0.01, 0.005, 0.002, 0.001)


@dataclass(frozen=True, kw_only=True)
class Question:
    """What is to be least beside which design.

    Args:
        baseline: the design to compare with, a key of `BASELINES`; objective: a key of `OBJECTIVES`.
        aspect: largest width over length [1].
        stress: allowable [Pa]; None for the baseline's own at the end of the range.
    """

    baseline: str
    objective: str
    aspect: float = 1.0
    stress: float | None = None


QUESTIONS: Mapping[str, Question] = {
    "least centre shift": Question(baseline=TABLE_ONE, objective=CENTRE_SHIFT),
    "least variation of stiffness": Question(baseline=TABLE_ONE, objective=VARIATION),
    "least centre shift, narrow strips": Question(baseline=TABLE_ONE, objective=CENTRE_SHIFT, aspect=NARROW),
    "least variation of stiffness, narrow strips": Question(
        baseline=TABLE_ONE, objective=VARIATION, aspect=NARROW
    ),
    "least centre shift, spring steel": Question(
        baseline=SPRING_STEEL, objective=CENTRE_SHIFT, stress=ALLOWABLE
    ),
    "least variation of stiffness, spring steel": Question(
        baseline=SPRING_STEEL, objective=VARIATION, stress=ALLOWABLE
    ),
}
#: The two between which the trade lies.
WIDE = ("least centre shift", "least variation of stiffness")


def baseline(name: str = TABLE_ONE) -> Problem:
    """Return the design to compare with, over its range."""
    given = named_case(BASELINES[name])
    rotation = math.radians(RANGE_DEG) if name == TABLE_ONE else given.rotation
    return replace(given, rotation=rotation, increments=INCREMENTS)


def task(start: Problem, own: Answers, question: Question, **limits: float) -> Task:
    """Return the task of a question, at the stiffness of the design to compare with.

    Args:
        start: that design; own: its answers. question: of what is to be least.
        limits: largest variation of stiffness, as `variation` [1].
    """
    length, _, _, thickness, _ = variables_of(start)
    stress = float(np.abs(own.stress).max()) if question.stress is None else question.stress
    return Task(
        start=start,
        objective=question.objective,
        stiffness=own.stiffness,
        allowable_stress=stress,
        bounds=Room().bounds(start),
        least_slenderness=float(length / thickness),
        largest_aspect=question.aspect,
        limits={VARIATION: limits["variation"]} if limits else {},
    )
