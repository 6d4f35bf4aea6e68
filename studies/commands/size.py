"""Size a design: least centre shift, variation of stiffness or stress at given range, stiffness and stress.

    python -m studies size cross_axis_pivot --objective centre-shift --rotation-deg 45
    python -m studies size spring_steel_pivot --objective stiffness-variation --aspect 0.5
    python -m studies size large_steel_pivot --objective centre-shift --free strip.length_m=0.3
    python -m studies size four_bar_of_flexures --objective stress --free section.thickness_m=1e-4:5e-4

The numbers of the case file that --free names are found, as `sweep` names them, in the file's unit; keys with
commas share a value, and one value instead of bounds holds a number. Of a pivot these are its length,
inclination, crossing ratio, thickness and width, unless --free says otherwise, with a rectangular section;
its strips become neither thicker for their length than the case's nor wider than --aspect times their length.

The case gives all else: material, range (its rotation), loads and the design to compare with. Held is the
stiffness of the driven body as it begins to turn, the case's own unless it is given, or, of a mechanism that
follows its loads, how far its body goes. The allowable stress is the yield strength, or the case's own at the
end of the range where no strength is known. Under loads both sides of a pivot's range are solved, the stress
is held at both ends and before the body turns, and a design that buckles is none.

Gradients are exact; several starts show local optima, and one whose path ends early is moved towards the
case. A start is given up after 300 designs. The optimum is answered to 1e-4, found again with more control
points where it takes more, and solved by the finite elements in the limit of refinement, with all effects of
the scene; --out writes it as a case file. A price is the change of the objective over that of a limit, in %
over %. Exit code 0: an optimum was found; 2: bad input; 3: none was found, or the case has no answer itself;
then the table of the starts says how near they came.
"""

import argparse
import math
import sys
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any, Self

from spline_model.accuracy import DEFAULT
from spline_model.confirmed import NOTHING
from studies.answers.adapters import answer_static
from studies.answers.quantities import Scale
from studies.answers.reference import NoReference
from studies.answers.response import Response
from studies.answers.settings import SplineSettings
from studies.answers.validity import validity
from studies.cases.design import Design, as_toml, design_of
from studies.cases.document import parsed
from studies.cases.effects import OF_SIDES
from studies.cases.keys import LOADS_FIRST
from studies.commands import arguments as take
from studies.commands.answer import deliver, not_converged
from studies.commands.columns import by_row, numbers, plain, table
from studies.commands.parser import Argument, command, positive, whole_number
from studies.design import evaluate
from studies.design.evaluate import CENTRE_SHIFT, STIFFNESS, STRESS, TRAVEL, VARIATION, Answers
from studies.design.optimise import SAME, STARTS, Outcome, best, numbered, search, settled
from studies.design.question import Question
from studies.errors import BadInput
from studies.kinds import Array
from studies.record.files import write_whole
from studies.record.progress import Bar

#: Quantity -> what the JSON calls it.
KEYS = {
    CENTRE_SHIFT: "largest_centre_shift_m",
    VARIATION: "stiffness_variation",
    STIFFNESS: "stiffness_Nm_per_rad",
    TRAVEL: "travel_m",
    STRESS: "max_stress_Pa",
}
#: Digits in the tables, of answers and of numbers of the case.
DIGITS, WRITTEN = 5, 6


@command(
    take.CASE,
    Argument("--objective", "what is to be least", choices=[CENTRE_SHIFT, VARIATION, STRESS], required=True),
    Argument(
        "--free KEY[=LOW:HIGH]",
        "a number of the file to be found, with its bounds, or the one value that it has; repeatable "
        "(default bounds: of a pivot's dimensions as far as usual, of others half to twice the case's)",
        action="append",
        default=[],
    ),
    take.ROTATION.but("end of the range, of a pivot to either side, in deg (default: the case's)"),
    Argument("--stiffness K", "at rotation 0, in N m/rad (default: the case's own)", positive),
    Argument("--travel-mm U", "of a body that follows its loads, in mm (default: the case's own)", positive),
    Argument("--max-stress-MPa S", "in MPa (default: the yield strength, or the case's own)", positive),
    Argument(
        "--aspect R", "a pivot's largest width, relative to the length, default 1", positive, default=1.0
    ),
    Argument("--starts N", "starts of the search, default 8", whole_number(1), default=STARTS),
    take.OUT_FILE.but("write the optimum there as a case file (default: none)"),
    take.JSON,
)
def main(arguments: argparse.Namespace) -> int:
    """Search, check, report; return the exit code. BadInput: an objective that the case does not support."""
    asked = _question(arguments)
    try:
        task, own = _limited(asked, arguments)
        with Bar("size") as bar:
            outcomes = search(task, task.starts(arguments.starts), bar)
        best_one = best(outcomes)
        found = None if best_one is None else _Optimum.of(task, best_one)
    except evaluate.PathEnds as error:
        return not_converged(f"{arguments.case}: the case itself has no answer over the range: {error}")
    failure = None
    if found is None:
        nearest = min(range(len(outcomes)), key=lambda k: outcomes[k].violation)
        reason = outcomes[nearest].message
        failure = f"no optimum from {len(outcomes)} starts; nearest, start {nearest}: {reason}"
    elif arguments.out is not None:
        (least, held), name = _said(task), Path(arguments.case).stem
        remarks = [f"Sized from {name} for the {least},", f"{held}."]
        content = task.document(task.values(found.outcome.at))
        write_whole(arguments.out, as_toml(content, remarks).encode())
        print(f"studies: {arguments.out}: the optimum as a case file", file=sys.stderr)
    document = _document(task, own, outcomes, found)
    return deliver(arguments, document, _readable(task, own, outcomes, found), failure=failure)


def _question(arguments: argparse.Namespace) -> Question:
    """Return what is asked of the case; BadInput where it cannot be sized so."""
    where, content = str(arguments.case), parsed(arguments.case)
    if arguments.rotation is not None:
        drive = content.get("drive", {}) | {"rotation_deg": math.degrees(arguments.rotation)}
        content = content | {"drive": drive}
    start = design_of(where, content)
    if start.crossing_point is not None:
        _require_sizable(where, start)
    elif not arguments.free:
        raise BadInput("--free: got none, expected a number of the mechanism's file, such as section.width_m")
    if not start.bodies:
        raise BadInput(f"{where}: bodies: got none, expected one whose stiffness or travel is held")
    task = Question.of(where, content, arguments.free, aspect=arguments.aspect, objective=arguments.objective)
    if task.objective not in task.objectives:
        expected = " or ".join(task.objectives)
        raise BadInput(f"--objective: got {task.objective}, expected {expected} for {Path(where).stem}")
    other, option = (TRAVEL, "--travel-mm") if task.held == STIFFNESS else (STIFFNESS, "--stiffness")
    if getattr(arguments, "travel_mm" if other == TRAVEL else other) is not None:
        raise BadInput(f"{option}: got it for {Path(where).stem}, of which the {task.held} is held")
    task.require_gradients()
    return task


def _require_sizable(where: str, start: Design) -> None:
    """Raise BadInput for a pivot of which no range can be sized."""
    effects, order, fibre = set(start.effects.names), start.order, start.strips[0].outer_fibre
    late = f'"{LOADS_FIRST}", so that the loads are whole at every rotation'
    for wrong, got, expected in (
        (not start.rotation, "drive.rotation_deg: got 0", "a range to size for"),
        (fibre, f"strip.outer_fibre_m: got {fibre}", "none: sides of a rectangle"),
        ("driven_displacement" in effects, "scene.effects: got driven_displacement", "a body free to shift"),
        (effects - evaluate.PLAIN and order != LOADS_FIRST, f'drive.order: got "{order}"', late),
    ):
        if wrong:
            raise BadInput(f"{where}: {got}, expected {expected}")


def _limited(task: Question, arguments: argparse.Namespace) -> tuple[Question, Answers]:
    """Return the question with what is held and allowed, given or the case's own, and the case's answers."""
    own = task.accurate()
    if own.quantities[task.objective] <= NOTHING:
        expected = "what is not zero already: its stiffness does not vary"
        raise BadInput(f"--objective: got {task.objective} of {arguments.case}, expected {expected}")
    strengths = [strip.yield_strength or math.nan for strip in task.start.strips]
    allowable = own.largest(STRESS) if math.isnan(sum(strengths)) else min(strengths)
    if arguments.max_stress_MPa is not None:
        allowable = 1e6 * arguments.max_stress_MPa
    wanted = arguments.stiffness if arguments.travel_mm is None else 1e-3 * arguments.travel_mm
    wanted = own.quantities[task.held] if wanted is None else wanted
    points = own.control_points
    return replace(task, wanted=wanted, allowable_stress=allowable, control_points=points), own


@dataclass(frozen=True, kw_only=True)
class _Optimum:
    """The best design of a search, its answer to the accuracy of `solve`, and that of the finite elements.

    If the finite elements have no answer, the reason takes its place.
    """

    outcome: Outcome
    path: Response
    elements: Mapping[str, float]
    no_elements: str = ""

    @classmethod
    def of(cls, asked: Question, found: Outcome) -> Self:
        """Return an optimum with all that is said of it."""
        found = settled(asked, found)
        path, reason = answer_static(found.design, SplineSettings()), ""
        try:
            elements = evaluate.by_elements(found.design)
        except (NoReference, BadInput) as error:
            elements, reason = dict.fromkeys(KEYS, math.nan), str(error)
        return cls(outcome=found, path=path, elements=elements, no_elements=reason)


def _named(asked: Question, measured: Mapping[str, float]) -> dict[str, float]:
    """Return the quantities that are told of a design by their keys."""
    return {KEYS[name]: measured[name] for name in asked.quantities}


def _numbers(asked: Question, at: Array) -> dict[str, float]:
    """Return the numbers of the case at scaled variables (N,), or (N + 1,), by name in the file's unit."""
    return dict(zip(asked.names, map(float, asked.values(at)), strict=True))


def _document(
    asked: Question, own: Answers, outcomes: list[Outcome], found: _Optimum | None
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
            "numbers": _numbers(asked, each.at),
        }
        for number, each in zip(numbered(outcomes), outcomes, strict=True)
    ]
    optimum = found and {
        "numbers": _numbers(asked, found.outcome.at),
        "spline": _named(asked, found.outcome.answers.quantities),
        "estimated_error": _named(asked, found.outcome.answers.errors),
        "control_points": found.outcome.answers.control_points,
        "finite_elements": _named(asked, found.elements),
        "validity": asdict(validity(found.path)),
        "active": [{"constraint": name, "price": price} for name, price in found.outcome.active.items()],
    }
    return {
        "objective": asked.objective,
        KEYS[asked.held]: asked.wanted,
        "allowable_stress_Pa": asked.allowable_stress,
        "bounds": {each.name: [each.low, each.high] for each in asked.variables},
        "case": _named(asked, own.quantities),
        "optimum": optimum,
        "starts": starts,
    }


def _said(asked: Question) -> tuple[str, str]:
    """Return what is asked, in two lines: the range of a pivot is to both sides."""
    names, rotation = asked.start.effects.names, asked.start.rotation
    least = f"least {asked.objective.replace('-', ' ')}"
    if rotation is not None:
        degrees = math.degrees(rotation)
        both = asked.start.crossing_point is not None
        least += f" over +-{abs(degrees):.4g} deg" if both else f" over {degrees:.4g} deg"
    if loads := [name for name in names if name not in evaluate.PLAIN]:
        least += f" under {', '.join(loads)}"
    if taken := [name.replace("_", " ") for name in OF_SIDES if name in names]:
        least += f" with {', '.join(taken)}"
    wanted = f"{asked.wanted:.6g} N m/rad"
    if asked.held == TRAVEL:
        wanted = f"a travel of {1e3 * asked.wanted:.6g} mm"
    return least, f"at {wanted} and at most {asked.allowable_stress / 1e6:.6g} MPa"


def _readable(
    asked: Question, own: Answers, outcomes: list[Outcome], found: _Optimum | None
) -> Iterator[str]:
    """Yield the lines of a table: case, optimum and finite elements, what holds it back, and the starts."""
    yield from _said(asked)
    yield ""
    designs = [("case", dict(zip(asked.names, asked.own, strict=True)))]
    if found is not None:
        yield from _comparison(asked, own.quantities, found)
        designs.append(("sized", _numbers(asked, found.outcome.at)))
        active = ", ".join(f"{name} ({price:+.2g})" for name, price in found.outcome.active.items())
        yield f"held back by, with prices: {active or 'nothing'}"
        if held := [each.name for each in asked.variables if each.span == 0.0]:
            yield f"held as asked: {', '.join(held)}"
        yield ""
    scales = {name: Scale(heading=name, factor=1.0) for name in asked.names}
    designs += [(f"start {k}", _numbers(asked, each.at)) for k, each in enumerate(outcomes)]
    yield from table(by_row(scales, designs, WRITTEN))
    yield ""
    optima, objective = numbered(outcomes), own.quantities[asked.objective]
    yield from table(
        [
            plain("start", map(str, range(len(outcomes)))),
            plain("optimum", (str(number or "-") for number in optima)),
            numbers("over case", (each.objective / objective for each in outcomes), ".4f"),
            plain("paths", (str(each.solved) for each in outcomes)),
            plain("", map(_ended, optima, outcomes), left=True),
        ]
    )


def _ended(number: int, outcome: Outcome) -> str:
    """Return where a start led, in words."""
    return outcome.message or ("the least" if number == 1 else "an optimum, not the least")


def _comparison(asked: Question, case: Mapping[str, float], found: _Optimum) -> Iterator[str]:
    """Yield what case and optimum answer, how sure that is, and what `solve` says of the optimum."""
    spline, errors = found.outcome.answers.quantities, found.outcome.answers.errors
    columns = [("case", case), ("sized", spline), ("in FE", found.elements)]
    scales = {key: Scale.of_key(key) for key in _named(asked, case)}
    yield from table(by_row(scales, [(name, _named(asked, own)) for name, own in columns], DIGITS))
    if found.no_elements:
        yield f"the finite elements have no answer: {found.no_elements}"
    yield _gain(case[asked.objective] / spline[asked.objective])
    points = f"{found.outcome.answers.control_points} control points"
    told = (f"{name} {e:.1e}" if math.isfinite(e) else f"{name} not estimated" for name, e in errors.items())
    yield f"estimated error of the splines, sized, {points}: {', '.join(told)}"
    if missed := [name for name, error in errors.items() if error > DEFAULT]:
        yield f"the accuracy of {DEFAULT:g} is not reached by: {', '.join(missed)}"
    yield from (f"warning: {each}" for each in validity(found.path).outside)
    if found.path.message:
        yield found.path.message


def _gain(times: float) -> str:
    """Return in words how much less the objective is, which the case has so many times."""
    if abs(times - 1.0) < SAME:
        return "as much as the case's, which is an optimum already"
    if times > 1.0:
        return f"{times:.4g} times less than the case's"
    return f"{1.0 / times:.4g} times the case's, which does not meet what is asked"
