"""What manufacture does to a design: its quantities at the tolerances of its dimensions, to first order.

The gradients are those of the sizing. Every state of the range, and every fibre, is followed by its own, so
that the largest value may pass from one to another, as it does at an optimum. Whole solves at the ends of
every tolerance, and of all together in the corner that is worst for a quantity, check them; they tell more
only of a centre shift that nearly vanishes, whose change across itself is of second order.
"""

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from studies.cases.problem import Problem
from studies.design.evaluate import Answers, answers
from studies.design.task import CENTRE_SHIFT, OBJECTIVES, STRESS, VARIABLES, VARIATION, variables_of, varied
from studies.engine.study import Claim, Ratio, Tables
from studies.kinds import Array

#: Usual tolerances: of lengths [m], angles [rad], and of a rolled thickness [m] or one by its grade [1].
LENGTH, ANGLE, ROLLED, GRADE = 0.05e-3, math.radians(0.1), 5e-6, 0.01
#: What begins the name of all of them together, and those that claims are held against.
ALL, JUDGED = "all, ", "all, thickness 1 %"


def _tolerances_of(problem: Problem) -> dict[str, Array]:
    """Return the tolerances of the variables (5,), each alone and all together, by name: to either side."""
    depth = float(variables_of(problem)[VARIABLES.index("thickness")])
    sizes = {
        "length 0.05 mm": LENGTH,
        "inclination 0.1 deg": ANGLE,
        "crossing 0.05 mm": LENGTH / problem.length,
        "width 0.05 mm": LENGTH,
        "thickness 5 um": ROLLED,
        "thickness 1 %": GRADE * depth,
    }
    places = {
        name.partition("_")[0]: one for name, one in zip(VARIABLES, np.eye(len(VARIABLES)), strict=True)
    }
    alone = {name: size * places[name.partition(" ")[0]] for name, size in sizes.items()}
    thickness = [name for name in alone if name.startswith("thickness")]
    others = np.sum([each for name, each in alone.items() if name not in thickness], axis=0)
    return alone | {f"{ALL}{name}": others + alone[name] for name in thickness}


def toleranced(design: str, problem: Problem, found: Answers) -> Iterator[dict[str, Any]]:
    """Yield a row for every tolerance and quantity of a design.

    `worst` is the largest change by the gradients over the design's own value, `squares` that of the root of
    the squares, and `solved` the worst by whole solves: of the stiffness to either side, of the others their
    growth.
    """
    for name, sizes in _tolerances_of(problem).items():
        for quantity, (values, by) in _rows(found).items():
            own, parts = np.abs(values).max(), np.abs(by) * sizes
            grown = np.abs(values) + parts.sum(axis=1)
            rooted = np.abs(values) + np.linalg.norm(parts, axis=1)
            state = int(grown.argmax())
            towards = np.where(values[state] * by[state] < 0.0, -1.0, 1.0)
            yield {
                "design": design,
                "dimension": name,
                "quantity": quantity,
                "worst": float(grown[state] / own - 1.0),
                "squares": float(rooted.max() / own - 1.0),
                "solved": _solved(problem, quantity, float(own), towards * sizes),
            }


def _rows(found: Answers) -> dict[str, tuple[Array, Array]]:
    """Return the quantities over states or fibres (S,), and their gradients (S, 5)."""
    shift = np.sqrt(found.square_shift)
    return {
        "stiffness": (np.array([found.stiffness]), found.by_stiffness[None]),
        VARIATION: (found.variation, found.by_variation),
        STRESS: (found.stress, found.by_stress),
        CENTRE_SHIFT: (shift, found.by_square_shift / (2.0 * shift[:, None])),
    }


def _solved(problem: Problem, quantity: str, own: float, change: Array) -> float:
    """Return the largest growth of a quantity by whole solves at both ends of a change (5,) [1]."""
    ends = (answers(varied(problem, variables_of(problem) + side * change)) for side in (1.0, -1.0))
    growth = [float(np.abs(_rows(end)[quantity][0]).max()) / own - 1.0 for end in ends]
    return max(map(abs, growth)) if quantity == "stiffness" else max(growth)


def _all_of(quantity: str) -> Any:
    def rows(tables: Tables) -> Any:
        found = tables["tolerances"]
        return found[(found["quantity"] == quantity) & (found["dimension"] == JUDGED)]

    return rows


CLAIMS = (
    Claim(
        claim="At the usual tolerances a design keeps its stiffness within 5 %",
        formulation="{design}, at worst",
        quantity="the change of its stiffness",
        rows=_all_of("stiffness"),
        value="solved",
        most=0.05,
    ),
    *(
        Claim(
            claim=f"At the usual tolerances a design keeps its {words} within twice its own",
            formulation="{design}, at worst",
            quantity=f"its {words} over that as drawn",
            rows=_all_of(name),
            value=lambda row: 1.0 + row["solved"],
            most=2.0,
            kind=Ratio,
        )
        for name, words in ((each, each.replace("-", " ")) for each in OBJECTIVES)
    ),
)
