"""What suffices for a design: control points or elements, effects, the setting of a model."""

import argparse
import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from studies.answers.reference import QUANTITIES, NoReference, Reference
from studies.answers.settings import SplineSettings
from studies.cases.design import Design
from studies.cases.section import refuse_tapers
from studies.commands import arguments as take
from studies.commands.answer import deliver, not_converged
from studies.commands.columns import Column, numbers, plain, table
from studies.commands.parser import Argument, command, positive, reads, whole_number
from studies.convergence.sweep import FINEST, drawn, element_sweep, known, reaching, spline_row, with_orders
from studies.cost import tried
from studies.cost.tried import PATH_ERRORS, PATH_JUDGED
from studies.effects import audit as effects
from studies.effects.audit import CHANGED, Audit
from studies.effects.scenes import CHANGES, SIZES, Scene
from studies.errors import BadInput, Unanswered
from studies.record import style
from studies.record.files import require_writable_folder, write_all
from studies.record.progress import Bar, watched
from studies.record.source import HOME
from studies.record.store import as_csv

#: Accuracies whose count is reported.
ACCURACIES = (1e-3, 1e-4, 1e-6)
#: Stands for a count where the reference cannot tell.
UNSURE = "unsure"


def _counts(low: int) -> Callable[[str], tuple[int, int]]:
    """Return a parser of ranges "first:last" of whole numbers from `low` upwards, both ends included."""

    def value_of(text: str) -> tuple[int, int] | None:
        first, _, last = text.partition(":")
        written = first.isdecimal() and last.isdecimal()
        return (int(first), int(last)) if written and low <= int(first) < int(last) else None

    return reads(f"FIRST:LAST with {low} <= FIRST < LAST", value_of)


@command(
    take.CASE,
    take.CONTROL_POINTS.but(
        "of the splines, in steps of 1, default 4:12", read=_counts(4), default=(4, 12), metavar="A:B"
    ),
    take.ELEMENTS.but(
        "of the meshes, by doubling, default 5:160", read=_counts(1), default=(5, 160), metavar="A:B"
    ),
    take.OUT.but("of tables and figure (default: results/designs/<name of the case>)"),
)
def converge(arguments: argparse.Namespace) -> int:
    """Refine both models on a design and say how many control points or elements reach an accuracy.

        python -m studies converge cross_axis_pivot
        python -m studies converge my_pivot.toml --control-points 4:16 --elements 5:320 --out my_pivot

    The spline is refined point by point, the finite elements by doubling; both are held against the limit
    of the finite elements' refinement, whose own uncertainty is printed. Errors are the largest over the
    path, of the stress those of the largest stress of each state. Tables and a figure go to the output
    folder. Exit code 0: done; 2: bad input; 3: the finite elements, and with them the reference, did not
    converge. A spline that does not converge keeps its row.
    """
    problem = take.turned_design(arguments, "rotation to relate errors to")
    meshes = _doubled(*arguments.elements)
    first, last = arguments.control_points
    settings = [SplineSettings(control_points=count) for count in range(first, last + 1)]
    output = arguments.out or HOME / "results" / "designs" / Path(arguments.case).stem
    require_writable_folder(output)
    try:
        with Bar("finite elements") as bar:
            elements, limit = element_sweep(problem, meshes, "corotational", bar)
    except NoReference as error:
        return not_converged(f"{error}; begin with more elements, as --elements 20:160, or turn less far")
    with Bar("splines") as bar:
        rows = [spline_row(problem, each, limit) for each in watched(settings, bar)]
    splines = with_orders(pd.DataFrame(rows), "control_points")
    print("\n".join(_report_of_converge(splines, elements, limit)))
    with style.applied():
        figure = drawn(splines, elements, limit)
        contents = {f"convergence.{kind}": style.rendered(figure, kind) for kind in ("svg", "png")}
    contents = {"control_points.csv": as_csv(splines), "elements.csv": as_csv(elements)} | contents
    write_all(output, contents)
    print(f"\n{output}: {', '.join(contents)}")
    return 0


def _doubled(first: int, last: int) -> list[int]:
    """Return first, 2 first, 4 first ... up to `last`: three meshes at least to take a limit from."""
    meshes = [first]
    while 2 * meshes[-1] <= last:
        meshes.append(2 * meshes[-1])
    if len(meshes) < 3 or meshes[2] > FINEST:
        raise BadInput(f"--elements: got {first}:{last}, expected A:B with A <= {FINEST // 4} and B >= 4 A")
    return meshes


def _report_of_converge(splines: pd.DataFrame, elements: pd.DataFrame, limit: Reference) -> Iterator[str]:
    """Yield the tables of both models and the counts that reach the accuracies."""
    yield "largest errors over the path, against the finite elements in the limit of refinement"
    unsure = {name: limit.uncertainty[name] for name in known(limit)}
    yield "its uncertainty: " + ", ".join(f"{name} {value:.1e}" for name, value in unsure.items())
    models = {"control_points": splines, "elements": elements}
    for count, rows in models.items():
        yield ""
        yield from table(_columns_of_converge(rows, count))
    yield ""
    stress = "stiffness and largest stress" if len(unsure) == len(QUANTITIES) else "stiffness"
    for said, names in (("trajectory and torque", QUANTITIES[:2]), (stress, tuple(unsure))):
        reached = (
            plain(f"{accuracy:.0e}", (_reaching(*each, accuracy, names, limit) for each in models.items()))
            for accuracy in ACCURACIES
        )
        labels = (count.replace("_", " ") for count in models)
        yield from table([plain(f"count that reaches, in {said}", labels, left=True), *reached])
    if max(unsure.values()) > min(ACCURACIES):
        yield f"{UNSURE}: the reference is uncertain by more than that; finer meshes help (--elements 20:640)"


def _reaching(
    count: str, rows: pd.DataFrame, accuracy: float, quantities: tuple[str, ...], limit: Reference
) -> str:
    """Return the count of a model that reaches an accuracy in these quantities.

    An accuracy that the reference is not sure of itself is reached by no count.
    """
    if max(limit.uncertainty[name] for name in quantities) > accuracy:
        return UNSURE
    return str(reaching(rows, count, accuracy, quantities) or f"> {rows[count].max()}")


def _columns_of_converge(rows: pd.DataFrame, count: str) -> Iterator[Column]:
    """Yield the columns of a model, the status with where a failed path stopped."""
    yield plain(count.replace("_", " "), map(str, rows[count]))
    for name in QUANTITIES:
        yield numbers(name, rows[f"error_{name}"], ".3e")
        yield numbers("order", rows[f"order_{name}"], ".2f")
    ended = (
        status.replace("_", " ") + f" beyond {math.degrees(reached):.4g} deg" * (status != "converged")
        for status, reached in zip(rows["status"], rows["reached_rad"], strict=True)
    )
    yield plain("status", ended, left=True)


#: Headings of columns that are not called as in JSON.
HEADINGS = {
    "trajectory": "path",
    "swing_frequency": "swing",
    "first_mode": "1st mode",
    "time_ratio": "time",
    "degrees_of_freedom": "DOF",
    "highest_frequency_Hz": "highest Hz",
    "explicit_step_s": "step s",
}


@command(
    take.CASE,
    take.EFFECTS,
    take.CONTROL_POINTS.but("control points a strip, default 6", read=whole_number(4), default=6),
    Argument("--tolerance T", "allowed relative change, default 1e-3", positive, default=1e-3),
    take.JSON,
)
def audit(arguments: argparse.Namespace) -> int:
    """Report the influence of each effect of a scene, and find the cheapest scene within a tolerance.

        python -m studies audit cross_axis_pivot
        python -m studies audit my_pivot.toml --tolerance 1e-2 --json audit.json

    The spline model solves the static path of the case and the motion from its end for every scene. The
    full scene is that of the case with weight and the rotary inertia of the sections; where one of these
    makes the design unstable at rest, it is removed and a last line reports this. One line per effect
    contains the changes of the answer when the effect is removed or replaced by its simpler form:
    inextensible strips for stretching and massless strips for their inertia. Changes are of the path over
    the travel, of the torque over the largest, of the swing's and the first mode's frequency, and of the
    part of the energy that is lost. Times are of static path and motion together, the full scene's over
    the line's: above 1 the line is faster. DOF are those with inertia; the explicit step is the longest
    stable one of the leapfrog, or of central differences where strips cannot stretch. Then come the effects
    that planar beams neglect: lateral clamping, anticlastic stiffening, monolithic supports, all three, and
    shear, which the elements have (--model fe-shear). Printed are the changes of path, of stiffness at the
    begin of the rotation, of torque and largest stress at its end, and of the first mode. The cheapest scene
    within the tolerance is that with the fewest effects, which is not always the fastest. Exit code 0: done;
    2: bad input; 3: the full scene has no answer.
    """
    design = take.chosen_design(arguments)
    settings = SplineSettings(control_points=arguments.control_points)
    try:
        with Bar("audit") as bar:
            found = effects.audit(design, settings, arguments.tolerance, bar)
    except Unanswered as error:
        return not_converged(f"the full scene: {error}")
    return deliver(arguments, _document_of_audit(found), _readable_of_audit(found), failure=None)


def _document_of_audit(found: Audit) -> dict[str, Any]:
    """Return the audit as the JSON object of the command."""
    return {
        "tolerance": found.tolerance,
        "model": found.run.settings.model,
        "settings": found.run.settings.keywords(),
        "duration_s": found.run.duration,
        "step_s": found.run.step,
        "full": found.full.row(found.full),
        "rows": [row.row(found.full) for row in found.rows],
        "tried": [row.row(found.full) for row in found.tried],
        "beyond": found.beyond,
        "cheapest": found.cheapest.row(found.full),
        "full_wall_s": found.full.wall_s,
    }


def _readable_of_audit(found: Audit) -> Iterator[str]:
    """Yield the lines of a table, and the cheapest scene."""
    run, best = found.run, found.cheapest
    yield f"full scene: {', '.join(found.full.effects.names)}"
    yield f"static path and {1e3 * run.duration:.3g} ms of motion in steps of {run.step:.2g} s; changes to it"
    yield from _scenes(found, (found.full, *found.rows))
    yield ""
    labels = ("with " + price["effect"].replace("_", " ") for price in found.beyond)
    yield from _table_of_audit("neglected by planar beams", labels, found.beyond, CHANGED)
    yield ""
    if not best.dropped:
        yield f"no cheaper scene is within {found.tolerance:g}"
        return
    yield f"cheapest within {found.tolerance:g}: {', '.join(best.effects.names)}"
    yield f"that is: {best.label}"
    yield from _scenes(found, (best,))
    ratio = best.row(found.full)["time_ratio"]
    yield f"largest change {best.largest:.2g}, {ratio:.2f} times as fast as the full scene"


def _scenes(found: Audit, outcomes: Sequence[Scene]) -> Iterator[str]:
    """Yield the lines of a table of scenes, several effects without their names."""
    labels = (each.label if len(each.dropped) < 2 else "all of these" for each in outcomes)
    rows = [each.row(found.full) for each in outcomes]
    return _table_of_audit("scene", labels, rows, (*CHANGES, "time_ratio", *SIZES))


def _table_of_audit(
    title: str, labels: Iterable[str], rows: Sequence[Mapping[str, Any]], keys: Sequence[str]
) -> Iterator[str]:
    """Yield the lines of a table of numbers by their keys, with how and why a row ended that has none."""
    status = (row["status"].replace("_", " ").replace("converged", "") for row in rows)
    said = (": ".join(filter(None, (ended, row["reason"]))) for ended, row in zip(status, rows, strict=True))
    columns = (numbers(HEADINGS.get(key, key), (row[key] for row in rows), ".3g") for key in keys)
    return table([plain(title, labels, left=True), *columns, plain("", said, left=True)])


#: Errors that are reported beside those that a setting is judged by.
BESIDE = tuple(name for name in PATH_ERRORS if name not in PATH_JUDGED)
#: Columns of the advice -> what the JSON calls them.
ADVICE = {
    **{"group": "model", "setting": "setting", "meets": "meets"},
    **{name: f"error_{name}" for name in PATH_ERRORS},
    "uncertainty": "reference_uncertainty",
    **{f"uncertainty_{name}": f"reference_uncertainty_{name}" for name in BESIDE},
    **{name: name for name in ("whole_s", "solve_s", "message")},
}


@command(
    take.CASE,
    take.ACCURACY.but("wanted relative error, default 1e-3", default=1e-3),
    take.JSON,
)
def advise(arguments: argparse.Namespace) -> int:
    """Say which setting of each model meets an error at the least cost, on one pivot or mechanism.

        python -m studies advise cross_axis_pivot --accuracy 1e-3
        python -m studies advise my_pivot.toml --accuracy 1e-2 --json -

    Every setting of every model is tried on the case itself: the spline, also by itself as in `solve`
    (whose stress is by balance of moments, far more accurate than that by its curvature), the finite
    elements without and with shear, and of a pivot the surrogate models in closed form and the other
    codes that are installed. The error is that of path and torque over the static path; those of
    stiffness and largest stress are told beside it. Each model is held against the limit of its own
    theory, whose own error is printed. A setting counts when finer ones keep the error. Times are
    measured here, on one thread, once all is compiled and loaded: of whole calls, from the design to the
    answer, set-up included, and of the increments or steps alone. Exit code 0: done; 2: bad input; 3:
    there is no reference, or no model meets the error.
    """
    problem = take.turned_design(arguments, "rotation to relate errors to")
    if problem.crossing_point is not None:  # of pivots codes and surrogates that know no taper are tried
        refuse_tapers(arguments.case, problem.strips, "the models that are tried")
    try:
        with Bar("advise") as bar:
            found = tried.advise(problem, arguments.accuracy, bar)
    except NoReference as error:
        return not_converged(error)
    unsure = found[[f"uncertainty_{name}" for name in PATH_JUDGED]].max(axis=1)
    found = found.assign(uncertainty=unsure).reindex(columns=list(ADVICE))
    failure = None if found["meets"].any() else f"no model meets {arguments.accuracy:g} here"
    models = found.rename(columns=ADVICE).to_dict("records")
    document = {"accuracy": arguments.accuracy, "models": models}
    return deliver(arguments, document, _advice(problem, found, arguments.accuracy), failure=failure)


def _advice(problem: Design, found: pd.DataFrame, error: float) -> Iterator[str]:
    """Yield the lines of a table, the cheapest model that meets the error first."""
    turned, unsure = math.degrees(problem.rotation or 0.0), found["uncertainty"].max()
    yield f"error {error:g} in {' and '.join(PATH_JUDGED)}, from 0 to {turned:.4g} deg"
    beside = (f"of the {name} {found[f'uncertainty_{name}'].max():.1e}" for name in BESIDE)
    yield ", ".join((f"error of the references: at most {unsure:.1e}", *beside))
    rows = found.sort_values(["meets", "whole_s"], ascending=[False, True])
    best = np.where(rows["meets"], "", "does not meet it: its best")
    yield from table(
        [
            plain("model", rows["group"], left=True),
            plain("setting", rows["setting"], left=True),
            *(numbers(name, rows[name]) for name in PATH_ERRORS),
            numbers("whole call [ms]", 1e3 * rows["whole_s"], ".3g"),
            numbers("x fastest", rows["whole_s"] / rows["whole_s"].iloc[0], ".3g"),
            numbers("alone [ms]", 1e3 * rows["solve_s"], ".3g"),
            plain("", rows["message"].where(rows["message"] != "", best), left=True),
        ]
    )
    if unsure > 0.1 * error:
        yield "a reference's own error is more than a tenth of the wanted one: the verdicts are not certain"
