"""Work of a motion that does not depend on machine or language, counted as in `work`.

- spline, leapfrog: every evaluation takes the forces of the strips in control points (`add_forces`) and
  multiplies those of the inner ones with the constant inverse of their mass; what is done for the tips and
  the body does not grow with the size and is left out;
- spline, implicit: every Newton iteration assembles residual and tangent of the bordered system and takes a
  dense LU of it;
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
        return _of_elements(settings, counters)
    return _explicit(settings, counters) if "evaluations" in counters else _implicit(settings, counters)


def strip_force_flops(control_points: int) -> int:
    """Return the operations of `add_forces` for a Bezier strip, n + 2 Gauss points, n - 1 axial forces."""
    points, modes = control_points + 2, control_points - 1
    return points * (16 * control_points + 4 * modes + 40) + modes


def _of_elements(settings: FeSettings, counters: Mapping[str, int]) -> dict[str, Any]:
    count, evaluations = STRIPS * settings.elements, counters["force_evaluations"]
    return {
        "unknowns": 3 * (count - STRIPS) + 3,
        "points": count,
        "steps": counters["steps"],
        "evaluations": evaluations,
        "factorisations": 0,
        "flops": evaluations * (count * ELEMENT_FORCES + (count - STRIPS) * MOVED_NODE),
    }


def _explicit(settings: SplineSettings, counters: Mapping[str, int]) -> dict[str, Any]:
    n, evaluations = settings.points, counters["evaluations"]
    inner = 4 * (n - 3) * (n - 1)
    return {
        "unknowns": STRIPS * (2 * n - 6) + 3,
        "points": STRIPS * (n + 2),
        "steps": counters["steps"],
        "evaluations": evaluations,
        "factorisations": 0,
        "flops": evaluations * STRIPS * (strip_force_flops(n) + inner),
    }


def _implicit(settings: SplineSettings, counters: Mapping[str, int]) -> dict[str, Any]:
    n, factorisations = settings.points, counters["factorisations"]
    modes, points = n - 1, n + 2
    size = STRIPS * (2 * n + modes + 6) + 3
    evaluations = factorisations + counters["steps"]
    return {
        "unknowns": size,
        "points": STRIPS * points,
        "steps": counters["steps"],
        "evaluations": evaluations,
        "factorisations": factorisations,
        "flops": evaluations * STRIPS * assembly_flops(points, n, modes)
        + factorisations * (2 * size**3 // 3 + 2 * size**2),
    }
