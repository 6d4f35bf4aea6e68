"""Two pivots sized anew: least centre shift, least variation of stiffness, and their trade."""

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from studies.answers.response import Response
from studies.cases.problem import Problem, named_case
from studies.design import figures, questions
from studies.design.cost import timings
from studies.design.evaluate import Answers, answers
from studies.design.optimise import Outcome, best, numbered, search, starts
from studies.design.questions import BASELINES, QUESTIONS, SPRING_STEEL, STARTS, TABLE_ONE, TRADE
from studies.design.task import CENTRE_SHIFT, OBJECTIVES, VARIATION, Task, variables_of
from studies.design.verify import Measured, by_elements, gradient_error, of_spline
from studies.record.progress import silent

CASES = tuple(BASELINES.values())

UNITS = ("length_m", "inclination_rad", "crossing_ratio", "thickness_m", "width_m")


def compute(progress: Callable[[int, int], None]) -> dict[str, pd.DataFrame]:
    """Return the designs found, how they were searched for, and what the finite elements say of them.

    Tables: designs (a row a question and baseline: variables, objectives, factor); curves (a row a design,
    model and rotation); shapes (finite-element stations at rest and at the end); starts (a row a start:
    where it led); history (a row an iteration); active (constraints that hold each optimum, and what they
    cost); checks (splines against finite elements, gradients against differences); trade (a row a limit of
    the variation); timings (sensitivities beside their path).
    """
    baselines = {name: questions.baseline(name) for name in BASELINES}
    own = {name: answers(problem) for name, problem in baselines.items()}
    total = len(QUESTIONS) * STARTS + len(TRADE)
    found: dict[str, tuple[Task, list[Outcome]]] = {}
    for i, (name, question) in enumerate(QUESTIONS.items()):
        task = questions.task(baselines[question.baseline], own[question.baseline], question)
        found[name] = task, search(task, starts(task, STARTS), _part(progress, i * STARTS, total))
    optima = {name: _required(name, best(outcomes)) for name, (_, outcomes) in found.items()}
    designs = {name: (baselines[name], own[name]) for name in BASELINES} | {
        name: (each.problem, each.answers) for name, each in optima.items()
    }
    elements = {name: by_elements(problem) for name, (problem, _) in designs.items()}
    ends = [optima[name] for name in questions.WIDE]
    table_one = baselines[TABLE_ONE], own[TABLE_ONE]
    trade = _trade(*table_one, ends, _part(progress, total - len(TRADE), total))
    progress(total, total)
    return {
        "designs": pd.DataFrame([_design(name, *each, own) for name, each in designs.items()]),
        "curves": pd.concat(
            [_curve(name, "spline", of_spline(each)) for name, (_, each) in designs.items()]
            + [_curve(name, "FE", measured) for name, (measured, _) in elements.items()]
        ),
        "shapes": pd.concat([_shapes(name, response) for name, (_, response) in elements.items()]),
        "starts": pd.DataFrame([row for name, each in found.items() for row in _starts(name, *each)]),
        "history": pd.DataFrame([row for name, (_, each) in found.items() for row in _history(name, each)]),
        "active": pd.DataFrame([row for name, each in optima.items() for row in _active(name, each)]),
        "checks": pd.DataFrame(
            [row for name, (_, each) in designs.items() for row in _checks(name, each, elements[name][0])]
            + [_gradient(name, found[name][0], each) for name, each in optima.items()]
        ),
        "trade": pd.DataFrame(trade),
        "timings": pd.DataFrame(timings(named_case(BASELINES[TABLE_ONE]))),
    }


def draw(tables: Mapping[str, pd.DataFrame]) -> dict[str, Figure]:
    """Draw the designs to scale with their answers, and how they were found."""
    return {
        "sizing": figures.designs(tables, TABLE_ONE),
        "sizing_spring_steel": figures.designs(tables, SPRING_STEEL),
        "sizing_search": figures.search(tables, TABLE_ONE),
    }


def _part(progress: Callable[[int, int], None], before: int, total: int) -> Callable[[int, int], None]:
    """Return the progress of a part that comes after ``before`` of ``total``."""
    return lambda done, _: progress(before + done, total)


def _required(name: str, outcome: Outcome | None) -> Outcome:
    if outcome is None:
        raise RuntimeError(f"{name}: no start has led to an optimum")
    return outcome


def _trade(
    start: Problem, own: Answers, ends: Sequence[Outcome], progress: Callable[[int, int], None]
) -> list[dict[str, Any]]:
    """Return the least centre shift at each limit of the variation, each begun at the one before.

    ends: the optima of both objectives, between which the trade lies; it begins at the last one too.
    """
    rows: list[dict[str, Any]] = []
    begin = [each.at[:5] for each in ends]
    for limit in TRADE:
        progress(len(rows), len(TRADE))
        task = questions.task(start, own, QUESTIONS[questions.WIDE[0]], variation=limit)
        found = best(search(task, np.array(begin), silent))
        rows.append(_trade_row(limit, found))
        begin = begin[:2] if found is None else [*begin[:2], found.at[:5]]
    return rows


def _trade_row(limit: float, found: Outcome | None) -> dict[str, Any]:
    if found is None:
        return {"variation_limit": limit, "status": "none found"}
    return {
        "variation_limit": limit,
        "status": "optimum",
        **dict(zip(UNITS, variables_of(found.problem), strict=True)),
        "centre_shift_m": found.answers.largest(CENTRE_SHIFT),
        "variation": found.answers.largest(VARIATION),
    }


def _design(name: str, problem: Problem, found: Answers, own: Mapping[str, Answers]) -> dict[str, Any]:
    """Return a design's variables and objectives; factors are the baseline's objective over the design's."""
    baseline = name if name in BASELINES else QUESTIONS[name].baseline
    measured = of_spline(found)
    reach = float(np.interp(questions.ALLOWABLE, measured.stress, measured.rotation))
    return {
        "design": name,
        "baseline": baseline,
        **dict(zip(UNITS, variables_of(problem), strict=True)),
        "stiffness_Nm_per_rad": found.stiffness,
        "largest_stress_Pa": float(measured.stress.max()),
        "centre_shift_m": found.largest(CENTRE_SHIFT),
        "variation": found.largest(VARIATION),
        **{
            f"factor_{key.replace('-', '_')}": own[baseline].largest(key) / found.largest(key)
            for key in OBJECTIVES
        },
        "range_at_500MPa_rad": reach,
    }


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


def _starts(name: str, task: Task, outcomes: list[Outcome]) -> list[dict[str, Any]]:
    return [
        {
            "question": name,
            "start": number,
            **{f"start_{key}": value for key, value in _in_units(task, each.start)},
            **dict(zip(UNITS, variables_of(each.problem), strict=True)),
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


def _in_units(task: Task, scaled: np.ndarray) -> list[tuple[str, float]]:
    return list(zip(UNITS, task.low + task.span * scaled, strict=True))


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
    spline, fe = of_spline(found).quantities(), elements.quantities()
    return [
        {
            "design": name,
            "quantity": key,
            "against": "finite elements",
            "value": spline[key],
            "reference": fe[key],
            "error": abs(spline[key] / fe[key] - 1.0),
        }
        for key in spline
    ]


def _gradient(name: str, task: Task, outcome: Outcome) -> dict[str, Any]:
    return {
        "design": name,
        "quantity": "gradients",
        "against": "differences, extrapolated",
        "value": math.nan,
        "reference": math.nan,
        "error": gradient_error(task, outcome.problem),
    }
