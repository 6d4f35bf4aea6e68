"""Cost of one Newton iteration over the number of control points, counted and timed."""

from collections.abc import Mapping

import numpy as np
import pandas as pd

from studies.answers.adapters import answer_static
from studies.answers.settings import SplineSettings
from studies.cases.problem import named_case
from studies.engine.study import Answer
from studies.work_precision.work import work_of

CASE = "cross_axis_pivot"
#: Basis -> control points; the range from which the exponent is taken.
COUNTS = {"bezier": (4, 6, 8, 12, 16, 20, 24), "bspline": (8, 12, 16, 24, 32, 48, 64)}
#: Increments of the path that is timed, and how often it is.
INCREMENTS, REPEAT = 20, 7


def points() -> list[tuple[str, int]]:
    """Return bases and control points."""
    return [(basis, n) for basis, counts in COUNTS.items() for n in counts]


def iteration(basis: str, n: int) -> Answer:
    """Return scaling (unknowns, evaluations, flops of one) and scaling_of_time."""
    settings = SplineSettings(control_points=n, basis=basis)
    answer = answer_static(named_case(CASE), settings, repeat=REPEAT)
    work, evaluations = work_of(settings, answer.counters), answer.counters["factorisations"]
    row = {"basis": basis, "control_points": n}
    counted = {
        "status": answer.status,
        "unknowns": work.unknowns,
        "evaluations": evaluations,
        "assembly_flops": work.assembly_flops,
        "factorisation_flops": work.factorisation_flops,
    }
    timed = {"iteration_s": answer.solve_s / evaluations, "solve_s": answer.solve_s}
    return {"scaling": row | counted, "scaling_of_time": row | timed}


def exponent(rows: pd.DataFrame, cost: str, *, least: int) -> float:
    """Return p of cost ~ n^p by least squares over the counts from `least` on."""
    used = rows[rows["control_points"] >= least]
    return float(np.polyfit(np.log(used["control_points"]), np.log(used[cost]), 1)[0])


def of_basis(table: pd.DataFrame, basis: str) -> pd.DataFrame:
    """Return the rows of one basis, sorted by count."""
    return table[table["basis"] == basis].sort_values("control_points")


def exponents(found: Mapping[str, pd.DataFrame]) -> dict[str, float]:
    """Return the exponent of the time of one iteration for each basis, beyond the smallest counts."""
    return {
        "bezier": exponent(of_basis(found["scaling_of_time"], "bezier"), "iteration_s", least=8),
        "bspline": exponent(of_basis(found["scaling_of_time"], "bspline"), "iteration_s", least=16),
    }
