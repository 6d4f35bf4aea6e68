"""Two pivots sized anew: least centre shift, least variation of stiffness, and their trade."""

import math
from functools import cache, partial
from typing import Any

import numpy as np
import pandas as pd

from spline_model.pivot import cross_axis_pivot
from spline_model.sensitivity.parameters import KEYWORDS
from spline_model.sensitivity.solve import sensitivities
from spline_model.statics import solve_statics
from studies.answers.response import Response
from studies.cases.problem import Problem, named_case
from studies.design import figures, margins
from studies.design import task as questions
from studies.design.evaluate import CENTRE_SHIFT, VARIATION, Answers, Measured, answers, by_elements
from studies.design.optimise import Outcome, best, numbered, search
from studies.design.programme import gradient_error
from studies.engine import Answer, Part, Study
from studies.record.digits import Digits
from studies.record.progress import measure, silent

#: Control points of what is timed, and how often it is.
TIMED, REPEAT = (6, 8, 10), 21


@cache
def _baseline(name: str) -> tuple[Problem, Answers]:
    problem = questions.baseline(name)
    return problem, answers(problem)


@cache
def _found(name: str) -> tuple[questions.Task, list[Outcome]]:
    """Return what a question asks and where its starts have led."""
    question = questions.QUESTIONS[name]
    task = question.task(*_baseline(question.baseline))
    return task, search(task, task.starts(questions.STARTS), silent)


def _optimum(name: str) -> Outcome:
    outcome = best(_found(name)[1])
    if outcome is None:
        raise RuntimeError(f"{name}: no start has led to an optimum")
    return outcome


def _searched(name: str) -> Answer:
    """Return a question's optimum and how it was found.

    Tables: starts (a row a start: where it led); history (a row an iteration); active (constraints that hold
    the optimum, and what they cost); resized (sized anew as plates with roots); others as of `_described`.
    """
    task, outcomes = _found(name)
    optimum = _optimum(name)
    given = _described(name, optimum.problem, optimum.answers)
    error = gradient_error(task, questions.variables_of(optimum.problem))
    differences = "differences, extrapolated"
    return {
        **given,
        "checks": [*given["checks"], _check(name, "gradients", differences, math.nan, math.nan, error)],
        "starts": _starts(name, task, outcomes),
        "history": _history(name, outcomes),
        "active": _active(name, optimum),
        "resized": margins.resized(name, task, optimum),
    }


def _described(name: str, problem: Problem, found: Answers) -> dict[str, Any]:
    """Return a design and what the finite elements say of it.

    Tables: designs (variables, objectives, factor); curves (a row a model and rotation); shapes
    (finite-element stations at rest and at the end); checks (splines against finite elements, gradients
    against differences); sections (what each effect of the third dimension changes); tolerances (what
    manufacture does).
    """
    measured, response = by_elements(problem)
    curves = [_curve(name, "spline", found.measured()), _curve(name, "FE", measured)]
    return {
        "designs": _design(name, problem, found),
        "curves": pd.concat(curves),
        "shapes": _shapes(name, response),
        "checks": _checks(name, found, measured),
        "sections": margins.off(name, problem, found),
        "tolerances": margins.toleranced(name, problem, found),
    }


def _trade() -> list[dict[str, Any]]:
    """Return the least centre shift at each limit of the variation, each begun at the one before.

    It lies between the optima of both objectives, and begins at the last one too.
    """
    question, rows = questions.QUESTIONS[questions.WIDE[0]], []
    begin = [_optimum(name).at[:-1] for name in questions.WIDE]
    for limit in questions.TRADE:
        task = question.task(*_baseline(question.baseline), variation=limit)
        found = best(search(task, np.array(begin), silent))
        rows.append(_trade_row(limit, found))
        begin = begin[:2] if found is None else [*begin[:2], found.at[:-1]]
    return rows


def _trade_row(limit: float, found: Outcome | None) -> dict[str, Any]:
    if found is None:
        return {"variation_limit": limit, "status": "none found"}
    return {
        "variation_limit": limit,
        "status": "optimum",
        **_dimensions(questions.variables_of(found.problem)),
        "centre_shift_m": found.answers.largest(CENTRE_SHIFT),
        "variation": found.answers.largest(VARIATION),
    }


def _design(name: str, problem: Problem, found: Answers) -> dict[str, Any]:
    """Return a design's variables and objectives; factors are the baseline's objective over the design's."""
    other = name if name in questions.BASELINES else questions.QUESTIONS[name].baseline
    own, measured = _baseline(other)[1], found.measured()
    reach = float(np.interp(questions.ALLOWABLE, measured.stress, measured.rotation))
    return {
        "design": name,
        "baseline": other,
        **_dimensions(questions.variables_of(problem)),
        "stiffness_Nm_per_rad": found.stiffness,
        "largest_stress_Pa": float(measured.stress.max()),
        "centre_shift_m": found.largest(CENTRE_SHIFT),
        "variation": found.largest(VARIATION),
        **{
            f"factor_{key.replace('-', '_')}": own.largest(key) / found.largest(key)
            for key in questions.OBJECTIVES
        },
        "range_at_500MPa_rad": reach,
    }


def _dimensions(values: Any, before: str = "") -> dict[str, float]:
    return {f"{before}{key}": value for key, value in zip(questions.UNITS, values, strict=True)}


def _curve(name: str, model: str, measured: Measured) -> pd.DataFrame:
    return pd.DataFrame(
        {
            "design": name,
            "model": model,
            "rotation_rad": measured.rotation,
            "centre_shift_m": measured.shift,
            "stiffness_Nm_per_rad": measured.stiffness,
            "largest_stress_Pa": measured.stress,
        }
    )


def _shapes(name: str, response: Response) -> pd.DataFrame:
    rows = []
    for label, state in (("at rest", 0), ("at the end", -1)):
        for strip in range(2):
            x, y = response.shape[state, strip].T
            rows.append(
                pd.DataFrame(
                    {
                        "design": name,
                        "state": label,
                        "strip": strip + 1,
                        "station": response.stations,
                        "x_m": x,
                        "y_m": y,
                    }
                )[:: max(len(x) // 40, 1)]
            )
    return pd.concat(rows)


def _starts(name: str, task: questions.Task, outcomes: list[Outcome]) -> list[dict[str, Any]]:
    return [
        {
            "question": name,
            "start": number,
            **_dimensions(task.values(each.start), "start_"),
            **_dimensions(questions.variables_of(each.problem)),
            "optimum": optimum,
            "objective": each.objective,
            "violation": each.violation,
            "kkt_residual": each.residual,
            "iterations": len(each.history) - 1,
            "paths_solved": each.solved,
            "paths_failed": each.failed,
            "message": each.message,
        }
        for number, (each, optimum) in enumerate(zip(outcomes, numbered(outcomes), strict=True))
    ]


def _history(name: str, outcomes: list[Outcome]) -> list[dict[str, Any]]:
    return [
        {
            "question": name,
            "start": start,
            "iteration": i,
            "objective_over_baseline": value,
            "violation": worst,
        }
        for start, each in enumerate(outcomes)
        for i, (value, worst) in enumerate(each.history)
    ]


def _active(name: str, outcome: Outcome) -> list[dict[str, Any]]:
    return [
        {"question": name, "constraint": each.name, "multiplier": each.multiplier, "price": each.price}
        for each in outcome.active
    ]


def _checks(name: str, found: Answers, elements: Measured) -> list[dict[str, Any]]:
    """Return a row a quantity: splines, finite elements, and their difference over the latter."""
    spline, fe = found.measured().quantities(), elements.quantities()
    rows = {key: (spline[key], fe[key], abs(spline[key] / fe[key] - 1.0)) for key in spline}
    return [_check(name, key, "finite elements", *row) for key, row in rows.items()]


def _check(
    name: str, quantity: str, against: str, value: float, reference: float, error: float
) -> dict[str, Any]:
    """Return a row of the table of checks."""
    row = {"design": name, "quantity": quantity, "against": against}
    return row | {"value": value, "reference": reference, "error": error}


def _timed(count: int) -> Answer:
    """Return the shortest times of a path and of all its sensitivities with so many control points [s].

    `ratio` is the latter over the former; by central differences it would be two paths a parameter,
    `paths_by_differences`, for a fraction of the digits.
    """
    problem = named_case(questions.BASELINES[questions.TABLE_ONE])
    pivot = cross_axis_pivot(**problem.pivot_parameters(), control_points=count)
    keywords: dict[str, Any] = {"rotation": problem.rotation, "increments": problem.increments}
    path = measure(partial(solve_statics, pivot, **keywords), repeat=REPEAT)
    exact = measure(partial(sensitivities, pivot, path.result), repeat=REPEAT)
    row = {
        "control_points": count,
        "parameters": len(KEYWORDS),
        "path_s": min(path.seconds),
        "sensitivities_s": min(exact.seconds),
        "ratio": min(exact.seconds) / min(path.seconds),
        "paths_by_differences": 2 * len(KEYWORDS),
    }
    return {"timings": row}


STUDY = Study(
    cases=tuple(questions.BASELINES.values()),
    parts=(
        Part(at=lambda: questions.BASELINES, ask=lambda name: _described(name, *_baseline(name))),
        Part(at=lambda: questions.QUESTIONS, ask=_searched),
        Part(ask=lambda: {"trade": _trade()}),
        Part(at=lambda: TIMED, ask=_timed, alone=True),
    ),
    claims=margins.CLAIMS,
    varying=("history",),
    digits={
        **dict.fromkeys(("violation", "kkt_residual", "paths_solved")),
        **dict.fromkeys(("checks.error", "resized.error"), Digits(relative=1e-3, floor=1e-7)),
    },
    figures={
        "sizing": lambda tables: figures.designs(tables, questions.TABLE_ONE),
        "sizing_spring_steel": lambda tables: figures.designs(tables, questions.SPRING_STEEL),
        "sizing_search": lambda tables: figures.search(tables, questions.TABLE_ONE),
    },
)
