"""What accuracy costs in statics: error of the paper's path against time and against counted work.

Every model solves the path of Table 1 to 90 degrees in 20 increments, on one thread. The residual of a solved
state is below 1e-11 in the splines and 1e-10 in the elements, in EI/L^2; the other codes' own tolerance is
set so that it does not show. Each is held against the limit of its own theory (see `paths`), and the
distance of the theories is stated. Time is that of the increments alone (`solve_s`), the median of repeats;
work is counted from sizes (see `work`).
"""

import math
from functools import cache
from typing import Any

import numpy as np
import pandas as pd

from studies.answers.adapters import answer_release
from studies.answers.reference import QUANTITIES
from studies.answers.settings import FeSettings
from studies.baselines.registry import missing
from studies.cases.problem import named_case
from studies.engine.findings import Claim, Tables
from studies.engine.study import Answer, Part, Study
from studies.record.style import BASES
from studies.work_precision import scaling
from studies.work_precision.equal_error import cheapest, diagram, finer, less
from studies.work_precision.paths import (
    THEORIES,
    Limit,
    Member,
    limit_of_theory,
    path_errors,
)
from studies.work_precision.series import ELEMENTS, SPLINE, Series, looks, other_series, own_series
from studies.work_precision.work import ELEMENT_FORCES, STRIPS

CASE = "cross_axis_pivot"

#: An error is shown where it is this many times that of its reference.
MARGIN = 10.0
ERRORS = ("error_trajectory", "error_torque")
#: Errors at which models are compared.
TARGETS = (1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8)

#: Errors at which the two models are compared, and how it is said.
COMPARED = (1e-3, 1e-4, 1e-6)
AT_EQUAL = "At an error of {target:g} in path and torque"
TITLES = {"trajectory": "trajectory", "torque": "torque", "stiffness": "stiffness K"}

#: Elements of the compiled motion from which the speed of compiled elements is taken.
COMPILED_ELEMENTS = 20


def members() -> list[tuple[Series, Member]]:
    """Return every setting with its series."""
    return [(series, member) for series in (*own_series(), *other_series()) for member in series.members]


def solved(series: Series, member: Member) -> Answer:
    """Return errors over the path and at its end, those of the reference, work, and times of a setting."""
    path, exact = member.solve(named_case(CASE), series.repeat), limit(series.theory)
    name = {"series": series.name, "setting": member.setting}
    errors = {
        "series": series.name,
        "family": member.family,
        "setting": member.setting,
        "count": member.count,
        "theory": series.theory,
        "status": path.status,
        **path_errors(path, exact.path),
        **{f"reference_{each}": exact.uncertainty[each] for each in QUANTITIES},
        **path.work,
        "message": path.message,
    }
    times = {"solve_s": path.solve_s, "wall_s": path.wall_s, "repeats": series.repeat}
    return {"errors": errors, "timings": name | times}


@cache
def limit(theory: str) -> Limit:
    """Return what settings of a theory are held against."""
    return limit_of_theory(named_case(CASE), theory)


def _cheapest(tables: Tables, cost: str) -> pd.DataFrame:
    """Return the cheapest settings at equal error."""
    return cheapest(_joined(tables), columns=ERRORS, cost=cost, rank="count", targets=TARGETS)


def _joined(tables: Tables) -> pd.DataFrame:
    """Return errors, work and times of every setting in one table."""
    return tables["errors"].merge(tables["timings"], on=["series", "setting"])


def _reference(theory: str) -> list[dict[str, Any]]:
    """Return a limit's uncertainty, and how far it is from the material one."""
    found = limit(theory)
    apart = path_errors(found.path, limit("material").path)
    return [
        {
            "theory": theory,
            "quantity": name,
            "uncertainty": found.uncertainty[name],
            "distance_to_material": apart[f"error_{name}"] if theory != "material" else math.nan,
            "source": found.source,
        }
        for name in QUANTITIES
    ]


def _language(tables: Tables) -> pd.DataFrame:
    """Return how much of the elements' time is the language: a row a setting of splines and elements.

    A time is work over speed: seconds = operations / (operations a second). So the ratio of two times is
    the ratio of their work, which is the method's, times the ratio of their speeds, which is the language's
    and the machine's. Three speeds are measured in the same run:

    - of the splines' compiled path, from its counted operations and its time;
    - of the elements' path, which is Python around numpy and a sparse solver, in the same way;
    - of the elements when compiled: their explicit motion evaluates the same element's forces in compiled
      code.

    The elements' path at the speed of their own compiled loop is what they would take in a compiled language;
    the fixed cost of calls, which has no operations, is language too.

    Columns: series, setting, flops, solve_s, flops_per_s, compiled_s (time at the speed of compiled elements;
    for splines their own), python_share (what is left of the time; 0 for splines).
    """
    rows = _joined(tables)
    rows = rows[rows["series"].isin([SPLINE, ELEMENTS])]
    found = rows[["series", "setting", "flops", "solve_s"]].copy()
    found["flops_per_s"] = found["flops"] / found["solve_s"]
    own = found["series"] == SPLINE
    found["compiled_s"] = np.where(own, found["solve_s"], found["flops"] / _compiled_speed())
    found["python_share"] = 1.0 - found["compiled_s"] / found["solve_s"]
    return found


def _compiled_speed() -> float:
    """Return the operations a second of the elements' compiled loop [1/s].

    The loop also moves the nodes, which is not counted: the speed is a little more than what is returned.
    """
    motion = answer_release(
        named_case(CASE), FeSettings(elements=COMPILED_ELEMENTS), duration=2e-3, records=10, repeat=5
    )
    elements = motion.counters["force_evaluations"] * STRIPS * COMPILED_ELEMENTS
    return elements * ELEMENT_FORCES / motion.solve_s


def _twenty(tables: Tables) -> pd.DataFrame:
    """Return how much of the time of twenty elements is the language."""
    return tables["language"].query("series == @ELEMENTS and setting == '20 elements'")


def _growth(tables: Tables) -> list[dict[str, Any]]:
    """Return how the time of one iteration grows with the control points of each basis."""
    limits = {"bezier": ("no faster than n^3", 3.0), "bspline": ("about linearly, up to n = 64", 1.25)}
    return [
        {"basis": BASES[basis], "power": power, "grows": limits[basis][0], "most": limits[basis][1]}
        for basis, power in scaling.exponents(tables).items()
    ]


STUDY = Study(
    cases=(CASE,),
    parts=(
        Part(at=lambda: THEORIES, ask=lambda theory: {"reference": _reference(theory)}),
        Part(at=members, ask=solved, alone=True),
        Part(at=scaling.points, ask=scaling.iteration, alone=True),
    ),
    made={
        "digits": lambda tables: _cheapest(tables, "flops"),
        "digits_of_time": lambda tables: _cheapest(tables, "solve_s"),
        "language": _language,
    },
    claims=(
        less("counted work", "digits", AT_EQUAL, COMPARED),
        finer(
            "The reference of the {quantity} is ten times finer than every error",
            "{theory} theory",
            within=("theory",),
        ),
    ),
    claims_of_time=(
        less("time", "digits_of_time", AT_EQUAL, COMPARED),
        Claim(
            claim="The path on 20 elements takes less than 0.4 s",
            formulation="{setting}",
            quantity="its time over 0.4 s",
            rows=_twenty,
            value=lambda row: row["solve_s"] / 0.4,
            holds=lambda row: row["solve_s"] < 0.4,
        ),
        Claim(
            claim="Most of the elements' time is Python",
            formulation="{setting}",
            quantity="the share of the time that compiled elements would not take",
            rows=_twenty,
            value="python_share",
            holds=lambda row: row["python_share"] > 0.5,
        ),
        Claim(
            claim="The time of one iteration grows {grows}",
            formulation="{basis}",
            quantity="the observed exponent over the largest allowed one",
            rows=_growth,
            value=lambda row: row["power"] / row["most"],
            holds=lambda row: row["power"] <= row["most"],
        ),
    ),
    varying=("language",),
    figures={
        "work_precision_statics": lambda tables: diagram(
            tables,
            {name: (title, f"largest error of the {name} [1]") for name, title in TITLES.items()},
            margin=MARGIN,
            rank="count",
            styles=looks(own_series()),
            part="increments",
            width=10.0,
        ),
        "work_precision_scaling": scaling.figure,
    },
    missing=missing,
)
