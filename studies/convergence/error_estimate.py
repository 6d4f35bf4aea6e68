"""How well the spline model estimates its own error when it is asked for an accuracy.

Designs from slender to thick, with the crossing from one end to the other, turned by 20 to 120 degrees, are
solved to accuracies of 1e-2 to 1e-7. The true error is that against many more control points. The effectivity
is the estimate over the true error: below one it is optimistic. The largest stress converges more slowly than
path and torque, and its estimate is of the stress in each state; it is judged apart.
"""

import math
from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
from scipy.stats import qmc

from studies.answers.adapters import answer_static
from studies.answers.metrics import differences
from studies.answers.response import Response
from studies.answers.settings import SplineSettings
from studies.cases.problem import Problem, named_case
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

#: The band an effectivity should lie in, the share of designs that must, and the least of any.
BAND, SHARE, LEAST = (0.3, 10.0), 0.9, 1.0 / 3.0
#: A true error counts if that of its reference is this many times smaller.
MARGIN = 10.0


def _drawn() -> Iterator[tuple[Row, Problem]]:
    """Yield pivots like Table 1 whose values fill `BOUNDS` evenly: a Latin hypercube; with the columns that
    say which design it is. The slenderness is drawn evenly in its logarithm."""
    given = named_case()
    low, high = np.array([*BOUNDS.values()]).T
    low[0], high[0] = math.log(low[0]), math.log(high[0])
    points = qmc.scale(qmc.LatinHypercube(d=len(BOUNDS), seed=SEED).random(DESIGNS), low, high)
    width = given.area / given.depth
    for number, (logarithm, *others) in enumerate(points):
        depth = given.length / math.exp(logarithm)
        values: dict[str, Any] = dict(zip([*BOUNDS][1:], map(float, others), strict=True))
        problem = replace(given, width=width, thickness=depth, **values)
        identity = {"design": number, "slenderness": problem.length / problem.depth}
        identity |= {"crossing_ratio": problem.crossing_ratio, "inclination_rad": problem.inclination}
        yield identity | {"rotation_rad": problem.rotation}, problem


def _held(design: Row, problem: Problem) -> Answer:
    """Return estimates against true errors, a row an accuracy and quantity, those of the stress apart."""
    exact, check = (answer_static(problem, SplineSettings(control_points=n)) for n in (REFERENCE, CHECK))
    uncertainty, rows = _errors(check, exact), []
    for accuracy in ACCURACIES:
        answer = answer_static(problem, SplineSettings(control_points=FIRST), accuracy=accuracy)
        estimate = answer.estimate or {}
        for quantity, error in _errors(answer, exact).items():
            estimated = estimate.get(quantity, math.nan)
            rows.append(
                {
                    "problem": "statics",
                    **design,
                    "accuracy": accuracy,
                    "quantity": quantity,
                    "unit": "1",
                    "status": answer.status,
                    "control_points": estimate.get("control_points", 0),
                    "estimate": estimated,
                    "true_error": error,
                    "uncertainty": uncertainty[quantity],
                    "effectivity": estimated / error,
                    "counts": bool(error >= MARGIN * uncertainty[quantity]),
                }
            )
    stress = [row for row in rows if row["quantity"] == "stress"]
    return {"estimates": [row for row in rows if row["quantity"] != "stress"], "stress": stress}


def _errors(answer: Response, exact: Response) -> dict[str, float]:
    """Return the largest errors of a path over travel and peak torque and stress [1]; NaN for one that
    stopped."""
    apart = differences(answer, exact, ("path", "torque", "stress")).values()
    whole = len(answer.rotation) == len(exact.rotation)
    names = ("trajectory", "torque", "stress")
    return {name: float(each or 0.0) if whole else math.nan for name, each in zip(names, apart, strict=True)}


def _of_problems(tables: Tables) -> Iterator[Row]:
    """Yield, for path and torque, and for the largest stress, how good the estimates are."""
    stress = tables["stress"]
    known = stress[stress["uncertainty"] <= stress["accuracy"]]
    for problem, every in (("statics", tables["estimates"]), ("largest stress", known)):
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
    parts=(Part(at=_drawn, ask=_held),),
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
