"""The answer of `size`: what is asked in words, the optimum as JSON, and the table to read."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass
from typing import Any, Self

from spline_model.accuracy import DEFAULT
from studies.answers.adapters import answer_static
from studies.answers.reference import NoReference
from studies.answers.response import Response
from studies.answers.settings import SplineSettings
from studies.answers.validity import validity
from studies.cases.effects import OF_SIDES
from studies.cases.problem import Problem
from studies.design.evaluate import PLAIN, Accurate, by_elements
from studies.design.optimise import SAME, Outcome, numbered, settled
from studies.design.question import PivotQuestion, Question, variables_of

#: Quantity -> what the JSON calls it, what the table does, and the factor to the unit that this shows.
SHOWN = {
    "centre-shift": ("largest_centre_shift_m", "centre shift [mm]", 1e3),
    "stiffness-variation": ("stiffness_variation", "variation of stiffness [%]", 1e2),
    "stiffness": ("stiffness_Nm_per_rad", "stiffness [N m / rad]", 1.0),
    "travel": ("travel_m", "travel [mm]", 1e3),
    "stress": ("max_stress_Pa", "stress [MPa]", 1e-6),
}
DIMENSIONS = ("length_m", "inclination_deg", "crossing_ratio", "thickness_m", "width_m")


Quantities = Mapping[str, float]


@dataclass(frozen=True, kw_only=True)
class Optimum:
    """The best design: where the search ended, what it answers to the accuracy, as `solve` does, and by the
    finite elements, or why they have no answer."""

    outcome: Outcome
    answers: Accurate
    path: Response
    elements: Quantities
    no_elements: str = ""

    @classmethod
    def of(cls, asked: Question, found: Outcome) -> Self:
        """Return an optimum with all that is said of it."""
        found, answers = settled(asked, found)
        path, reason = answer_static(found.design, SplineSettings()), ""
        try:
            elements: Quantities = by_elements(found.design).quantities(asked.quantities)
        except NoReference as error:
            elements, reason = dict.fromkeys(answers.quantities, math.nan), str(error)
        return cls(outcome=found, answers=answers, path=path, elements=elements, no_elements=reason)


def as_document(
    asked: Question, own: Accurate, outcomes: list[Outcome], found: Optimum | None
) -> dict[str, Any]:
    """Return the answer as the JSON object of the command; own: the case's answers."""
    optimum = None
    if found is not None:
        optimum = {
            **_dimensions(asked, found.outcome),
            **_section(found.outcome.design),
            "spline": _named(found.answers.quantities),
            "estimated_error": _named(found.answers.errors),
            "control_points": found.answers.control_points,
            "finite_elements": _named(found.elements),
            "validity": asdict(validity(found.path)),
            "active": [{"constraint": each.name, "price": each.price} for each in found.outcome.active],
        }
    return {
        "objective": asked.objective,
        SHOWN[asked.held][0]: asked.wanted,
        "allowable_stress_Pa": asked.allowable_stress,
        "bounds": {each.name: [each.low, each.high] for each in asked.variables},
        "case": _named(own.quantities),
        "optimum": optimum,
        "starts": [
            {
                "optimum": number,
                "objective": each.objective,
                "violation": each.violation,
                "kkt_residual": each.residual,
                "paths_solved": each.solved,
                "message": _ended(number, each),
                **_dimensions(asked, each),
            }
            for number, each in zip(numbered(outcomes), outcomes, strict=True)
        ],
    }


def question(asked: Question) -> tuple[str, str]:
    """Return what is asked, in two lines."""
    names, rotation = asked.start.effects.names, asked.start.rotation
    loads = [name for name in names if name not in PLAIN]
    taken = [name.replace("_", " ") for name in OF_SIDES if name in names]
    degrees = "" if rotation is None else f" over {_range(asked, math.degrees(rotation))} deg"
    wanted = f"{asked.wanted:.6g} N m/rad"
    if asked.held == "travel":
        wanted = f"a travel of {1e3 * asked.wanted:.6g} mm"
    return (
        f"least {asked.objective.replace('-', ' ')}{degrees}"
        + (f" under {', '.join(loads)}" if loads else "")
        + (f" with {', '.join(taken)}" if taken else ""),
        f"at {wanted} and at most {asked.allowable_stress / 1e6:.6g} MPa",
    )


def _range(asked: Question, degrees: float) -> str:
    """Return the range in words: of a pivot to both sides, of a mechanism to the one it turns to."""
    return f"+-{abs(degrees):.4g}" if isinstance(asked, PivotQuestion) else f"{degrees:.4g}"


def _named(measured: Quantities) -> dict[str, float]:
    return {SHOWN[name][0]: value for name, value in measured.items()}


def _dimensions(asked: Question, found: Outcome) -> dict[str, Any]:
    """Return the dimensions of a pivot, or the numbers of a mechanism in the file's units."""
    if not isinstance(found.design, Problem):
        return {"numbers": dict(zip(asked.names, map(float, asked.values(found.at)), strict=True))}
    values = dict(zip(DIMENSIONS, map(float, variables_of(found.design)), strict=True))
    return values | {"inclination_deg": math.degrees(found.design.inclination)}


def _section(design: Any) -> dict[str, float]:
    """Return the section of a pivot as case files have it."""
    if not isinstance(design, Problem):
        return {}
    return {"area_m2": design.area, "second_moment_m4": design.second_moment_of_area}


def readable(asked: Question, own: Accurate, outcomes: list[Outcome], found: Optimum | None) -> Iterator[str]:
    """Yield the lines of a table: case, optimum and finite elements, what holds it back, and the starts."""
    yield from question(asked)
    if found is not None:
        yield from _comparison(asked, own.quantities, found)
        yield from _remarks(found)
        yield from _dimensioned(asked, found.outcome)
    yield ""
    yield f"{'start':>5} {'optimum':>8} {'over case':>10} {'paths':>6}  {_heading(asked)}"
    for i, (number, each) in enumerate(zip(numbered(outcomes), outcomes, strict=True)):
        share = each.objective / own.quantities[asked.objective]
        begun = f"{i:>5} {number or '-':>8} {share:10.4f} {each.solved:>6}"
        line = f"{begun}  {_line(asked, asked.values(each.at))}  {_ended(number, each)}"
        yield line.replace(" nan ", " -   ")


def _ended(number: int, outcome: Outcome) -> str:
    """Return where a start led, in words."""
    return outcome.message or ("the least" if number == 1 else "an optimum, not the least")


def _comparison(asked: Question, case: Quantities, found: Optimum) -> Iterator[str]:
    """Yield what case and optimum answer, and how sure that is."""
    spline, errors = found.answers.quantities, found.answers.errors
    yield ""
    yield f"{'':<28}{'case':>12}{'sized':>12}{'in FE':>12}"
    for key, (_, label, factor) in SHOWN.items():
        if key in case:
            columns = (factor * each[key] for each in (case, spline, found.elements))
            told = (f"{value:12.5g}" if math.isfinite(value) else f"{'-':>12}" for value in columns)
            yield f"{label:<28}{''.join(told)}"
    if found.no_elements:
        yield f"the finite elements have no answer: {found.no_elements}"
    yield _gain(case[asked.objective] / spline[asked.objective])
    errs = ", ".join(
        f"{name} {error:.1e}" if math.isfinite(error) else f"{name} not estimated"
        for name, error in errors.items()
    )
    yield f"estimated error of the splines, sized, {found.answers.control_points} control points: {errs}"
    if missed := [name for name, error in errors.items() if error > DEFAULT]:
        yield f"the accuracy of {DEFAULT:g} is not reached by: {', '.join(missed)}"


def _gain(times: float) -> str:
    """Return in words how much less the objective is, which the case has so many times."""
    if math.isnan(times):
        return "the case itself has no answer over the range"
    if abs(times - 1.0) < SAME:
        return "as much as the case's, which is an optimum already"
    if times > 1.0:
        return f"{times:.4g} times less than the case's"
    return f"{1.0 / times:.4g} times the case's, which does not meet what is asked"


def _remarks(found: Optimum) -> Iterator[str]:
    """Yield what is to be said of the optimum, as `solve` does of its answer."""
    path = found.path
    yield from (f"beyond the model: {each}" for each in validity(path).outside)
    if path.message:
        yield path.message


def _dimensioned(asked: Question, found: Outcome) -> Iterator[str]:
    """Yield the dimensions of case and optimum, and what holds this back."""
    yield ""
    if not isinstance(asked, PivotQuestion):
        yield from (f"{each.heading:>5}: {each.name}" for each in asked.variables)
    yield f"{'':<10}{_heading(asked)}"
    yield f"{'case':<10}{_line(asked, asked.own)}"
    yield f"{'sized':<10}{_line(asked, asked.values(found.at))}"
    yield ""
    active = ", ".join(f"{_said(asked, each.name)} ({each.price:+.2g})" for each in found.active)
    yield f"held back by, with prices: {active or 'nothing'}"
    if held := [_said(asked, each.name) for each in asked.variables if each.span == 0.0]:
        yield f"held as asked: {', '.join(held)}"


def _said(asked: Question, name: str) -> str:
    """Return the name of a constraint as it is read: keys of a file stand as they are."""
    return name.replace("_", " ") if isinstance(asked, PivotQuestion) else name


def _heading(asked: Question) -> str:
    return "".join(f"{each.heading:>{each.form.partition('.')[0]}}" for each in asked.variables)


def _line(asked: Question, values: Any) -> str:
    columns = zip(asked.variables, values, strict=True)
    return "".join(f"{each.factor * value:{each.form}}" for each, value in columns)
