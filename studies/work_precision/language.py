"""How much of the elements' time is the language and how much the method.

A time is work over speed: seconds = operations / (operations a second). So the ratio of two times is the
ratio of their work, which is the method's, times the ratio of their speeds, which is the language's and the
machine's. Three speeds are measured in the same run:

- of the splines' compiled path, from its counted operations and its time;
- of the elements' path, which is Python around numpy and a sparse solver, in the same way;
- of the elements when compiled: their explicit motion evaluates the same element's forces in compiled code.

The elements' path at the speed of their own compiled loop is what they would take in a compiled language;
the fixed cost of calls, which has no operations, is language too.
"""

from collections.abc import Mapping

import numpy as np
import pandas as pd

from studies.answers.adapters import answer_release
from studies.answers.settings import FeSettings
from studies.cases.problem import Problem
from studies.work_precision.series import ELEMENTS, SPLINE
from studies.work_precision.work import ELEMENT_FORCES, STRIPS

#: The compiled motion from which the speed of compiled elements is taken.
COMPILED_ELEMENTS, DURATION, REPEAT = 20, 2e-3, 5


def table(problem: Problem, tables: Mapping[str, pd.DataFrame]) -> pd.DataFrame:
    """Return a row a setting of splines and elements.

    Columns: series, setting, flops, solve_s, flops_per_s, compiled_s (time at the speed of compiled elements;
    for splines their own), python_share (what is left of the time; 0 for splines).
    """
    rows = tables["errors"].merge(tables["timings"], on=["series", "setting"])
    rows = rows[rows["series"].isin([SPLINE, ELEMENTS])]
    found = rows[["series", "setting", "flops", "solve_s"]].copy()
    found["flops_per_s"] = found["flops"] / found["solve_s"]
    own = found["series"] == SPLINE
    found["compiled_s"] = np.where(own, found["solve_s"], found["flops"] / compiled_speed(problem))
    found["python_share"] = 1.0 - found["compiled_s"] / found["solve_s"]
    return found


def compiled_speed(problem: Problem) -> float:
    """Return the operations a second of the elements' compiled loop [1/s].

    The loop also moves the nodes, which is not counted: the speed is a little more than what is returned.
    """
    motion = answer_release(
        problem, FeSettings(elements=COMPILED_ELEMENTS), duration=DURATION, records=10, repeat=REPEAT
    )
    elements = motion.counters["force_evaluations"] * STRIPS * COMPILED_ELEMENTS
    return elements * ELEMENT_FORCES / motion.solve_s
