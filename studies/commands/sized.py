"""The answer of `size`: what is asked in words, the optimum as JSON, and the table to read."""

import math
from collections.abc import Iterator
from typing import Any

from studies.cases.problem import Problem
from studies.design.evaluate import Measured, answers, of_spline
from studies.design.optimise import Outcome, numbered
from studies.design.task import PLAIN, VARIABLES, Task, variables_of

#: What the table calls the quantities, with the factor to the unit it shows them in.
SHOWN = {
    "centre-shift": ("centre shift [mm]", 1e3),
    "stiffness-variation": ("variation of stiffness [%]", 1e2),
    "stiffness": ("stiffness [N m / rad]", 1.0),
    "stress": ("stress [MPa]", 1e-6),
}
#: What the JSON calls them.
KEYS = {
    "centre-shift": "largest_centre_shift_m",
    "stiffness-variation": "stiffness_variation",
    "stiffness": "stiffness_Nm_per_rad",
    "stress": "max_stress_Pa",
}
DIMENSIONS = ("length_m", "inclination_deg", "crossing_ratio", "thickness_m", "width_m")


def as_document(
    task: Task, outcomes: list[Outcome], found: Outcome | None, checked: Measured | None
) -> dict[str, Any]:
    """Return the answer as the JSON object of the command."""
    optimum = None
    if found is not None and checked is not None:
        optimum = {
            **_dimensions(found.problem),
            "area_m2": found.problem.area,
            "second_moment_m4": found.problem.second_moment_of_area,
            "spline": _named(of_spline(found.answers)),
            "finite_elements": _named(checked),
            "active": [{"constraint": each.name, "price": each.price} for each in found.active],
        }
    return {
        "objective": task.objective,
        "stiffness_Nm_per_rad": task.stiffness,
        "allowable_stress_Pa": task.allowable_stress,
        "bounds": {name: list(task.bounds[name]) for name in VARIABLES},
        "case": _named(of_spline(answers(task.start))),
        "optimum": optimum,
        "starts": [
            {
                "optimum": number,
                "objective": each.objective,
                "violation": each.violation,
                "kkt_residual": each.residual,
                "paths_solved": each.solved,
                "message": each.message,
                **_dimensions(each.problem),
            }
            for number, each in zip(numbered(outcomes), outcomes, strict=True)
        ],
    }


def question(task: Task) -> tuple[str, str]:
    """Return what is asked, in two lines."""
    degrees = abs(math.degrees(task.start.rotation))
    loads = [name for name in task.start.effects.names if name not in PLAIN]
    return (
        f"least {task.objective.replace('-', ' ')} over +-{degrees:.4g} deg"
        + (f" under {', '.join(loads)}" if loads else ""),
        f"at {task.stiffness:.6g} N m/rad and at most {task.allowable_stress / 1e6:.6g} MPa",
    )


def _named(measured: Measured) -> dict[str, float]:
    return {KEYS[name]: value for name, value in measured.quantities().items()}


def _dimensions(problem: Problem) -> dict[str, float]:
    values = dict(zip(DIMENSIONS, map(float, variables_of(problem)), strict=True))
    return values | {"inclination_deg": math.degrees(problem.inclination)}


def readable(
    task: Task, outcomes: list[Outcome], found: Outcome | None, checked: Measured | None
) -> Iterator[str]:
    """Yield the lines of a table: case, optimum and finite elements, what holds it back, and the starts."""
    own = of_spline(answers(task.start)).quantities()
    yield from question(task)
    if found is not None and checked is not None:
        yield from _comparison(task, own, found, checked)
    yield ""
    yield f"{'start':>5} {'optimum':>8} {'over case':>10} {'paths':>6}  {_heading()}"
    for i, (number, each) in enumerate(zip(numbered(outcomes), outcomes, strict=True)):
        share = each.objective / own[task.objective]
        line = f"{i:>5} {number or '-':>8} {share:10.4f} {each.solved:>6}  {_line(each.problem)}"
        yield f"{line}  {each.message}".rstrip()


def _comparison(task: Task, own: dict[str, float], found: Outcome, checked: Measured) -> Iterator[str]:
    spline, fe = of_spline(found.answers).quantities(), checked.quantities()
    yield ""
    yield f"{'':<28}{'case':>12}{'sized':>12}{'in FE':>12}"
    for key, (label, factor) in SHOWN.items():
        yield f"{label:<28}{factor * own[key]:12.5g}{factor * spline[key]:12.5g}{factor * fe[key]:12.5g}"
    yield f"{own[task.objective] / spline[task.objective]:.4g} times less than the case's"
    yield ""
    yield f"{'':<10}{_heading()}"
    yield f"{'case':<10}{_line(task.start)}"
    yield f"{'sized':<10}{_line(found.problem)}"
    yield ""
    active = (f"{each.name.replace('_', ' ')} ({each.price:+.2g})" for each in found.active)
    yield f"held back by, with prices: {', '.join(active)}"
    held = [name.replace("_", " ") for name, span in zip(VARIABLES, task.span, strict=True) if span == 0.0]
    if held:
        yield f"held as asked: {', '.join(held)}"


def _heading() -> str:
    return f"{'L mm':>9}{'incl. deg':>11}{'crossing':>10}{'h mm':>9}{'b mm':>9}"


def _line(problem: Problem) -> str:
    length, _, ratio, thickness, width = variables_of(problem)
    inclination = math.degrees(problem.inclination)
    return f"{1e3 * length:9.3f}{inclination:11.3f}{ratio:10.4f}{1e3 * thickness:9.4f}{1e3 * width:9.3f}"
