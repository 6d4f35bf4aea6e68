"""The sizing questions that the study asks of Table 1, and the trade between two of them."""

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from studies.cases.problem import Problem, named_case
from studies.design.evaluate import Answers
from studies.design.task import CENTRE_SHIFT, VARIATION, Room, Task, variables_of

CASE = "cross_axis_pivot"

#: Range to either side, and increments of the path to its end.
RANGE_DEG, INCREMENTS = 45.0, 12
#: Starts of every search: Table 1 itself and points spread over the bounds.
STARTS = 8
#: Strips no wider than half their length, in place of no wider than long.
NARROW = 0.5
#: Largest variations of stiffness for which the centre shift is made least [1].
TRADE = (0.07, 0.06, 0.05, 0.04, 0.03, 0.02, 0.01, 0.005, 0.002, 0.001)

BASELINE = "Table 1"
QUESTIONS: Mapping[str, tuple[str, float]] = {
    "least centre shift": (CENTRE_SHIFT, 1.0),
    "least variation of stiffness": (VARIATION, 1.0),
    "least centre shift, narrow strips": (CENTRE_SHIFT, NARROW),
    "least variation of stiffness, narrow strips": (VARIATION, NARROW),
}
#: The two between which the trade lies.
WIDE = ("least centre shift", "least variation of stiffness")
#: Stress at which a strip of hardened spring steel lasts under repeated bending, a choice [Pa].
SPRING_STEEL = 500e6


def baseline() -> Problem:
    """Return Table 1's pivot over the range."""
    return replace(named_case(CASE), rotation=math.radians(RANGE_DEG), increments=INCREMENTS)


def task(start: Problem, own: Answers, objective: str, aspect: float, **limits: float) -> Task:
    """Return a question about a pivot: at its own stiffness, and at its own stress at the end of the range.

    Args:
        start: the pivot; own: its answers. objective: to be least. aspect: largest b / L [1].
        limits: largest variation of stiffness, as `variation` [1].
    """
    length, _, _, thickness, _ = variables_of(start)
    return Task(
        start=start,
        objective=objective,
        stiffness=own.stiffness,
        allowable_stress=float(np.abs(own.stress).max()),
        bounds=Room().bounds(start),
        least_slenderness=float(length / thickness),
        largest_aspect=aspect,
        limits={VARIATION: limits["variation"]} if limits else {},
    )
