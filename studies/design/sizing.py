"""Two pivots sized: as beams, with plate effects and supports, sized again with them, and at tolerances.

Each question has four rows. *As beams* is the optimum of planar beams. *With effects* is the same design with
clamped widths, flattening and supports cut from one block. *Sized again* is the optimum with these effects.
*At tolerances* has the largest values of the first row's design over the usual tolerances of all dimensions
together, each value in the corner that is worst for it. The gradients give the corner, whole solves at both
ends the value.
"""

import math
from collections.abc import Mapping
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from studies.cases.design import document_of
from studies.cases.problem import named_case
from studies.design import evaluate
from studies.design.evaluate import CENTRE_SHIFT, STIFFNESS, STRESS, VARIATION, Answers, Followed
from studies.design.optimise import STARTS, Outcome, best, search
from studies.design.question import Question
from studies.effects.audit import with_sections
from studies.engine import Answer, Part, Row, Study, Tables
from studies.kinds import Array
from studies.record.panels import Axis, Curves, Panel, sheet
from studies.record.progress import silent
from studies.record.style import BLACK, BLUE, GREEN, ORANGE, Look

BEAMS, EFFECTS, AGAIN, TOLERANCES = "as beams", "with effects", "sized again", "at tolerances"
#: Column of each quantity.
COLUMNS = {
    "stiffness": "stiffness_Nm_per_rad",
    STRESS: "largest_stress_Pa",
    CENTRE_SHIFT: "centre_shift_m",
    VARIATION: "variation",
}
#: Starts of a search with the effects, beside the optimum of beams.
MORE = 2
#: Usual tolerances: of lengths [m], angles [deg], and of a thickness by its grade [1].
TOLERANCE, ANGLE, GRADE = 0.05e-3, 0.1, 0.01


#: What tables call the variables.
UNITS = ("length_m", "inclination_rad", "crossing_ratio", "thickness_m", "width_m")
#: Designs to compare with: their case, range to either side [deg], None for its own, and allowable stress
#: [Pa], None for its own at the end of the range. At its 90 degrees the stress of Table 1's pivot is above
#: 14 GPa; at 500 MPa a strip of hardened spring steel lasts under repeated bending, a choice.
TABLE_ONE, SPRING_STEEL = "Table 1", "spring steel"
BASELINES = {TABLE_ONE: ("cross_axis_pivot", 45.0, None), SPRING_STEEL: ("spring_steel_pivot", None, 500e6)}
#: Increments of the path to the end of the range.
INCREMENTS = 12
#: Questions: baseline, objective, largest width over length.
QUESTIONS = {
    "least centre shift": (TABLE_ONE, CENTRE_SHIFT, 1.0),
    "least variation of stiffness": (TABLE_ONE, VARIATION, 1.0),
    "least centre shift, narrow strips": (TABLE_ONE, CENTRE_SHIFT, 0.5),
    "least variation of stiffness, narrow strips": (TABLE_ONE, VARIATION, 0.5),
    "least centre shift, spring steel": (SPRING_STEEL, CENTRE_SHIFT, 1.0),
    "least variation of stiffness, spring steel": (SPRING_STEEL, VARIATION, 1.0),
}


@cache
def baseline(name: str = TABLE_ONE) -> Question:
    """Return the question about the design to compare with, at its own stiffness, over its range."""
    case, degrees, stress = BASELINES[name]
    given = named_case(case)
    rotation = given.rotation if degrees is None else math.radians(degrees)
    problem = replace(given, rotation=rotation, increments=INCREMENTS)
    question = Question.of(case, document_of(problem), objective=CENTRE_SHIFT)
    own = question.answers()
    allowable = stress or own.largest(STRESS)
    return replace(question, wanted=own.largest(STIFFNESS), allowable_stress=allowable)


def asked(name: str, objective: str, aspect: float) -> Question:
    """Return the question of a baseline; aspect: largest width over thickness."""
    question = baseline(name)
    slender, wide = question.ratios
    return replace(question, objective=objective, ratios=(slender, wide._replace(limit=aspect)))


def _with_effects(question: Question) -> Question:
    """Return the question about the same pivot with all effects of its sections."""
    start = with_sections(question.start)
    return replace(question, start=start, content=document_of(start))


def _of_question(name: str) -> Answer:
    """Return the rows of a question: those of its optimum as beams, and the optimum with all effects."""
    question, begun = asked(*QUESTIONS[name]), QUESTIONS[name][0]
    found = _optimum(name, question, question.starts(STARTS))
    new = _with_effects(question)
    again = _optimum(name, new, np.vstack((found.at[:-1], new.starts(MORE))))
    rows = _rows(name, begun, question, question.values(found.at))
    values = new.values(again.at)
    row = _row(name, begun, AGAIN, values, again.answers.quantities)
    return {"designs": [*rows, {**row, "error": error(new, values, again.answers)}]}


def _optimum(name: str, question: Question, starts: Array) -> Outcome:
    found = best(search(question, starts, silent))
    if found is None:
        raise RuntimeError(f"{name}: no start has led to an optimum")
    return found


def _rows(name: str, begun: str, question: Question, values: Array) -> list[Row]:
    """Return a design, variables (5,), as beams, with the effects and at tolerances."""
    found = question.answers(values)
    within = _with_effects(question).answers(values)
    return [
        {**_row(name, begun, BEAMS, values, found.quantities), "error": error(question, values, found)},
        _row(name, begun, EFFECTS, values, within.quantities),
        _row(name, begun, TOLERANCES, values, toleranced(question, values)),
    ]


def _row(name: str, begun: str, basis: str, values: Array, found: Mapping[str, float]) -> Row:
    sizes = dict(zip(UNITS, values, strict=True))
    sizes["inclination_rad"] = math.radians(sizes["inclination_rad"])
    answers = {column: found[quantity] for quantity, column in COLUMNS.items()}
    return {"design": name, "baseline": begun, "basis": basis, **sizes, **answers}


def error(question: Question, values: Array, found: Answers) -> float:
    """Return the largest difference of all quantities of a design to those of the finite elements,
    relative [1]."""
    elements = evaluate.by_elements(question.design(values))
    return max(abs(found.quantities[name] / elements[name] - 1.0) for name in question.quantities)


def sizes_of(values: Array) -> Array:
    """Return the tolerances (5,) of the variables (5,), in their units."""
    length, _, _, thickness, _ = values
    return np.array([TOLERANCE, ANGLE, TOLERANCE / length, GRADE * thickness, TOLERANCE])


def toleranced(question: Question, values: Array) -> dict[str, float]:
    """Return the largest value of each quantity, in its SI unit, at the usual tolerances of all dimensions.

    Every state of the range, and every fibre, has its own gradient, so that the largest value may move from
    one to another, as it does at an optimum.
    """
    sizes, largest = sizes_of(values), {}
    for quantity, (found, by) in _followed(question.answers(values)).items():
        state = int((np.abs(found) + np.abs(by) @ sizes).argmax())
        change = np.where(found[state] * by[state] < 0.0, -1.0, 1.0) * sizes
        ends = (question.answers(values + side * change) for side in (1.0, -1.0))
        largest[quantity] = max(float(np.abs(_followed(end)[quantity].value).max()) for end in ends)
    return largest


def _followed(found: Answers) -> dict[str, Followed]:
    """Return what is followed, the centre shift itself in place of its square."""
    square, by_square = found.followed[CENTRE_SHIFT]
    shift = np.sqrt(square)
    return {**found.followed, CENTRE_SHIFT: Followed(shift, by_square / (2.0 * shift[:, None]))}


LOOKS = {
    basis: Look(label=basis, colour=colour, line="", marker=marker, hollow=hollow)
    for basis, colour, marker, hollow in (
        (BEAMS, BLACK, "o", True),
        (EFFECTS, BLUE, "o", False),
        (AGAIN, GREEN, "D", False),
        (TOLERANCES, ORANGE, "|", False),
    )
}


def _figure(tables: Tables) -> Figure:
    """Draw both objectives of all designs, by what is taken into account."""
    curves: Any = (Curves(tables["designs"], LOOKS, by="basis", more={"markersize": 7.0}),)
    names = Axis("design", "", names=(*BASELINES, *QUESTIONS))
    panels = [
        Panel(Axis("centre_shift_m", "largest centre shift [mm]", factor=1e3, log=True), names, curves),
        Panel(Axis("variation", "largest variation of stiffness [%]", factor=100.0, log=True), names, curves),
    ]
    return sheet(7.5, 3.4, [panels], legend=4)


STUDY = Study(
    cases=tuple(case for case, *_ in BASELINES.values()),
    parts=(
        Part(
            at=lambda: BASELINES,
            ask=lambda name: {"designs": _rows(name, name, baseline(name), baseline(name).own)},
        ),
        Part(at=lambda: QUESTIONS, ask=_of_question),
    ),
    figures={"sizing": _figure},
)
