"""Say which setting of each model meets an error at the least cost, on one pivot or mechanism.

    python -m studies advise cross_axis_pivot --accuracy 1e-3
    python -m studies advise my_pivot.toml --accuracy 1e-2 --dynamic --json -

Every setting of every model is tried on the case itself: the spline, also by itself as in `solve` (whose
stress is by balance of moments, far more accurate than that by its curvature), the finite elements without
and with shear, and of a pivot the surrogate models in closed form and the other codes that are installed.
Without --dynamic the error is that of path and torque over the static path, and those of stiffness and
largest stress are told beside it; with it, that of the rotation (over the rotation at the start) and of the
frequency in the first four swings after the release. Each model is held against the limit of its own theory,
whose own error is printed. A setting counts when finer ones keep the error. Times are of the increments or
steps alone, measured here, on one thread. Exit code 0: done; 2: bad input; 3: there is no reference, or no
model meets the error.
"""

import argparse
import math
from collections.abc import Iterator, Sequence
from typing import Any

import pandas as pd

from studies.answers.reference import NoReference
from studies.cases.design import Design
from studies.commands import arguments as take
from studies.commands.answer import deliver, not_converged
from studies.commands.columns import cell
from studies.commands.parser import Argument, command
from studies.record.progress import Bar
from studies.work_precision.advice import MOTION_ERRORS, PATH_ERRORS, advise_motion, advise_path


@command(
    take.CASE,
    take.ACCURACY.but("wanted relative error, default 1e-3", default=1e-3),
    Argument("--dynamic", "advise on the motion after the release"),
    take.JSON,
)
def main(arguments: argparse.Namespace) -> int:
    """Try, report; return the exit code."""
    problem = take.turned_design(arguments, "rotation to relate errors to")
    advise, judged = (advise_motion, MOTION_ERRORS) if arguments.dynamic else (advise_path, PATH_ERRORS)
    try:
        with Bar("advise") as bar:
            found = advise(problem, arguments.accuracy, bar)
    except NoReference as error:
        return not_converged(error)
    failure = None if found["meets"].any() else f"no model meets {arguments.accuracy:g} here"
    table = _readable(problem, found, judged, arguments.accuracy)
    return deliver(arguments, _document(found, arguments.accuracy), table, failure=failure)


def _errors_of(found: pd.DataFrame) -> list[str]:
    """Return the columns of errors, judged or told beside."""
    return [name for name in map(str, found) if name.startswith("error_")]


def _document(found: pd.DataFrame, error: float) -> dict[str, Any]:
    """Return the advice as the JSON object of the command."""
    uncertain = ("uncertainty", "uncertainty_stress")
    rows = [
        {
            "model": row["series"],
            "setting": row["setting"],
            "meets": row["meets"],
            **{name: row[name] for name in _errors_of(found)},
            **{f"reference_{name}": row[name] for name in uncertain if name in row},
            "solve_s": row["solve_s"],
            "message": row["message"],
        }
        for row in found.to_dict("records")
    ]
    return {"accuracy": error, "models": rows}


def _readable(problem: Design, found: pd.DataFrame, judged: Sequence[str], error: float) -> Iterator[str]:
    """Yield the lines of a table, the cheapest model that meets the error first."""
    turned = math.degrees(problem.rotation or 0.0)
    names = " and ".join(name.removeprefix("error_") for name in judged)
    yield f"error {error:g} in {names}, from 0 to {turned:.4g} deg"
    told = {"uncertainty": "at most", "uncertainty_stress": "of the stress"}
    most = ", ".join(f"{word} {found[name].max():.1e}" for name, word in told.items() if name in found)
    yield f"error of the references: {most}"
    columns = _errors_of(found)
    head = "".join(f"{name.removeprefix('error_'):>12}" for name in columns)
    yield f"{'model':<27}{'setting':<20}{head}{'time':>12}{'x fastest':>11}"
    ordered = found.sort_values(["meets", "solve_s"], ascending=[False, True])
    fastest = ordered["solve_s"].iloc[0]
    for row in ordered.to_dict("records"):
        errors = "".join(cell(row[name], 12) for name in columns)
        line = f"{row['series']:<27}{row['setting']:<20}{errors}"
        if row["message"]:
            yield f"{line}  {row['message']}"
            continue
        time = f"{1e3 * row['solve_s']:9.3g} ms{row['solve_s'] / fastest:11.3g}"
        yield f"{line}{time}" if row["meets"] else f"{line}{time}  does not meet it: its best"
    if not (found["uncertainty"] <= 0.1 * error).all():
        yield "a reference's own error is more than a tenth of the wanted one: the verdicts are not certain"
