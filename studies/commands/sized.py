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
from studies.commands.columns import cell
from studies.design.evaluate import PLAIN, Accurate, by_elements
from studies.design.optimise import SAME, Outcome, numbered, settled
from studies.design.question import Question
from studies.errors import BadInput

#: Quantity -> what the JSON calls it, what the table does, and the factor to the unit that this shows.
SHOWN = {
    "centre-shift": ("largest_centre_shift_m", "centre shift [mm]", 1e3),
    "stiffness-variation": ("stiffness_variation", "variation of stiffness [%]", 1e2),
    "stiffness": ("stiffness_Nm_per_rad", "stiffness [N m / rad]", 1.0),
    "travel": ("travel_m", "travel [mm]", 1e3),
    "stress": ("max_stress_Pa", "stress [MPa]", 1e-6),
}


@dataclass(frozen=True, kw_only=True)
class Optimum:
    """The best design of a search, its answer to the accuracy of `solve`, and that of the finite elements.

    If the finite elements have no answer, the reason takes its place.
    """

    outcome: Outcome
    answers: Accurate
    path: Response
    elements: Mapping[str, float]
    no_elements: str = ""

    @classmethod
    def of(cls, asked: Question, found: Outcome) -> Self:
        """Return an optimum with all that is said of it."""
        found, answers = settled(asked, found)
        path, reason = answer_static(found.design, SplineSettings()), ""
        try:
            elements = by_elements(found.design).quantities(asked.quantities)
        except (NoReference, BadInput) as error:
            elements, reason = dict.fromkeys(asked.quantities, math.nan), str(error)
        return cls(outcome=found, answers=answers, path=path, elements=elements, no_elements=reason)

    def document(self, asked: Question) -> dict[str, Any]:
        """Return it as a JSON object."""
        design, active = self.outcome.design, self.outcome.active
        section = {}
        if isinstance(design, Problem):
            section = {"area_m2": design.area, "second_moment_m4": design.second_moment_of_area}
        return {
            **asked.dimensions(asked.values(self.outcome.at)),
            **section,
            "spline": _named(self.answers.quantities),
            "estimated_error": _named(self.answers.errors),
            "control_points": self.answers.control_points,
            "finite_elements": _named(self.elements),
            "validity": asdict(validity(self.path)),
            "active": [{"constraint": each.name, "price": each.price} for each in active],
        }


def as_document(
    asked: Question, own: Accurate, outcomes: list[Outcome], found: Optimum | None
) -> dict[str, Any]:
    """Return the answer as the JSON object of the command; own: the case's answers."""
    starts = [
        {
            "optimum": number,
            "objective": each.objective,
            "violation": each.violation,
            "kkt_residual": each.residual,
            "paths_solved": each.solved,
            "message": _ended(number, each),
            **asked.dimensions(asked.values(each.at)),
        }
        for number, each in zip(numbered(outcomes), outcomes, strict=True)
    ]
    return {
        "objective": asked.objective,
        SHOWN[asked.held][0]: asked.wanted,
        "allowable_stress_Pa": asked.allowable_stress,
        "bounds": {each.name: [each.low, each.high] for each in asked.variables},
        "case": _named(own.quantities),
        "optimum": found.document(asked) if found is not None else None,
        "starts": starts,
    }


def question(asked: Question) -> tuple[str, str]:
    """Return what is asked, in two lines: the range of a pivot is to both sides."""
    names, rotation = asked.start.effects.names, asked.start.rotation
    least = f"least {asked.objective.replace('-', ' ')}"
    if rotation is not None:
        degrees = math.degrees(rotation)
        both = isinstance(asked.start, Problem)
        least += f" over +-{abs(degrees):.4g} deg" if both else f" over {degrees:.4g} deg"
    if loads := [name for name in names if name not in PLAIN]:
        least += f" under {', '.join(loads)}"
    if taken := [name.replace("_", " ") for name in OF_SIDES if name in names]:
        least += f" with {', '.join(taken)}"
    wanted = f"{asked.wanted:.6g} N m/rad"
    if asked.held == "travel":
        wanted = f"a travel of {1e3 * asked.wanted:.6g} mm"
    return least, f"at {wanted} and at most {asked.allowable_stress / 1e6:.6g} MPa"


def _named(measured: Mapping[str, float]) -> dict[str, float]:
    return {SHOWN[name][0]: value for name, value in measured.items()}


def readable(asked: Question, own: Accurate, outcomes: list[Outcome], found: Optimum | None) -> Iterator[str]:
    """Yield the lines of a table: case, optimum and finite elements, what holds it back, and the starts."""
    yield from question(asked)
    heading = "".join(f"{each.heading:>{each.form.partition('.')[0]}}" for each in asked.variables)
    if found is not None:
        yield ""
        yield from _comparison(asked, own.quantities, found)
        yield ""
        if not isinstance(asked.start, Problem):
            yield from (f"{each.heading:>5}: {each.name}" for each in asked.variables)
        yield f"{'':<10}{heading}"
        yield f"{'case':<10}{_line(asked, asked.own)}"
        yield f"{'sized':<10}{_line(asked, asked.values(found.outcome.at))}"
        yield ""
        active = ", ".join(f"{_said(each.name)} ({each.price:+.2g})" for each in found.outcome.active)
        yield f"held back by, with prices: {active or 'nothing'}"
        if held := [_said(each.name) for each in asked.variables if each.span == 0.0]:
            yield f"held as asked: {', '.join(held)}"
    yield ""
    yield f"{'start':>5} {'optimum':>8} {'over case':>10} {'paths':>6}  {heading}"
    for i, (number, each) in enumerate(zip(numbered(outcomes), outcomes, strict=True)):
        share = cell(each.objective / own.quantities[asked.objective], 10, ".4f")
        begun = f"{i:>5} {number or '-':>8} {share} {each.solved:>6}"
        yield f"{begun}  {_line(asked, asked.values(each.at))}  {_ended(number, each)}"


def _ended(number: int, outcome: Outcome) -> str:
    """Return where a start led, in words."""
    return outcome.message or ("the least" if number == 1 else "an optimum, not the least")


def _comparison(asked: Question, case: Mapping[str, float], found: Optimum) -> Iterator[str]:
    """Yield what case and optimum answer, how sure that is, and what `solve` says of the optimum."""
    spline, errors = found.answers.quantities, found.answers.errors
    yield f"{'':<28}{'case':>12}{'sized':>12}{'in FE':>12}"
    for key, (_, label, factor) in SHOWN.items():
        if key in case:
            columns = (factor * each[key] for each in (case, spline, found.elements))
            yield f"{label:<28}" + "".join(cell(value, 12, ".5g") for value in columns)
    if found.no_elements:
        yield f"the finite elements have no answer: {found.no_elements}"
    yield _gain(case[asked.objective] / spline[asked.objective])
    points = f"{found.answers.control_points} control points"
    told = (f"{name} {e:.1e}" if math.isfinite(e) else f"{name} not estimated" for name, e in errors.items())
    yield f"estimated error of the splines, sized, {points}: {', '.join(told)}"
    if missed := [name for name, error in errors.items() if error > DEFAULT]:
        yield f"the accuracy of {DEFAULT:g} is not reached by: {', '.join(missed)}"
    yield from (f"warning: {each}" for each in validity(found.path).outside)
    if found.path.message:
        yield found.path.message


def _gain(times: float) -> str:
    """Return in words how much less the objective is, which the case has so many times."""
    if math.isnan(times):
        return "the case itself has no answer over the range"
    if abs(times - 1.0) < SAME:
        return "as much as the case's, which is an optimum already"
    if times > 1.0:
        return f"{times:.4g} times less than the case's"
    return f"{1.0 / times:.4g} times the case's, which does not meet what is asked"


def _said(name: str) -> str:
    """Return the name of a constraint as it is read: keys of a file, with dots, stand as they are."""
    return name if "." in name else name.replace("_", " ")


def _line(asked: Question, values: Any) -> str:
    columns = zip(asked.variables, values, strict=True)
    return "".join(f"{each.factor * value:{each.form}}" for each, value in columns)
