"""What accuracy costs in statics: error of the paper's path against time and against counted work.

Every model solves the path of Table 1 to 90 degrees in 20 increments, on one thread. The residual of a solved
state is below 1e-11 in the splines and 1e-10 in the elements, in EI/L^2; the other codes' own tolerance is
set so that it does not show. Each is held against the limit of its own theory (see `limits`), and the
distance of the theories is stated. Time is that of the increments alone (`solve_s`), the median of repeats;
work is counted from sizes (see `work`).
"""

import math
from collections.abc import Callable, Mapping
from typing import Any

import pandas as pd
from matplotlib.figure import Figure

from studies.baselines.registry import missing
from studies.cases.problem import Problem, named_case
from studies.paper.findings import table
from studies.work_precision import figures, language, scaling, static_findings
from studies.work_precision.equal_error import cheapest
from studies.work_precision.limits import THEORIES, Limit, limit_of_theory
from studies.work_precision.paths import QUANTITIES, Member, SolvedPath, path_errors
from studies.work_precision.series import SPLINE, Series, all_series

__all__ = ["CASES", "compute", "draw", "equal_error", "missing"]

CASE = "cross_axis_pivot"
CASES = (CASE,)

#: An error is shown where it is this many times that of its reference.
MARGIN = 10.0
ERRORS = ("error_trajectory", "error_torque")
#: Errors at which models are compared.
TARGETS = (1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8)


def compute(progress: Callable[[int, int], None]) -> dict[str, pd.DataFrame]:
    """Return errors, work and times of all settings, what is cheapest at equal error, and the findings.

    Tables: errors (a row a setting: errors over the path and at its end, those of its reference, work);
    timings (the same settings: solve_s, wall_s); reference; digits (cheapest by counted work at equal error);
    digits_of_time; scaling and scaling_of_time (one Newton iteration over n); language (what the reference's
    Python costs); findings and findings_of_time.
    """
    problem, series = named_case(CASE), all_series()
    limits = {theory: limit_of_theory(problem, theory) for theory in THEORIES}
    solved = []
    for done, each in enumerate(series):
        progress(done, len(series) + 1)
        solved += [(each, member, member.solve(problem, each.repeat)) for member in each.members]
    progress(len(series), len(series) + 1)
    tables = {
        "errors": pd.DataFrame([_errors(*one, limits) for one in solved]),
        "timings": pd.DataFrame([_times(*one) for one in solved]),
        "reference": _references(problem, limits),
    }
    tables |= scaling.tables(problem)
    tables |= equal_error(tables)
    tables["language"] = language.table(problem, tables)
    progress(len(series) + 1, len(series) + 1)
    return tables | {
        "findings": table(static_findings.of_work(tables)),
        "findings_of_time": table(static_findings.of_time(tables)),
    }


def draw(tables: Mapping[str, pd.DataFrame]) -> dict[str, Figure]:
    """Draw the work-precision diagram and the cost of one iteration over the control points."""
    return {
        "work_precision_statics": figures.statics(tables, MARGIN),
        "work_precision_scaling": figures.scaling(tables),
    }


def equal_error(tables: Mapping[str, pd.DataFrame]) -> dict[str, pd.DataFrame]:
    """Return the cheapest settings at equal error, by work and by time."""
    rows = joined(tables)
    asked: dict[str, Any] = {"columns": ERRORS, "rank": "count", "targets": TARGETS, "baseline": SPLINE}
    return {
        "digits": cheapest(rows, cost="flops", **asked),
        "digits_of_time": cheapest(rows, cost="solve_s", **asked),
    }


def joined(tables: Mapping[str, pd.DataFrame]) -> pd.DataFrame:
    """Return errors, work and times of every setting in one table."""
    return tables["errors"].merge(tables["timings"], on=["series", "setting"])


def _errors(series: Series, member: Member, path: SolvedPath, limits: Mapping[str, Limit]) -> dict[str, Any]:
    limit = limits[series.theory]
    return {
        "series": series.name,
        "family": "all",
        "setting": member.setting,
        "count": member.count,
        "theory": series.theory,
        "status": path.status,
        **path_errors(path, limit.path),
        **{f"reference_{name}": limit.uncertainty[name] for name in QUANTITIES},
        **path.work,
        "message": path.message,
    }


def _times(series: Series, member: Member, path: SolvedPath) -> dict[str, Any]:
    return {
        "series": series.name,
        "setting": member.setting,
        "solve_s": path.solve_s,
        "wall_s": path.wall_s,
        "repeats": series.repeat,
    }


def _references(problem: Problem, limits: Mapping[str, Limit]) -> pd.DataFrame:
    """Return each limit's end values, its uncertainty, and how far it is from the material one."""
    rows = []
    for theory, limit in limits.items():
        apart = path_errors(limit.path, limits["material"].path)
        for name in QUANTITIES:
            rows.append(
                {
                    "theory": theory,
                    "quantity": name,
                    "uncertainty": limit.uncertainty[name],
                    "distance_to_material": apart[f"error_{name}"] if theory != "material" else math.nan,
                    "source": limit.source,
                }
            )
    return pd.DataFrame(rows)
