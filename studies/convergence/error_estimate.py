"""How well the spline model estimates its own error when it is asked for an accuracy.

Designs from slender to thick, with the crossing from one end to the other, turned by 20 to 120 degrees, are
solved to accuracies of 1e-2 to 1e-7; some of them are released and followed to accuracies of the rotation.
The true error is that against many more control points (in motion also shorter steps). The effectivity is the
estimate over the true error: below one it is optimistic. The largest stress converges more slowly than path
and torque, and its estimate is of the stress in each state; it is judged apart.
"""

import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
from scipy.stats import qmc

from studies.answers.adapters import answer_modes, answer_release, answer_static
from studies.answers.metrics import differences
from studies.answers.motion import Motion
from studies.answers.reference import rotation_error
from studies.answers.response import Response
from studies.answers.settings import SplineSettings
from studies.cases.problem import Problem, named_case
from studies.cases.section import of_sides
from studies.engine import Answer, Claim, Part, Row, Study, Tables
from studies.record.store import Digits

SEED = 2013
#: Static designs: how many, their bounds, and what is asked for [1].
DESIGNS = 36
BOUNDS = {
    "slenderness": (10.0, 1000.0),
    "crossing_ratio": (0.1, 0.9),
    "inclination": (math.radians(20.0), math.radians(70.0)),
    "rotation": (math.radians(20.0), math.radians(120.0)),
}
ACCURACIES = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7)
#: Control points where the search begins, of the reference, and of the path that its own error is told by.
FIRST, REFERENCE, CHECK = 4, 22, 19

#: Swinging designs: few, and thick enough that explicit steps are affordable for the reference.
SWINGS = 6
SWING_BOUNDS = {
    "slenderness": (8.0, 20.0),
    "crossing_ratio": (0.3, 0.7),
    "inclination": (math.radians(30.0), math.radians(60.0)),
    "rotation": (math.radians(20.0), math.radians(90.0)),
}
SWING_ACCURACIES = (3e-2, 1e-2)
#: Duration over the period of the swing at rest, and control points of reference and check.
PERIODS = 1.0
SWING_REFERENCE, SWING_CHECK = 9, 7
#: Leapfrog steps of both in a period, at least four times as many as are stable.
STEPS_A_PERIOD = 20000

#: The band an effectivity should lie in, the share of designs that must, and the least of any.
BAND, SHARE, LEAST = (0.3, 10.0), 0.9, 1.0 / 3.0
#: A true error counts if that of its reference is this many times smaller.
MARGIN = 10.0


def _drawn(bounds: Mapping[str, tuple[float, float]], count: int) -> Iterator[tuple[Row, Problem]]:
    """Yield `count` pivots like Table 1 whose values fill the bounds evenly: a Latin hypercube; with the
    columns that say which design it is.

    bounds: of L over the depth of the section, drawn evenly in its logarithm, crossing ratio [1], inclination
    and rotation [rad].
    """
    given = named_case()
    low, high = np.array([*bounds.values()]).T
    low[0], high[0] = math.log(low[0]), math.log(high[0])
    points = qmc.scale(qmc.LatinHypercube(d=len(bounds), seed=SEED).random(count), low, high)
    width = given.area / given.depth
    for number, (logarithm, *others) in enumerate(points):
        depth = given.length / math.exp(logarithm)
        values: dict[str, Any] = dict(zip([*bounds][1:], map(float, others), strict=True))
        problem = replace(given, width=width, thickness=depth, **of_sides(width, depth), **values)
        identity = {"design": number, "slenderness": problem.length / problem.depth}
        identity |= {"crossing_ratio": problem.crossing_ratio, "inclination_rad": problem.inclination}
        yield identity | {"rotation_rad": problem.rotation}, problem


def _static(design: Row, problem: Problem) -> Answer:
    """Return the rows of one design's static paths, those of the stress in a table of their own."""
    exact, check = (answer_static(problem, SplineSettings(control_points=n)) for n in (REFERENCE, CHECK))
    ask = partial(answer_static, problem, SplineSettings(control_points=FIRST))
    rows = list(_rows({"problem": "statics", **design}, ACCURACIES, ask, _path_errors, exact, check))
    stress = [row for row in rows if row["quantity"] == "stress"]
    return {"estimates": [row for row in rows if row["quantity"] != "stress"], "stress": stress}


def _swings(design: Row, problem: Problem) -> Answer:
    """Return the rows of one design's swings, of a period of the slowest small swing at rest."""
    period = 1.0 / float(answer_modes(problem, SplineSettings(control_points=6), count=1).frequency[0])
    let_go = partial(answer_release, problem, duration=PERIODS * period)
    exact, check = (
        let_go(SplineSettings(control_points=n), integrator="leapfrog", step=period / STEPS_A_PERIOD)
        for n in (SWING_REFERENCE, SWING_CHECK)
    )
    ask = partial(let_go, SplineSettings(control_points=FIRST))
    rows = _rows({"problem": "motion", **design}, SWING_ACCURACIES, ask, _swing_errors, exact, check)
    return {"estimates": rows}


def _rows(
    design: Row, accuracies: Iterable[float], ask: Callable[..., Any], errors: Any, exact: Any, check: Any
) -> Iterator[Row]:
    """Yield the rows that hold estimates against true errors: a row an accuracy and quantity."""
    uncertainty = errors(check, exact)
    for accuracy in accuracies:
        answer = ask(accuracy=accuracy)
        estimate = answer.estimate or {}
        for quantity, error in errors(answer, exact).items():
            estimated = estimate.get(quantity, math.nan)
            yield {
                **design,
                "accuracy": accuracy,
                "quantity": quantity,
                "unit": "rad" if quantity == "rotation" else "1",
                "status": answer.status,
                "control_points": estimate.get("control_points", 0),
                "estimate": estimated,
                "true_error": error,
                "uncertainty": uncertainty[quantity],
                "effectivity": estimated / error,
                "counts": bool(error >= MARGIN * uncertainty[quantity]),
            }


def _path_errors(answer: Response, exact: Response) -> dict[str, float]:
    """Return the largest errors of a path over travel and peak torque and stress [1]; NaN for one that
    stopped."""
    apart = differences(answer, exact, ("path", "torque", "stress")).values()
    whole = len(answer.rotation) == len(exact.rotation)
    names = ("trajectory", "torque", "stress")
    return {name: float(each or 0.0) if whole else math.nan for name, each in zip(names, apart, strict=True)}


def _swing_errors(motion: Motion, exact: Motion) -> dict[str, float]:
    """Return the largest error of the rotation at the motion's instants [rad]; NaN for one that stopped."""
    whole = motion.converged and exact.converged
    return {"rotation": rotation_error(motion, exact, motion.time) if whole else math.nan}


def _timed(accuracy: float) -> Row:
    """Return what a search costs over the plain path with the control points that it chose."""
    searched = answer_static(named_case(), SplineSettings(control_points=FIRST), accuracy=accuracy, repeat=9)
    chosen = (searched.estimate or {})["control_points"]
    plain = answer_static(named_case(), SplineSettings(control_points=chosen), repeat=9)
    return {
        "accuracy": accuracy,
        "control_points": chosen,
        "search_wall_s": searched.wall_s,
        "path_wall_s": plain.wall_s,
        "time_ratio": searched.wall_s / plain.wall_s,
    }


def _of_problems(tables: Tables) -> Iterator[Row]:
    """Yield, for statics, for motion, and for the largest stress in statics, how good the estimates are."""
    stress = tables["stress"]
    known = stress[stress["uncertainty"] <= stress["accuracy"]]
    for problem, every in (*tables["estimates"].groupby("problem"), ("largest stress", known)):
        these = every[every["counts"]]
        by_design = these.groupby(["design", "accuracy"])["effectivity"]
        yield {
            "problem": problem,
            "estimates": len(these),
            "designs": these["design"].nunique(),
            "inside": ((by_design.min() >= BAND[0]) & (by_design.max() <= BAND[1])).mean(),
            "least": these["effectivity"].min(),
            "met": (every["true_error"] <= every["accuracy"]).mean(),
        }


_judged = partial(
    Claim, formulation="{problem}, {estimates} estimates of {designs} designs", rows=_of_problems
)

#: Errors of a few units of round-off, and so which of them count, differ between processors.
DIGITS: dict[str, Digits | None] = {
    "counts": Digits(rows="true_error > 1e-11"),
    "effectivity": Digits(relative=1e-2, rows="true_error > 1e-9"),
    **dict.fromkeys(("stress.true_error", "stress.uncertainty"), Digits(floor=1e-11)),
    "findings.formulation": None,
    "findings.value": Digits(relative=0.05),
}

STUDY = Study(
    parts=(
        Part(at=lambda: _drawn(BOUNDS, DESIGNS), ask=_static),
        Part(at=lambda: _drawn(SWING_BOUNDS, SWINGS), ask=_swings),
        Part(at=lambda: ACCURACIES, ask=lambda each: {"timings": _timed(each)}, alone=True),
    ),
    claims=(
        _judged(
            claim=f"Estimates lie within {BAND[0]:g} to {BAND[1]:g} times the true error for {SHARE:.0%}",
            quantity="the share of designs and accuracies whose estimates all do",
            value="inside",
            least=SHARE,
        ),
        _judged(
            claim="No estimate is optimistic by more than three times",
            quantity="the least estimate over its true error",
            value="least",
            least=LEAST,
        ),
        _judged(
            claim="The true error is below what was asked for",
            quantity="the share of errors that are",
            value="met",
            least=1.0,
        ),
    ),
    digits=DIGITS,
)
