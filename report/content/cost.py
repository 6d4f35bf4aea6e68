"""What accuracy costs in time and in counted work."""

from functools import partial
from typing import Any

import pandas as pd

from report.facts import Cell, Fact, Holds, Rows, Table, fact, unmet
from report.forms import count, decade, percent, seconds, significant, times, unit
from report.results import Results, absent, at, where
from studies.commands.tables import DYNAMICS, STATICS

#: Error of the rotation that the text compares costs at [rad].
SWING_ERROR = 0.01
STATIC, MOVING = "work_precision/statics", "work_precision/dynamics"


def _digits(results: Results, study: str, labels: dict[str, str], suffix: str) -> Table:
    table = results.table(study, "digits_of_time")
    solved = [name for name in labels if name in set(table["series"])]
    rows: Rows = []
    for target in sorted(set(table["target"]), reverse=True):
        found = table[table["target"] == target].set_index("series")
        cells: list[Cell] = [f"{decade(target) if not suffix else significant(target, 2)}{suffix}"]
        rows.append(cells + [_cost(found.loc[name], name == solved[0]) for name in solved])
    return ["error", *(labels[name] for name in solved)], rows


def _cost(row: Any, first: bool) -> str:
    """Return setting, time and, for all but the first column, how many times that of the first."""
    time, ratio = float(str(row["solve_s"])), float(str(row["ratio"]))
    if absent(time):
        return "–"
    more = "" if first or absent(ratio) else f" ({times(ratio)})"
    return f"{row['setting']}: {seconds(time)}{more}"


def _calls(results: Results) -> Table:
    """Return whole calls and compiled parts of both models at equal error, and the ratio of each."""
    digits, models = results.table(STATIC, "digits_of_time"), ("spline", "finite elements")
    language, timings = (results.table(STATIC, name) for name in ("language", "timings"))
    taken = language.merge(timings[["series", "setting", "wall_s"]], on=["series", "setting"])
    rows: Rows = []
    for target in sorted(set(digits["target"]), reverse=True):
        chosen = digits[(digits["target"] == target) & digits["series"].isin(models)]
        found = chosen.merge(taken, on=["series", "setting"]).set_index("series")
        if len(found) < len(models):
            continue
        curve, beam = (found.loc[name] for name in models)
        cells: list[Cell] = [decade(target), str(curve["setting"]), str(beam["setting"])]
        for part in ("wall_s", "compiled_s"):
            one, other = float(str(curve[part])), float(str(beam[part]))
            cells += [seconds(one), f"{seconds(other)} ({times(other / one)})"]
        rows.append(cells)
    heads = ["whole call, spline", "elements", "compiled, spline", "elements"]
    return ["error", "spline", "elements", *heads], rows


def _cell(study: str, target: float, series: str, column: str = "solve_s") -> Fact:
    return fact(
        study,
        "digits_of_time",
        lambda t: at(column, series=series)(t[(t["target"] / target - 1.0).abs() < 1e-9]),
        seconds,
    )


def _ratio(study: str, target: float, series: str) -> Fact:
    return fact(
        study,
        "digits_of_time",
        lambda t: at("ratio", series=series)(t[(t["target"] / target - 1.0).abs() < 1e-9]),
        times,
    )


def _speeds(results: Results) -> pd.DataFrame:
    table = results.table(STATIC, "language")
    return where(table, series="finite elements", setting="20 elements")


FACTS = {
    "cost.path.coarse": _cell(STATIC, 1e-3, "spline"),
    "cost.path.fine": _cell(STATIC, 1e-6, "spline"),
    "cost.path.fe": _ratio(STATIC, 1e-3, "finite elements"),
    "cost.swing.error": Fact(made=lambda _: SWING_ERROR, form=unit("rad")),
    "cost.swing.spline": _cell(MOVING, SWING_ERROR, "spline"),
    "cost.swing.fe": _ratio(MOVING, SWING_ERROR, "finite elements"),
    "cost.swing.real-time": fact(
        MOVING,
        "findings_of_time",
        at("value", claim="The swing within 0.01 rad is followed five times as fast as it happens"),
        times,
    ),
    "cost.work.fe": fact(
        STATIC,
        "findings",
        at(
            "value",
            claim="At an error of 0.001 in path and torque the spline takes less counted work",
            formulation="finite elements, 20 elements",
        ),
        times,
    ),
    "cost.work.swing": fact(
        MOVING,
        "findings",
        lambda t: t[t["claim"].str.contains("counted work") & t["formulation"].str.startswith("finite")][
            "value"
        ].iloc[0],
        times,
    ),
    "cost.python": Fact(made=lambda r: float(_speeds(r)["python_share"].iloc[0]), form=percent),
    "cost.fe20": Fact(made=lambda r: float(_speeds(r)["solve_s"].iloc[0]), form=seconds),
    "cost.fe20.compiled": Fact(made=lambda r: float(_speeds(r)["compiled_s"].iloc[0]), form=seconds),
    "cost.claims.held": Fact(
        made=lambda r: sum(
            int((r.table(study, name)["holds"] == "yes").sum())
            for study in (STATIC, MOVING)
            for name in ("findings", "findings_of_time")
        ),
        form=count,
    ),
    "cost.claims.tried": Fact(
        made=lambda r: sum(
            len(r.table(study, name))
            for study in (STATIC, MOVING)
            for name in ("findings", "findings_of_time")
        ),
        form=count,
    ),
}


def _unmet(results: Results) -> Table:
    """Return the findings of both studies that do not hold."""
    tables = ((study, name) for study in (STATIC, MOVING) for name in ("findings", "findings_of_time"))
    return unmet(results, tables, partial(significant, digits=3), "measured ratio")


def _cheapest(results: Results) -> bool:
    """Whether the default spline takes less time than what is none at all but the coarsest error."""
    table = results.table(STATIC, "digits_of_time")
    named = table[table["series"].isin(list(STATICS)) & (table["target"] < 0.05)]
    others = named[~named["series"].str.startswith("spline")]
    return bool((others["ratio"].dropna() > 1.0).all())


HOLDS = {
    "cost.path.cheapest": Holds(
        words="at all but the coarsest error the spline takes less time than elements and other codes",
        test=_cheapest,
        timed=True,
    ),
    "cost.swing.cheapest": Holds(
        words="at every error of the swing the spline takes the least time",
        test=lambda r: (
            r.table(MOVING, "digits_of_time")
            .query("series in @names and series != 'spline'", local_dict={"names": list(DYNAMICS)})["ratio"]
            .dropna()
            > 1.0
        ).all(),
        timed=True,
    ),
    "cost.python-most": Holds(
        words="more than half of the time of twenty elements is Python's",
        test=lambda r: float(_speeds(r)["python_share"].iloc[0]) > 0.5,
        timed=True,
    ),
}
LISTINGS = {
    "digits-path": lambda r: _digits(r, STATIC, STATICS, ""),
    "digits-swing": lambda r: _digits(r, MOVING, DYNAMICS, "\u00a0rad"),
    "cost-calls": _calls,
    "cost-unmet": _unmet,
}
