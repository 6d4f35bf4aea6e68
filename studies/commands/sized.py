"""The answer of `size`: what is asked in words, the optimum as JSON, and the table to read."""

import math
from collections.abc import Iterator
from typing import Any

from spline_model.accuracy import DEFAULT
from studies.cases.effects import OF_SIDES
from studies.cases.problem import Problem
from studies.design.evaluate import PLAIN
from studies.design.numbers import NumbersTask
from studies.design.optimise import Outcome, numbered
from studies.design.task import Sizing, Task, variables_of

#: Quantity -> what the JSON calls it, what the table does, and the factor to the unit that this shows.
SHOWN = {
    "centre-shift": ("largest_centre_shift_m", "centre shift [mm]", 1e3),
    "stiffness-variation": ("stiffness_variation", "variation of stiffness [%]", 1e2),
    "stiffness": ("stiffness_Nm_per_rad", "stiffness [N m / rad]", 1.0),
    "travel": ("travel_m", "travel [mm]", 1e3),
    "stress": ("max_stress_Pa", "stress [MPa]", 1e-6),
}
DIMENSIONS = ("length_m", "inclination_deg", "crossing_ratio", "thickness_m", "width_m")


Quantities = dict[str, float]


def as_document(
    task: Sizing, outcomes: list[Outcome], found: Outcome | None, checked: Quantities | None
) -> dict[str, Any]:
    """Return the answer as the JSON object of the command."""
    optimum = None
    if found is not None and checked is not None:
        optimum = {
            **_dimensions(task, found),
            **_section(found.problem),
            "spline": _named(task.quantities(found.answers)),
            "estimated_error": _named(task.errors(task.values(found.at), found.answers)),
            "finite_elements": _named(checked),
            "active": [{"constraint": each.name, "price": each.price} for each in found.active],
        }
    return {
        "objective": task.objective,
        SHOWN[task.held][0]: task.stiffness,
        "allowable_stress_Pa": task.allowable_stress,
        "bounds": {name: list(task.bounds[name]) for name in task.variables},
        "case": _named(task.quantities(task.case())),
        "optimum": optimum,
        "starts": [
            {
                "optimum": number,
                "objective": each.objective,
                "violation": each.violation,
                "kkt_residual": each.residual,
                "paths_solved": each.solved,
                "message": each.message,
                **_dimensions(task, each),
            }
            for number, each in zip(numbered(outcomes), outcomes, strict=True)
        ],
    }


def question(task: Sizing) -> tuple[str, str]:
    """Return what is asked, in two lines."""
    names, rotation = task.start.effects.names, task.start.rotation
    loads = [name for name in names if name not in PLAIN]
    taken = [name.replace("_", " ") for name in OF_SIDES if name in names]
    degrees = (
        "" if rotation is None else f" over {'+-' * isinstance(task, Task)}{math.degrees(rotation):.4g} deg"
    )
    wanted = f"{task.stiffness:.6g} N m/rad"
    if task.held == "travel":
        wanted = f"a travel of {1e3 * task.stiffness:.6g} mm"
    return (
        f"least {task.objective.replace('-', ' ')}{degrees}"
        + (f" under {', '.join(loads)}" if loads else "")
        + (f" with {', '.join(taken)}" if taken else ""),
        f"at {wanted} and at most {task.allowable_stress / 1e6:.6g} MPa",
    )


def _named(measured: Quantities) -> dict[str, float]:
    return {SHOWN[name][0]: value for name, value in measured.items()}


def _dimensions(task: Sizing, found: Outcome) -> dict[str, Any]:
    """Return the dimensions of a pivot, or the numbers of a mechanism in the file's units."""
    if isinstance(task, NumbersTask):
        return {"numbers": dict(zip(task.variables, map(float, task.values(found.at)), strict=True))}
    values = dict(zip(DIMENSIONS, map(float, variables_of(found.problem)), strict=True))
    return values | {"inclination_deg": math.degrees(found.problem.inclination)}


def _section(design: Any) -> dict[str, float]:
    """Return the section of a pivot as case files have it."""
    if not isinstance(design, Problem):
        return {}
    return {"area_m2": design.area, "second_moment_m4": design.second_moment_of_area}


def readable(
    task: Sizing, outcomes: list[Outcome], found: Outcome | None, checked: Quantities | None
) -> Iterator[str]:
    """Yield the lines of a table: case, optimum and finite elements, what holds it back, and the starts."""
    case = task.quantities(task.case())
    yield from question(task)
    if found is not None and checked is not None:
        yield from _comparison(task, case, found, checked)
    yield ""
    yield f"{'start':>5} {'optimum':>8} {'over case':>10} {'paths':>6}  {_heading(task)}"
    for i, (number, each) in enumerate(zip(numbered(outcomes), outcomes, strict=True)):
        share = each.objective / case[task.objective]
        line = (
            f"{i:>5} {number or '-':>8} {share:10.4f} {each.solved:>6}  {_line(task, task.values(each.at))}"
        )
        yield f"{line}  {each.message}".rstrip()


def _comparison(task: Sizing, case: Quantities, found: Outcome, fe: Quantities) -> Iterator[str]:
    spline = task.quantities(found.answers)
    yield ""
    yield f"{'':<28}{'case':>12}{'sized':>12}{'in FE':>12}"
    for key, (_, label, factor) in SHOWN.items():
        if key in case:
            yield f"{label:<28}{factor * case[key]:12.5g}{factor * spline[key]:12.5g}{factor * fe[key]:12.5g}"
    yield f"{case[task.objective] / spline[task.objective]:.4g} times less than the case's"
    errors = task.errors(task.values(found.at), found.answers)
    told = (
        f"{name} {error:.1e}" if math.isfinite(error) else f"{name} not estimated"
        for name, error in errors.items()
    )
    yield f"estimated error of the splines, sized: {', '.join(told)}"
    missed = [name for name, error in errors.items() if error > DEFAULT]
    if missed:
        yield f"the accuracy of {DEFAULT:g} is not reached by: {', '.join(missed)}"
    yield ""
    if isinstance(task, NumbersTask):
        yield from (f"{place:>5}: {name}" for place, name in enumerate(task.variables, start=1))
    yield f"{'':<10}{_heading(task)}"
    yield f"{'case':<10}{_line(task, task.own)}"
    yield f"{'sized':<10}{_line(task, task.values(found.at))}"
    yield ""
    active = (f"{_said(task, each.name)} ({each.price:+.2g})" for each in found.active)
    yield f"held back by, with prices: {', '.join(active)}"
    spans = zip(task.variables, task.span, strict=True)
    held = [_said(task, name) for name, span in spans if span == 0.0]
    if held:
        yield f"held as asked: {', '.join(held)}"


def _said(task: Sizing, name: str) -> str:
    """Return the name of a constraint as it is read: keys of a file stand as they are."""
    return name if isinstance(task, NumbersTask) else name.replace("_", " ")


def _heading(task: Sizing) -> str:
    return "".join(f"{head:>{form.partition('.')[0]}}" for head, _, form in task.columns)


def _line(task: Sizing, values: Any) -> str:
    columns = zip(task.columns, values, strict=True)
    return "".join(f"{factor * value:{form}}" for (_, factor, form), value in columns)
