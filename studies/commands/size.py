"""Size a pivot: least centre shift or least variation of stiffness at given range, stiffness and stress.

    python -m studies size cross_axis_pivot --objective centre-shift --rotation-deg 45
    python -m studies size spring_steel_pivot --objective stiffness-variation --aspect 0.5

The case gives the material, the range to either side (its rotation) and the design to compare with; the
wanted stiffness at rest and the allowable stress at the end of the range are its own unless they are given.
Both strips are alike, with a rectangular section; they become neither thicker for their length than the
case's nor wider than --aspect times their length. Gradients are exact; several starts show local optima.
The optimum is solved once more by the finite elements in the limit of refinement. A price is the change of
the objective over that of a limit, in % over %. Exit code 0: an optimum was found; 2: bad input; 3: none was
found, and then the table of the starts says how near they came.
"""

import argparse
import math
from collections.abc import Callable, Iterator
from typing import Any

from studies.answers.reference import NoReference
from studies.cases.problem import Problem
from studies.commands.answer import deliver, not_converged, require_target
from studies.commands.arguments import CASE, JSON, ROTATION, option, turned_pivot
from studies.commands.parser import Argument, command, positive, whole_number
from studies.design.evaluate import Measured, PathEnds, answers, by_elements, of_spline
from studies.design.optimise import Outcome, best, numbered, search, starts
from studies.design.task import OBJECTIVES, VARIABLES, Room, Task, variables_of
from studies.errors import BadInput
from studies.record.progress import Bar

#: Variable -> option, its unit in SI, what the option must be below, and its bounds where it is not given.
BOUNDS: dict[str, tuple[str, float, float, str]] = {
    "length": ("length_mm", 1e-3, math.inf, "in mm, default 0.5 to 1 of the case's"),
    "inclination": ("inclination_deg", math.radians(1.0), 90.0, "in deg, default 20:70"),
    "crossing_ratio": ("crossing_ratio", 1.0, 1.0, "relative to the length, default 0.1:0.9"),
    "thickness": ("thickness_mm", 1e-3, math.inf, "in mm, default 0.1 to 1.6 of the case's"),
    "width": ("width_mm", 1e-3, math.inf, "in mm, default 0.2 of the case's to its length"),
}
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


def _interval(most: float) -> Callable[[str], tuple[float, float]]:
    """Return a parser of intervals LOW:HIGH within 0 and `most`."""

    def parse(text: str) -> tuple[float, float]:
        try:
            low, high = map(float, text.split(":"))
        except ValueError:
            low = high = math.nan
        if 0.0 < low < high < most:
            return low, high
        limit = "" if math.isinf(most) else f" < {most:g}"
        raise argparse.ArgumentTypeError(f"got {text}, expected LOW:HIGH with 0 < LOW < HIGH{limit}")

    return parse


@command(
    CASE,
    Argument("--objective", choices=list(OBJECTIVES), required=True, help="what is to be least"),
    ROTATION.but(help="range to either side, in deg (default: the case's)"),
    Argument("--stiffness", type=positive, metavar="K", help="at rest, in N m/rad (default: the case's own)"),
    Argument(
        "--max-stress-MPa", type=positive, metavar="S", help="allowable, in MPa (default: the case's own)"
    ),
    *(
        Argument(
            option(attribute),
            type=_interval(most),
            metavar="LOW:HIGH",
            help=f"bounds of the {name.replace('_', ' ')}, {said}",
        )
        for name, (attribute, _, most, said) in BOUNDS.items()
    ),
    Argument(
        "--aspect",
        type=positive,
        default=1.0,
        metavar="R",
        help="largest width, relative to the length, default 1",
    ),
    Argument(
        "--starts", type=whole_number(1), default=8, metavar="N", help="starts of the search, default 8"
    ),
    JSON,
)
def main(arguments: argparse.Namespace) -> int:
    """Search, check, report; return the exit code."""
    start = _start(arguments)
    require_target(arguments)
    try:
        task = _task(start, arguments)
        with Bar("size") as bar:
            outcomes = search(task, starts(task, arguments.starts), bar)
        found = best(outcomes)
        checked = None if found is None else by_elements(found.problem)[0]
    except (PathEnds, NoReference) as error:
        return not_converged(error)
    failure = _failure(outcomes) if found is None else None
    document = as_document(task, outcomes, found, checked)
    return deliver(arguments, document, _readable(task, outcomes, found, checked), failure=failure)


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


def _start(arguments: argparse.Namespace) -> Problem:
    """Return the case over the range that is asked for; BadInput where it cannot be sized."""
    start = turned_pivot(arguments, "range to size for")
    if start.section_depth is not None:
        expected = "none: both sides of a rectangular section are sized"
        raise BadInput(
            f"{arguments.case}: strip.section_depth_m: got {start.section_depth:g}, expected {expected}"
        )
    return start


def _task(start: Problem, arguments: argparse.Namespace) -> Task:
    own = answers(start)
    bounds = Room().bounds(start)
    for name, (attribute, unit, _, _) in BOUNDS.items():
        given = getattr(arguments, attribute)
        if given is not None:
            bounds[name] = given[0] * unit, given[1] * unit
    length, _, _, thickness, _ = map(float, variables_of(start))
    wanted = arguments.max_stress_MPa
    stress = float(abs(own.stress).max()) if wanted is None else 1e6 * wanted
    return Task(
        start=start,
        objective=arguments.objective,
        stiffness=own.stiffness if arguments.stiffness is None else arguments.stiffness,
        allowable_stress=stress,
        bounds=bounds,
        least_slenderness=length / thickness,
        largest_aspect=arguments.aspect,
        limits={},
    )


def _failure(outcomes: list[Outcome]) -> str:
    """Return why there is no optimum, from the start that came nearest."""
    if not outcomes:
        return "the path of no start reaches the end of the range"
    nearest = min(outcomes, key=lambda each: each.violation)
    return f"no optimum from {len(outcomes)} starts: {nearest.message}"


def _named(measured: Measured) -> dict[str, float]:
    return {KEYS[name]: value for name, value in measured.quantities().items()}


def _dimensions(problem: Problem) -> dict[str, float]:
    values = dict(zip(DIMENSIONS, map(float, variables_of(problem)), strict=True))
    return values | {"inclination_deg": math.degrees(problem.inclination)}


def _readable(
    task: Task, outcomes: list[Outcome], found: Outcome | None, checked: Measured | None
) -> Iterator[str]:
    """Yield the lines of a table: case, optimum and finite elements, what holds it back, and the starts."""
    own = of_spline(answers(task.start)).quantities()
    yield f"least {task.objective.replace('-', ' ')} over +-{abs(math.degrees(task.start.rotation)):.4g} deg"
    yield f"at {task.stiffness:.6g} N m/rad and at most {task.allowable_stress / 1e6:.6g} MPa"
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
    held = (f"{each.name.replace('_', ' ')} ({each.price:+.2g})" for each in found.active)
    yield f"held back by, with prices: {', '.join(held)}"


def _heading() -> str:
    return f"{'L mm':>9}{'incl. deg':>11}{'crossing':>10}{'h mm':>9}{'b mm':>9}"


def _line(problem: Problem) -> str:
    length, _, ratio, thickness, width = variables_of(problem)
    inclination = math.degrees(problem.inclination)
    return f"{1e3 * length:9.3f}{inclination:11.3f}{ratio:10.4f}{1e3 * thickness:9.4f}{1e3 * width:9.3f}"
