"""What exact sensitivities cost beside the path that they belong to."""

from functools import partial
from typing import Any

from spline_model.pivot import cross_axis_pivot
from spline_model.sensitivity.parameters import KEYWORDS
from spline_model.sensitivity.solve import sensitivities
from spline_model.statics import solve_statics
from studies.cases.problem import Problem
from studies.record.timing import measure

CONTROL_POINTS = (6, 8, 10)
REPEAT = 21


def timings(problem: Problem) -> list[dict[str, Any]]:
    """Return a row a count of control points: shortest times of a path and of all its sensitivities [s].

    `ratio` is the latter over the former; by central differences it would be two paths a parameter,
    `paths_by_differences`, for a fraction of the digits.
    """
    rows = []
    for count in CONTROL_POINTS:
        pivot = cross_axis_pivot(**problem.pivot_parameters(), control_points=count)
        keywords: dict[str, Any] = {"rotation": problem.rotation, "increments": problem.increments}
        path = measure(partial(solve_statics, pivot, **keywords), repeat=REPEAT)
        exact = measure(partial(sensitivities, pivot, path.result), repeat=REPEAT)
        rows.append(
            {
                "control_points": count,
                "parameters": len(KEYWORDS),
                "path_s": min(path.seconds),
                "sensitivities_s": min(exact.seconds),
                "ratio": min(exact.seconds) / min(path.seconds),
                "paths_by_differences": 2 * len(KEYWORDS),
            }
        )
    return rows
