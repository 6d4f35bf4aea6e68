"""Our answers to published problems: static paths, and paths in arc length where loads are asked."""

import math
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline

from studies.answers.adapters import answer_mechanism, answer_static
from studies.answers.settings import FeSettings, Settings, SplineSettings
from studies.cases.effects import Effects
from studies.cases.mechanism import Mechanism
from studies.cases.problem import Problem
from studies.published import case
from studies.published.case import Published, Value
from studies.stability.statics import frames
from studies.stability.statics.element_arcs import element_arc
from studies.stability.statics.frames import Arc, Frame, spline_arc
from studies.stability.statics.questions import LIMIT, SIDE

#: Fine enough that what is left is the model's, not its discretisation's.
SETTINGS: dict[str, Settings] = {
    "spline": SplineSettings(control_points=12),
    "fe": FeSettings(elements=40),
    "fe-shear": FeSettings(elements=80, element="reissner"),
}
#: Parameters of loads, which grow with the load.
LOADS = ("force", "moment", "acceleration")
FRAMES: dict[str, Callable[..., Frame]] = {
    "column": frames.column,
    "toggle": frames.toggle,
    "lees_frame": frames.lees_frame,
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
        load = problem.frame.get("load", value.load)
        found = OF_ARCS[value.quantity](_arc(name, model, answer, load), value)
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
    design = _answered_as(problem.design, answer)
    response = answer_mechanism(replace(design, effects=_times(design.effects, load)), SETTINGS[model])
    rest = next(body.centre for body in design.bodies if body.name == problem.body)
    way = response.bodies[problem.body][-1] - (*rest, 0.0) if response.converged else np.full(3, np.nan)
    return tuple(float(part) for part in way)


@cache
def _arc(name: str, model: str, answer: str, load: float) -> Arc:
    """Return the path of a problem to a load."""
    problem, settings = case.published(name), SETTINGS[model]
    frame, bent, branch = _frame(problem, answer, load)
    if isinstance(settings, SplineSettings):
        return spline_arc(frame, settings, branch=branch)
    return element_arc(bent, settings)


def _frame(problem: Published, answer: str, load: float) -> tuple[Frame, Frame, str]:
    """Return the loaded frame, what elements are given in its place, and the branch that the spline takes."""
    if isinstance(problem.design, Mechanism):
        design = _answered_as(problem.design, answer)
        loaded = replace(design, effects=_times(design.effects, load))
        frame = Frame(design=loaded, load=load, body=problem.body, pins=problem.pins)
        return frame, frame, "primary"
    how: dict[str, Any] = dict(problem.frame)
    make = FRAMES[how.pop("frame")]
    if make is not frames.column:
        return make(**how), make(**how), "primary"
    return make(**how), make(**how, side=SIDE), "follow"


def _times(effects: Effects, load: float) -> Effects:
    """Return effects with their loads times a factor."""
    tables = {
        effect: {
            name: _product(given, load) if name in LOADS else given for name, given in parameters.items()
        }
        for effect, parameters in effects.tables.items()
    }
    return replace(effects, tables=tables)


def _product(given: Any, load: float) -> Any:
    return tuple(load * part for part in given) if isinstance(given, tuple) else load * given


def _answered_as(design: Mechanism, answer: str) -> Mechanism:
    """Return the design as a kind of answer takes it: a beam, or with one effect more."""
    if answer == case.BEAM:
        return design
    return replace(design, effects=replace(design.effects, names=(*design.effects.names, answer)))


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
