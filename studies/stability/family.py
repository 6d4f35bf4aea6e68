"""A family of hard cases as a study: outcomes of every model, and how many of each there are."""

from collections.abc import Callable, Iterable, Mapping
from typing import Any

import pandas as pd
from matplotlib.figure import Figure

from studies.engine.findings import Tables
from studies.engine.study import Answer, Part, Study
from studies.stability.columns import ORDER
from studies.stability.outcome import OUTCOMES, Found, judged

CASE = "cross_axis_pivot"

#: A case of one model: name, model, what is asked, and the largest error that is right [1].
Task = tuple[str, str, Callable[[], Found], float]


def family(
    *parts: Part,
    cases: tuple[str, ...] = (CASE,),
    made: Mapping[str, Callable[[Tables], pd.DataFrame | Iterable[dict[str, Any]]]] | None = None,
    figures: Mapping[str, Callable[[Tables], Figure]],
) -> Study:
    """Return the study of a family whose parts give the table `outcomes`; `counts` follows from it."""
    counts = {"counts": lambda tables: counted(tables["outcomes"])}
    return Study(cases=cases, parts=parts, made={**(made or {}), **counts}, figures=figures)


def outcome_of(case: str, model: str, attempt: Callable[[], Found], tolerance: float) -> Answer:
    """Return how one task ends."""
    return {"outcomes": {"case": case, "model": model, **judged(attempt, tolerance).row()}}


def names(tasks: Iterable[Task]) -> list[str]:
    """Return the names of the cases, each once, in their order."""
    return list(dict.fromkeys(case for case, *_ in tasks))


def counted(outcomes: pd.DataFrame) -> pd.DataFrame:
    """Return a row a model of `outcomes`: cases tried, one column an outcome, largest right error."""
    rows = []
    for model in ORDER:
        mine = outcomes[outcomes["model"] == model]
        if mine.empty:
            continue
        found = {outcome: int((mine["outcome"] == outcome).sum()) for outcome in OUTCOMES}
        largest = mine.loc[mine["outcome"] == "right", "error"].max()
        rows.append({"model": model, "tried": len(mine), **found, "largest_right_error": largest})
    return pd.DataFrame(rows)
