"""What designs that were sized as planar beams are off by in three dimensions, and the same sized anew."""

from typing import Any

import numpy as np
import pandas as pd

from studies.cases.problem import Problem
from studies.design.evaluate import Answers, Measured, answers, by_elements, of_spline
from studies.design.optimise import Outcome, best, search, starts
from studies.design.task import CENTRE_SHIFT, UNITS, VARIATION, Task, variables_of
from studies.effects.beyond import ALL, SECTIONS, relative_change, with_sections
from studies.engine.study import Claim, Ratio, Tables
from studies.record.progress import silent

#: Starts of a search with the effects, beside the former optimum.
MORE = 2


def off(name: str, problem: Problem, found: Answers) -> list[dict[str, Any]]:
    """Return what a design answers with each effect and with all; of stiffness and stress the change."""
    own, rows = of_spline(found).quantities(), []
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
    new = task.begun_at(with_sections(task.start))
    found = best(search(new, np.vstack((former.at[:-1], starts(new, MORE))), silent))
    row = {
        "question": name,
        "former_stiffness": relative_change(there["stiffness"], task.stiffness),
        "former_stress": relative_change(there["stress"], task.allowable_stress),
        "former_objective": there[task.objective],
    }
    if found is None:
        return {**row, "status": "none found"}
    measured, elements = of_spline(found.answers).quantities(), by_elements(found.problem)[0].quantities()
    return {
        **row,
        "status": "optimum",
        **dict(zip(UNITS, variables_of(found.problem), strict=True)),
        "objective": found.objective,
        "error": max(abs(measured[key] / elements[key] - 1.0) for key in measured),
    }


def _with(problem: Problem, names: tuple[str, ...]) -> Measured:
    return of_spline(answers(with_sections(problem, names)))


def _judged(tables: Tables) -> pd.DataFrame:
    rows = tables["sections"]
    return rows[rows["effect"] == ALL]


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
        kind=Ratio,
    ),
)
