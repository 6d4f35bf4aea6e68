"""Published problems: what others printed, our answers by model, and whether they meet it.

A published problem is added by one case file in `cases` and its name in `PROBLEMS`. Excluded, as their
published data are incomplete: NAFEMS 3DNLG-1 (load, section and modulus are published, as are tip deflections
of 142.6 to 144.1 at a load of 4000, but the outline of the Z is in pictures alone); the bistable beam of Ma
and Chen (its thickness is not published, and those who repeat it chose one that gives the published peak);
the four-bar coefficients of Jensen and Howell for cross-axis pivots; rates of catalogue pivots (diameters and
rates to 10 % without the strips' thickness) and the shift of the Free-Flex pivot (a chart); and the turn of
the parallelogram's stage (of the size of its mesh's error).

Answers are static paths, and paths with their critical points where loads are asked.
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import cache

import numpy as np
from scipy.interpolate import CubicSpline

from studies.answers.adapters import answer_static
from studies.answers.settings import FeSettings, Settings, SplineSettings
from studies.engine import Answer, Claim, Part, Row, Study
from studies.errors import BadInput
from studies.published import case
from studies.published.arcs import LIMIT, REACHED, Arc, arc_of
from studies.published.case import Value, published

#: Fine enough that what is left is the model's, not its discretisation's.
SETTINGS: dict[str, Settings] = {
    "spline": SplineSettings(control_points=14),
    "fe": FeSettings(elements=40),
    "fe-shear": FeSettings(elements=80, element="reissner"),
}


def ours(name: str, model: str, answer: str, value: Value) -> float:
    """Return our answer to a value of a published problem in its printed unit; NaN if the path has none.

    Args:
        name: of the problem. model: of `case.MODELS`. answer: of its limits.
        value: of the problem.

    Raises:
        BadInput: what the model refuses to be asked.
    """
    design = published(name).design
    if design.crossing_point is not None:  # the shift of the crossing point over the length at a rotation
        response = answer_static(replace(design, rotation=math.radians(value.at)), SETTINGS[model])
        found = float(np.hypot(*response.centre_shift[-1]) / design.strips[0].length)
    elif value.quantity in case.PLACES:
        found = _moved(name, model, answer, value.load)[case.PLACES.index(value.quantity)]
    else:
        arc = _arc(name, model, answer, value.load, value.quantity == case.LOAD_AT_ROTATION)
        found = OF_ARCS[value.quantity](arc, value)
    return found / value.unit_SI


@cache
def _moved(name: str, model: str, answer: str, load: float) -> tuple[float, ...]:
    """Return how far the body moves under a load, x, y [m] and its turn [rad]; NaN where the path stops."""
    frame = published(name).frame(load, answer)
    response = answer_static(frame.design, SETTINGS[model])
    way = response.bodies[frame.body][-1] - (*frame.rest, 0.0) if response.converged else np.full(3, np.nan)
    return tuple(float(part) for part in way)


@cache
def _arc(name: str, model: str, answer: str, load: float, bends: bool) -> Arc:
    """Return the path of a problem to a load; one that `bends` leaves the straight branch."""
    return arc_of(published(name).frame(load, answer), SETTINGS[model], follow_branch=bends)


def _load_at_rotation(arc: Arc, value: Value) -> float:
    """Return the load at which the body has turned so far, between the states of the path.

    Load and turn are both smooth over the way of the body; one over the other is steep where a column closes.
    """
    turned = np.abs(arc.place[:, 2])
    if arc.status != REACHED or turned[-1] < math.radians(value.at):
        return math.nan
    bent = turned > TURNED
    way = np.cumsum(np.linalg.norm(np.diff(arc.place[bent], axis=0, prepend=arc.place[bent][:1]), axis=1))
    found = CubicSpline(way, turned[bent]).solve(math.radians(value.at), extrapolate=False)
    return float(CubicSpline(way, arc.load[bent])(found[0]))


#: Turn from which a column counts as buckled [rad].
TURNED = 0.05
OF_ARCS: dict[str, Callable[[Arc, Value], float]] = {
    case.LIMIT_LOAD: lambda arc, value: arc.critical_load(LIMIT, int(value.at) - 1),
    case.LIMIT_POINTS: lambda arc, value: float(sum(point.kind == LIMIT for point in arc.critical)),
    case.LOAD_AT_ROTATION: _load_at_rotation,
}


PROBLEMS = (
    "parallelogram",
    "princeton_flatwise",
    "princeton_edgewise",
    "tip_force",
    "own_weight",
    "short_cantilever",
    "column",
    "williams_toggle",
    "williams_shallow_toggle",
    "lees_frame",
    "clamped_hinged_arch",
    "catalogue_pivot",
)
#: Attributes of a published value that become columns of the table.
OF_VALUES = ("quantity", "at", "load", "unit", "bound", "published", "uncertainty")


def _asked() -> Iterator[tuple[str, str, str]]:
    """Yield every problem with the models and the kinds of answer that are asked for.

    The elements with shear answer where shear is asked, and no others.
    """
    for name in PROBLEMS:
        problem = published(name)
        for model in problem.models:
            for answer in problem.answers:
                if (model == "fe-shear") == (case.SHEAR in answer):
                    yield name, model, answer


def _compared(name: str, model: str, answer: str) -> Answer:
    """Return one row per value: published value, computed value, and whether they agree."""
    values = published(name).values
    return {"values": [_row(name, model, answer, value) for value in values if model in value.models]}


def _row(name: str, model: str, answer: str, value: Value) -> Row:
    problem, limit = published(name), value.limit[answer]
    try:
        found, message = ours(name, model, answer, value), ""
    except BadInput as refusal:
        found, message = np.nan, str(refusal)
    return {
        "problem": problem.title,
        "case": name,
        "model": model,
        "answer": answer,
        **{column: getattr(value, column) for column in OF_VALUES},
        "found": found,
        "error": (found - value.published) / (abs(value.published) or 1.0),
        "limit": limit,
        "within": "yes" if value.met(found, limit) else "no",
        "message": message,
        "source": problem.source,
    }


STUDY = Study(
    cases=tuple(f"published/cases/{name}" for name in PROBLEMS),
    parts=(Part(at=_asked, ask=_compared),),
    claims=(
        Claim(
            claim="Published values are met within their uncertainty and the limit of their case file",
            formulation="{problem}, {model}, {answer}",
            quantity="the difference of {quantity} at load {load:.3g}, {at:g}",
            rows=lambda tables: tables["values"],
            value="error",
            holds=lambda row: row["within"] == "yes",
        ),
    ),
)
