"""Size a design: least centre shift, variation of stiffness or stress at given range, stiffness and stress.

    python -m studies size cross_axis_pivot --objective centre-shift --rotation-deg 45
    python -m studies size spring_steel_pivot --objective stiffness-variation --aspect 0.5
    python -m studies size large_steel_pivot --objective centre-shift --free strip.length_m=0.3
    python -m studies size four_bar_of_flexures --objective stress --free section.thickness_m=1e-4:5e-4

The case of a pivot gives the material, the range to either side (its rotation), the loads that it carries and
the design to compare with. The wanted stiffness is its own at rotation 0 unless it is given; the allowable
stress is the yield strength, or the case's own at the end of the range where no strength is known. Under
loads both sides of the range are solved, the stress is held at both ends and before the body turns, and a
design that buckles is none. Both strips are alike, with a rectangular section; they become neither thicker
for their length than the case's nor wider than --aspect times their length. --free sets the bounds of a
dimension, or the one value that holds it. Gradients are exact; several starts show local optima, and one
whose path ends early is moved towards the case. A case whose own path ends early takes --stiffness, and a
stress where none is known; then other designs are searched. A start is given up after 300 designs. The
optimum is answered to 1e-4, found again with more control points where it takes more, and solved by the
finite elements in the limit of refinement; --out writes it as a case file. A price is the change of the
objective over that of a limit, in % over %. What the scene names is assembled: clamped widths, sections that
flatten and roots too.

Of a mechanism the numbers of its file that --free names are found, as `sweep` names them, in the file's unit;
keys with commas share a value. Held is the stiffness of the driven body as it begins to turn, or, of a
mechanism that follows its loads, how far its body goes. Exit code 0: an optimum was found; 2: bad input; 3:
none was found, and then the table of the starts says how near they came.
"""

import argparse
import math
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

from spline_model.confirmed import NOTHING
from studies.answers.adapters import answer_static
from studies.answers.settings import SplineSettings
from studies.cases.design import as_toml
from studies.cases.document import is_mechanism, parsed
from studies.cases.keys import KEYS, LOADS_FIRST
from studies.cases.problem import Problem
from studies.cases.section import refuse_tapers
from studies.commands import arguments as take
from studies.commands.answer import deliver, not_converged
from studies.commands.parser import Argument, command, positive, whole_number
from studies.commands.sized import Optimum, as_document, question, readable
from studies.design.evaluate import CONTROL_POINTS, STRESS, VARIABLES, Accurate, PathEnds, sides_of
from studies.design.numbers import MechanismQuestion
from studies.design.optimise import best, search
from studies.design.programme import STARTS, compared
from studies.design.question import OF_PIVOT, PivotQuestion, Question
from studies.errors import BadInput
from studies.record.files import write_whole
from studies.record.progress import Bar

#: Numbers of a pivot's file that are found.
FOUND = {f"strip.{key.name}": key for key in KEYS if key.attribute in VARIABLES}


@command(
    take.CASE,
    Argument(
        "--objective",
        "what is to be least: of a mechanism stress or stiffness-variation",
        choices=[*OF_PIVOT, STRESS],
        required=True,
    ),
    Argument(
        "--free KEY[=LOW:HIGH]",
        "a number of the file to be found, repeatable: of a mechanism the only ones (default bounds: half to "
        "twice its own); of a pivot bounds of its length, inclination, crossing, thickness and width",
        action="append",
    ),
    take.ROTATION.but("range to either side, in deg (default: the case's)"),
    Argument("--stiffness K", "at rotation 0, in N m/rad (default: the case's own)", positive),
    Argument(
        "--travel-mm U",
        "of the body of a mechanism that follows its loads, in mm (default: the case's own)",
        positive,
    ),
    Argument(
        "--max-stress-MPa S",
        "allowable, in MPa (default: the yield strength, or the case's own)",
        positive,
    ),
    Argument("--aspect R", "largest width, relative to the length, default 1", positive, default=1.0),
    Argument("--starts N", "starts of the search, default 8", whole_number(1), default=STARTS),
    take.OUT_FILE.but("write the optimum there as a case file (default: none)"),
    take.JSON,
)
def main(arguments: argparse.Namespace) -> int:
    """Search, check, report; return the exit code. BadInput: an objective that the case does not support."""
    content = parsed(arguments.case)
    mechanism = is_mechanism(content)
    _refuse_others(arguments, mechanism)
    asked: Question = _numbers(content, arguments) if mechanism else _pivot(arguments)
    try:
        task, own = _limited(asked, arguments)
        with Bar("size") as bar:
            outcomes = search(task, task.starts(arguments.starts), bar)
        best_one = best(outcomes)
        found = None if best_one is None else Optimum.of(task, best_one)
    except PathEnds as error:
        return not_converged(error)
    failure = None
    if found is None:
        nearest = min(range(len(outcomes)), key=lambda k: outcomes[k].violation)
        reason = outcomes[nearest].message
        failure = f"no optimum from {len(outcomes)} starts; nearest, start {nearest}: {reason}"
    elif arguments.out is not None:
        (least, held), name = question(task), Path(arguments.case).stem
        remarks = [f"Sized from {name} for the {least},", f"{held}."]
        content = task.document(task.values(found.outcome.at))
        write_whole(arguments.out, as_toml(content, remarks).encode())
        print(f"studies: {arguments.out}: the optimum as a case file", file=sys.stderr)
    document = as_document(task, own, outcomes, found)
    return deliver(arguments, document, readable(task, own, outcomes, found), failure=failure)


def _pivot(arguments: argparse.Namespace) -> PivotQuestion:
    """Return what is asked of a pivot, within bounds; BadInput where it cannot be sized."""
    start = take.turned_design(arguments, "range to size for")
    assert isinstance(start, Problem)
    refuse_tapers(arguments.case, start.strips, "sizing")
    got, expected = "", ""
    if start.outer_fibre is not None:
        got = f"strip.outer_fibre_m: got {start.outer_fibre:g}"
        expected = "none: both sides of a rectangular section are sized"
    elif "driven_displacement" in start.effects.names:
        got, expected = "scene.effects: got driven_displacement", "a body that is free to shift"
    elif len(sides_of(start)) > 1 and start.order != LOADS_FIRST:
        got = f'drive.order: got "{start.order}"'
        expected = f'"{LOADS_FIRST}", so that the loads are whole at every rotation'
    if got:
        raise BadInput(f"{arguments.case}: {got}, expected {expected}")
    bounds = dict(map(_bounds, arguments.free or ()))
    return PivotQuestion.usual(start, bounds, aspect=arguments.aspect, objective=arguments.objective)


def _bounds(text: str) -> tuple[str, tuple[float, float]]:
    """Return the name of a pivot's number and its bounds in SI, equal where the text has one value."""
    name, _, given = text.partition("=")
    try:
        ends = [FOUND[name].rule.parse(float(part)) for part in given.split(":")]
    except (KeyError, ValueError) as error:
        what = f"one of {', '.join(FOUND)}" if name not in FOUND else str(error)
        raise BadInput(f"--free: got {text}, expected KEY=LOW:HIGH, in the file's unit: {what}") from None
    return FOUND[name].attribute, (min(ends), max(ends))


def _refuse_others(arguments: argparse.Namespace, mechanism: bool) -> None:
    """Raise BadInput for an option of the other kind of design."""
    if arguments.travel_mm is not None and not mechanism:
        got = f"got it for {Path(arguments.case).stem}"
        raise BadInput(f"--travel-mm: {got}, expected it for a mechanism only")
    wrong = "centre-shift" if mechanism else STRESS
    if arguments.objective == wrong:
        kinds = "stress or stiffness-variation" if mechanism else " or ".join(OF_PIVOT)
        raise BadInput(f"--objective: got {wrong}, expected {kinds} for {Path(arguments.case).stem}")
    if mechanism and not arguments.free:
        raise BadInput("--free: got none, expected a number of the mechanism's file, such as section.width_m")


def _numbers(content: dict[str, Any], arguments: argparse.Namespace) -> MechanismQuestion:
    """Return the numbers of a mechanism that are to be found, over the path that is asked for."""
    where = str(arguments.case)
    if arguments.rotation is not None:
        drive = content.get("drive", {}) | {"rotation_deg": math.degrees(arguments.rotation)}
        content = content | {"drive": drive}
    task = MechanismQuestion.of(where, content, arguments.free, objective=arguments.objective)
    if task.objective not in task.objectives:
        raise BadInput(f"--objective: got {task.objective}, expected stress of what follows its loads")
    if not task.start.bodies:
        raise BadInput(f"{where}: bodies: got none, expected one whose stiffness or travel is held")
    other = "travel_mm" if task.held == "stiffness" else "stiffness"
    if getattr(arguments, other) is not None:
        expected = take.option("stiffness" if other == "travel_mm" else "travel_mm")
        raise BadInput(f"{take.option(other)}: got it for {Path(where).stem}, expected {expected}")
    task.require_gradients()
    return task


def _limited(task: Question, arguments: argparse.Namespace) -> tuple[Question, Accurate]:
    """Return the question with what is held and allowed, given or the case's own, and the case's answers."""
    travel = arguments.travel_mm
    wanted = arguments.stiffness if travel is None else 1e-3 * travel
    strengths = [strip.yield_strength for strip in task.start.strips]
    allowable = None if None in strengths else min(strengths)
    if arguments.max_stress_MPa is not None:
        allowable = 1e6 * arguments.max_stress_MPa
    try:
        own = task.accurate()
    except PathEnds:
        own = _unknown(task, arguments, {task.held: wanted, "stress": allowable})
        assert allowable is not None, "it is given, as without it there is no question"
        return replace(task, wanted=wanted, allowable_stress=allowable), own
    if own.quantities[task.objective] <= NOTHING:
        expected = "what is not zero already: its stiffness does not vary"
        raise BadInput(f"--objective: got {task.objective} of {arguments.case}, expected {expected}")
    wanted = own.quantities[task.held] if wanted is None else wanted
    allowable = own.answers.largest(STRESS) if allowable is None else allowable
    points = own.control_points
    return replace(task, wanted=wanted, allowable_stress=allowable, control_points=points), own


def _unknown(task: Question, arguments: argparse.Namespace, limits: dict[str, float | None]) -> Accurate:
    """Return the answers of a case whose path ends early: no numbers, if all limits are given without them;
    else PathEnds, with what is to be given."""
    options = {"stiffness": "--stiffness", "travel": "--travel-mm", "stress": "--max-stress-MPa"}
    missing = [options[name] for name, limit in limits.items() if limit is None]
    if missing:
        told = answer_static(task.start, SplineSettings())
        reason = (
            told.message or f"it takes more than {CONTROL_POINTS} control points, from which sizing goes on"
        )
        rest = float(told.stiffness[0]) if len(told.stiffness) else math.nan
        unloaded = f" (at rest it has {rest:.4g} N m/rad)" if rest > 0.0 else ""
        remedy = f"give {' and '.join(missing)} to search from other designs{unloaded}"
        raise PathEnds(f"{arguments.case}: the case itself has no answer over the range: {reason}; {remedy}")
    nothing, (_, answers) = dict.fromkeys(task.quantities, math.nan), compared(task)
    return Accurate(answers=answers, quantities=nothing, errors=nothing, control_points=task.control_points)
