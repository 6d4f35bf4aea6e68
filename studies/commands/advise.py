"""Say which setting of each model meets an error at the least cost, on one pivot or mechanism.

    python -m studies advise cross_axis_pivot --accuracy 1e-3
    python -m studies advise my_pivot.toml --accuracy 1e-2 --json -

Every setting of every model is tried on the case itself: the spline, also by itself as in `solve` (whose
stress is by balance of moments, far more accurate than that by its curvature), the finite elements without
and with shear, and of a pivot the surrogate models in closed form and the other codes that are installed.
The error is that of path and torque over the static path; those of stiffness and largest stress are told
beside it. Each model is held against the limit of its own theory,
whose own error is printed. A setting counts when finer ones keep the error. Times are measured here, on one
thread, once all is compiled and loaded: of whole calls, from the design to the answer, set-up included, and
of the increments or steps alone. Exit code 0: done; 2: bad input; 3: there is no reference, or no
model meets the error.
"""

import argparse
import math
from collections.abc import Iterator, Mapping
from typing import Any

import pandas as pd

from studies.answers.reference import NoReference
from studies.cases.design import Design
from studies.cases.section import refuse_tapers
from studies.commands import arguments as take
from studies.commands.answer import deliver, not_converged
from studies.commands.columns import numbers, plain, table
from studies.commands.parser import command
from studies.cost.tried import PATH_ERRORS, PATH_JUDGED, advise
from studies.record.progress import Bar

#: Errors that are reported beside those that a setting is judged by.
BESIDE = tuple(name for name in PATH_ERRORS if name not in PATH_JUDGED)


@command(
    take.CASE,
    take.ACCURACY.but("wanted relative error, default 1e-3", default=1e-3),
    take.JSON,
)
def main(arguments: argparse.Namespace) -> int:
    """Try all settings and report; return the exit code."""
    problem = take.turned_design(arguments, "rotation to relate errors to")
    if problem.crossing_point is not None:  # of pivots codes and surrogates that know no taper are tried
        refuse_tapers(arguments.case, problem.strips, "the models that are tried")
    try:
        with Bar("advise") as bar:
            found = advise(problem, arguments.accuracy, bar)
    except NoReference as error:
        return not_converged(error)
    failure = None if found["meets"].any() else f"no model meets {arguments.accuracy:g} here"
    lines = _readable(problem, found, arguments.accuracy)
    return deliver(arguments, _document(found, arguments.accuracy), lines, failure=failure)


def _document(found: pd.DataFrame, error: float) -> dict[str, Any]:
    """Return the advice as the JSON object of the command."""
    named = {
        **{"group": "model", "setting": "setting", "meets": "meets"},
        **{name: f"error_{name}" for name in PATH_ERRORS},
        "largest": "reference_uncertainty",
        **{f"uncertainty_{name}": f"reference_uncertainty_{name}" for name in BESIDE},
        **{name: name for name in ("whole_s", "solve_s", "message")},
    }
    largest = [_uncertainty(row) for row in found.to_dict("records")]
    models = found.assign(largest=largest).reindex(columns=list(named)).rename(columns=named)
    return {"accuracy": error, "models": models.to_dict("records")}


def _uncertainty(row: Mapping[Any, Any]) -> float:
    """Return the largest uncertainty of the limits that a model is judged by [1]."""
    return max(float(row[f"uncertainty_{name}"]) for name in PATH_JUDGED)


def _readable(problem: Design, found: pd.DataFrame, error: float) -> Iterator[str]:
    """Yield the lines of a table, the cheapest model that meets the error first."""
    turned = math.degrees(problem.rotation or 0.0)
    yield f"error {error:g} in {' and '.join(PATH_JUDGED)}, from 0 to {turned:.4g} deg"
    rows = found.sort_values(["meets", "whole_s"], ascending=[False, True]).to_dict("records")
    unsure = max(_uncertainty(row) for row in rows)
    beside = (f"of the {name} {found[f'uncertainty_{name}'].max():.1e}" for name in BESIDE)
    yield ", ".join((f"error of the references: at most {unsure:.1e}", *beside))
    fastest = rows[0]["whole_s"]
    said = (row["message"] or ("" if row["meets"] else "does not meet it: its best") for row in rows)
    yield from table(
        [
            plain("model", (row["group"] for row in rows), left=True),
            plain("setting", (row["setting"] for row in rows), left=True),
            *(numbers(name, (row.get(name, math.nan) for row in rows)) for name in PATH_ERRORS),
            numbers("whole call [ms]", (1e3 * row["whole_s"] for row in rows), ".3g"),
            numbers("x fastest", (row["whole_s"] / fastest for row in rows), ".3g"),
            numbers("alone [ms]", (1e3 * row["solve_s"] for row in rows), ".3g"),
            plain("", said, left=True),
        ]
    )
    if unsure > 0.1 * error:
        yield "a reference's own error is more than a tenth of the wanted one: the verdicts are not certain"
