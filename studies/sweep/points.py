"""One chunk of a sweep: its designs solved, a row each, whatever becomes of them."""

import copy
from collections.abc import Mapping
from typing import Any

import numpy as np

from studies.answers.adapters import answer_modes, answer_release
from studies.answers.settings import FeSettings, Settings, SplineSettings
from studies.cases.design import Design
from studies.cases.mechanism import read_mechanism
from studies.cases.problem import read_problem
from studies.errors import BadInput
from studies.sweep import quantities
from studies.sweep.designs import keys
from studies.sweep.designs.plan import Task
from studies.sweep.quantities import Answer, Quantity
from studies.sweep.static import CONVERGED, NOT_CONVERGED, static_answer

REFUSED, FAILED = "refused", "failed"
#: Columns beside keys and quantities.
POINT, STATUS, REASON = "point", "status", "reason"


def stored(task: Task) -> dict[str, Quantity]:
    """Return the quantities that the task stores, by name, in their order."""
    found = known(task.case, task.analysis.kind, task.analysis.options.get("count", 0))
    return {name: found[name] for name in task.quantities}


def known(case: Mapping[str, Any], kind: str, count: int) -> dict[str, Quantity]:
    """Return all quantities of an analysis of the case's document."""
    mechanism = isinstance(case.get("strips"), list)
    bodies = [body["name"] for body in case.get("bodies", [])] if mechanism else None
    return quantities.known(kind, bodies=bodies, count=count)


def solve_each(
    task: Task, designs: list[dict[str, Any]]
) -> tuple[list[str], list[str], dict[str, list[float]]]:
    """Solve designs one by one; returns status, reason and quantities as columns."""
    status, reason = [], []
    found: dict[str, list[float]] = {name: [] for name in task.quantities}
    table = stored(task)
    for design in designs:
        how, why, answer = _answered(task, design)
        status.append(how)
        reason.append(why)
        if answer is None:
            row = dict.fromkeys(task.quantities, np.nan)
        else:
            row = {
                name: values[0] for name, values in quantities.values(table, task.quantities, answer).items()
            }
        for name, value in row.items():
            found[name].append(float(value))
    return status, reason, found


def design_of(task: Task, values: Mapping[str, Any]) -> Design:
    """Return one design of the sweep; CaseError where a value is out of its range."""
    document = copy.deepcopy(task.case)
    keys.put_all(document, values)
    read = read_mechanism if isinstance(document.get("strips"), list) else read_problem
    return read(task.where, document)


def settings_of(model: str, given: Mapping[str, Any]) -> Settings:
    """Return the settings of a model; a spline of a sweep has 6 control points unless said otherwise."""
    if model == "spline":
        return SplineSettings(**{"control_points": 6, **given})
    return FeSettings(element="reissner" if model == "fe-shear" else "corotational", **given)


def varied_settings(task: Task, values: Mapping[str, Any]) -> dict[str, Any]:
    """Return the settings of one design: those of the sweep, and those that it varies."""
    own = {
        key.partition(".")[2]: value for key, value in values.items() if key.startswith(f"{keys.SETTINGS}.")
    }
    return task.settings | own


def _answered(task: Task, values: Mapping[str, Any]) -> tuple[str, str, Answer | None]:
    """Return status, reason and answer of one design."""
    try:
        design = design_of(task, values)
        settings = settings_of(task.model, varied_settings(task, values))
        return _solved(task, design, settings)
    except BadInput as error:
        return REFUSED, str(error), None
    except Exception as error:  # a fault at one design must not cost the others: it is told in its row
        return FAILED, f"{type(error).__name__}: {error}".splitlines()[0], None


def _solved(task: Task, design: Design, settings: Settings) -> tuple[str, str, Answer | None]:
    options = task.analysis.options
    answer: Answer
    if task.analysis.kind == "static":
        return static_answer(design, settings, both_sides=task.analysis.both_sides)
    if task.analysis.kind == "modes":
        answer = answer_modes(design, settings, **options)
    else:
        answer = answer_release(design, settings, **options)
    return (CONVERGED if answer.converged else NOT_CONVERGED), answer.message, answer
