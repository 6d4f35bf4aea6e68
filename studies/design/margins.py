"""What a sized design keeps: as plates with roots, which planar beams leave out, and at usual tolerances.

The gradients by which tolerances are followed are those of the sizing. Every state of the range, and every
fibre, is followed by its own, so that the largest value may pass from one to another, as it does at an
optimum. Whole solves at the ends of every tolerance, and of all together in the corner that is worst for a
quantity, check them; they tell more only of a centre shift that nearly vanishes, whose change across itself
is of second order.
"""

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd

from studies.cases.problem import Problem
from studies.design import evaluate
from studies.design.evaluate import CENTRE_SHIFT, STRESS, VARIABLES, VARIATION, Answers, Measured
from studies.design.optimise import Outcome, best, search
from studies.design.task import OBJECTIVES, UNITS, Task, variables_of, varied
from studies.effects.beyond import ALL, SECTIONS, relative_change, with_sections
from studies.engine import Claim, Tables
from studies.kinds import Array
from studies.record.progress import silent

#: Starts of a search with the effects, beside the former optimum.
MORE = 2


def off(name: str, problem: Problem, found: Answers) -> list[dict[str, Any]]:
    """Return what a design answers with each effect and with all; of stiffness and stress the change."""
    own, rows = found.measured().quantities(), []
    for effect, names in {**{each: (each,) for each in SECTIONS}, ALL: SECTIONS}.items():
        measured = _with(problem, names).quantities()
        rows.append(
            {
                "design": name,
                "effect": effect,
                **{key: relative_change(measured[key], own[key]) for key in ("stiffness", "stress")},
                "centre_shift_m": measured[CENTRE_SHIFT],
                "variation": measured[VARIATION],
                "over_plain": measured[VARIATION] / own[VARIATION],
            }
        )
    return rows


def resized(name: str, task: Task, former: Outcome) -> dict[str, Any]:
    """Return the optimum of a question with all effects assembled, beside the former one with them.

    `former_...` are the former design's stiffness over the wanted one and stress over the allowable one, less
    one, and its objective with the effects; `error` the largest difference of the new one to the elements.
    """
    there = _with(former.problem, SECTIONS).quantities()
    new = replace(task, start=with_sections(task.start))
    found = best(search(new, np.vstack((former.at[:-1], new.starts(MORE))), silent))
    row = {
        "question": name,
        "former_stiffness": relative_change(there["stiffness"], task.stiffness),
        "former_stress": relative_change(there["stress"], task.allowable_stress),
        "former_objective": there[task.objective],
    }
    if found is None:
        return {**row, "status": "none found"}
    measured, elements = new.quantities(found.answers), new.by_elements(found.problem)
    return {
        **row,
        "status": "optimum",
        **dict(zip(UNITS, variables_of(found.problem), strict=True)),
        "objective": found.objective,
        "error": max(abs(measured[key] / elements[key] - 1.0) for key in measured),
    }


def _with(problem: Problem, names: tuple[str, ...]) -> Measured:
    return evaluate.answers(with_sections(problem, names)).measured()


def _judged(tables: Tables) -> pd.DataFrame:
    rows = tables["sections"]
    return rows[rows["effect"] == ALL]


#: Usual tolerances: of lengths [m], angles [rad], and of a rolled thickness [m] or one by its grade [1].
LENGTH, ANGLE, ROLLED, GRADE = 0.05e-3, math.radians(0.1), 5e-6, 0.01
#: What begins the name of all of them together, and those that claims are held against.
TOGETHER, JUDGED = "all, ", "all, thickness 1 %"


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
    return alone | {f"{TOGETHER}{name}": others + alone[name] for name in thickness}


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
    ends = (evaluate.answers(varied(problem, variables_of(problem) + side * change)) for side in (1.0, -1.0))
    growth = [float(np.abs(_rows(end)[quantity][0]).max()) / own - 1.0 for end in ends]
    return max(map(abs, growth)) if quantity == "stiffness" else max(growth)


def _all_of(quantity: str) -> Any:
    def rows(tables: Tables) -> Any:
        found = tables["tolerances"]
        return found[(found["quantity"] == quantity) & (found["dimension"] == JUDGED)]

    return rows


CLAIMS = (
    *(
        Claim(
            claim=f"A design as planar beams keeps its {quantity} within 1 % in three dimensions",
            formulation="{design}, plates with roots in one block",
            quantity=f"the change of its {quantity}",
            rows=_judged,
            value=quantity,
            least=-0.01,
            most=0.01,
        )
        for quantity in ("stiffness", "stress")
    ),
    Claim(
        claim="A design as planar beams keeps its variation of stiffness within a tenth in three dimensions",
        formulation="{design}, plates with roots in one block",
        quantity="its variation of stiffness over that as planar beams",
        rows=_judged,
        value="over_plain",
        least=0.9,
        most=1.1,
        ratio=True,
    ),
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
            ratio=True,
        )
        for name, words in ((each, each.replace("-", " ")) for each in OBJECTIVES)
    ),
)
