"""Our answers to published problems: static paths, and paths in arc length where loads are asked."""

import math
from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
from scipy.interpolate import CubicSpline

from studies.answers.adapters import answer_static
from studies.answers.settings import FeSettings, Settings, SplineSettings
from studies.cases.mechanism import Mechanism
from studies.cases.problem import Problem
from studies.published import case
from studies.published.case import Value, loaded
from studies.stability.element_arcs import element_arc
from studies.stability.frames import SIDE, Arc, frame_of, spline_arc
from studies.stability.questions import LIMIT

#: Fine enough that what is left is the model's, not its discretisation's.
SETTINGS: dict[str, Settings] = {
    "spline": SplineSettings(control_points=12),
    "fe": FeSettings(elements=40),
    "fe-shear": FeSettings(elements=80, element="reissner"),
}


def ours(name: str, model: str, answer: str, value: Value) -> float:
    """Return our answer to a value of a published problem in its printed unit; NaN if the path has none.

    Args:
        name: of the problem. model: of `case.MODELS`. answer: of `case.ANSWERS`.
        value: of the problem.

    Raises:
        BadInput: what the model refuses to be asked.
    """
    problem = case.published(name)
    if isinstance(problem.design, Problem):
        found = _of_pivot(problem.design, SETTINGS[model], value)
    elif value.quantity in AXES:
        found = moved(name, model, answer, value.load)[AXES[value.quantity]]
    else:
        arc = _arc(name, model, answer, value.load, value.quantity == case.LOAD_AT_ROTATION)
        found = OF_ARCS[value.quantity](arc, value)
    return found / value.scale


def _of_pivot(pivot: Problem, settings: Settings, value: Value) -> float:
    """Return the shift of the crossing point over the length at a rotation."""
    response = answer_static(replace(pivot, rotation=math.radians(value.at)), settings)
    return float(np.hypot(*response.centre_shift[-1]) / pivot.length)


@cache
def moved(name: str, model: str, answer: str, load: float) -> tuple[float, ...]:
    """Return how far the body moves under a load, x, y [m] and its turn [rad]; NaN where the path stops."""
    problem = case.published(name)
    assert isinstance(problem.design, Mechanism)
    response = answer_static(loaded(problem.design, answer, load), SETTINGS[model])
    rest = next(body.centre for body in problem.design.bodies if body.name == problem.body)
    way = response.bodies[problem.body][-1] - (*rest, 0.0) if response.converged else np.full(3, np.nan)
    return tuple(float(part) for part in way)


@cache
def _arc(name: str, model: str, answer: str, load: float, bends: bool) -> Arc:
    """Return the path of a problem to a load; one that `bends` leaves the straight branch."""
    settings, bent = SETTINGS[model], {"side": SIDE} if bends else {}
    if isinstance(settings, SplineSettings):
        return spline_arc(frame_of(name, answer, load), settings, branch="follow" if bends else "primary")
    return element_arc(frame_of(name, answer, load, **bent), settings)


def _limit_load(arc: Arc, value: Value) -> float:
    found = [point.load for point in arc.critical if point.kind == LIMIT]
    return found[int(value.at) - 1] if value.at <= len(found) else math.nan


def _limit_points(arc: Arc, value: Value) -> float:
    return float(sum(point.kind == LIMIT for point in arc.critical))


def _load_at_rotation(arc: Arc, value: Value) -> float:
    """Return the load at which the body has turned so far, between the states of the path."""
    turned = np.abs(arc.place[:, 2])
    bent = turned > TURNED
    if not arc.reached or turned[-1] < math.radians(value.at):
        return math.nan
    return float(CubicSpline(turned[bent], arc.load[bent])(math.radians(value.at)))


#: Turn from which a column counts as buckled [rad].
TURNED = 0.05
#: Quantity -> its place among those of a body.
AXES = {case.DISPLACEMENT_X: 0, case.DISPLACEMENT_Y: 1, case.ROTATION: 2}
OF_ARCS: dict[str, Callable[[Arc, Value], float]] = {
    case.LIMIT_LOAD: _limit_load,
    case.LIMIT_POINTS: _limit_points,
    case.LOAD_AT_ROTATION: _load_at_rotation,
}
