"""Work of a motion that does not depend on machine or language, counted as in `work`.

- spline, implicit: every Newton iteration assembles residual and tangent of the bordered system and takes a
  dense LU of it;
- spline, explicit: every evaluation assembles the gradient as statics does, and with it its tangent, then
  forms and solves the reduced mass matrix J^T M J of R = 4 n - 5 rows;
- elements, explicit: every evaluation takes the forces of all elements, and moves three coordinates a node
  by four operations each. Nothing is factorised.
"""

from collections.abc import Mapping
from typing import Any

from studies.answers.settings import FeSettings, Settings, SplineSettings
from studies.work_precision.work import ELEMENT_FORCES, STRIPS, assembly_flops

#: Operations that move the three coordinates of a node by one step.
MOVED_NODE = 12


def work_of_motion(settings: Settings, counters: Mapping[str, int]) -> dict[str, Any]:
    """Return unknowns, points, steps, evaluations, factorisations and flops of a motion of the pivot."""
    if isinstance(settings, FeSettings):
        count = STRIPS * settings.elements
        evaluations = counters["force_evaluations"]
        return _row(
            unknowns=3 * STRIPS * (settings.elements - 1) + 3,
            points=count,
            steps=counters["steps"],
            evaluations=evaluations,
            factorisations=0,
            flops=evaluations * (count * ELEMENT_FORCES + (count - STRIPS) * MOVED_NODE),
        )
    return _of_spline(settings, counters)


def _of_spline(settings: SplineSettings, counters: Mapping[str, int]) -> dict[str, Any]:
    n = settings.control_points
    modes, points = n - 1, n + 2
    assembly = STRIPS * assembly_flops(points, n, modes)
    coordinates, reduced = STRIPS * 2 * n + 3, STRIPS * (2 * n - 4) + 3
    size = coordinates + STRIPS * (modes + 6)
    explicit = "evaluations" in counters
    evaluations = counters["evaluations"] if explicit else counters["newton_iterations"] + counters["steps"]
    solves = evaluations if explicit else counters["factorisations"]
    # two products of matrices and a solve with the reduced mass, or the bordered LU with its substitution
    products = 2 * coordinates * reduced * (coordinates + reduced) + 2 * reduced**3 // 3
    solve = products if explicit else 2 * size**3 // 3 + 2 * size**2
    return _row(
        unknowns=reduced if explicit else size,
        points=STRIPS * points,
        steps=counters["steps"],
        evaluations=evaluations,
        factorisations=solves,
        flops=evaluations * assembly + solves * solve,
    )


def _row(**columns: int) -> dict[str, Any]:
    return columns
