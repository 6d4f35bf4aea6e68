"""What accuracy costs in time and in counted work."""

from typing import Any

import pandas as pd

from report.facts import Cell, Derived, Fact, Holds, Listing, fact
from report.forms import count, decade, percent, seconds, significant, times, unit
from report.pick import absent, at, where
from report.results import Results
from studies.commands.digits import DYNAMICS, STATICS

#: Error of the rotation that the text compares costs at [rad].
SWING_ERROR = 0.01
STATIC, MOVING = "work_precision/statics", "work_precision/dynamics"


def _digits(
    results: Results, study: str, labels: dict[str, str], suffix: str
) -> tuple[list[str], list[list[Cell]]]:
    table = results.table(study, "digits_of_time")
    solved = [name for name in labels if name in set(table["series"])]
    rows: list[list[Cell]] = []
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


FACTS: dict[str, Fact | Derived] = {
    "cost.path.coarse": _cell(STATIC, 1e-3, "spline"),
    "cost.path.fine": _cell(STATIC, 1e-6, "spline"),
    "cost.path.fe": _ratio(STATIC, 1e-3, "finite elements"),
    "cost.swing.error": Derived(made=lambda _: SWING_ERROR, form=unit("rad")),
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
    "cost.python": Derived(made=lambda r: float(_speeds(r)["python_share"].iloc[0]), form=percent),
    "cost.fe20": Derived(made=lambda r: float(_speeds(r)["solve_s"].iloc[0]), form=seconds),
    "cost.fe20.compiled": Derived(made=lambda r: float(_speeds(r)["compiled_s"].iloc[0]), form=seconds),
    "cost.claims.held": Derived(
        made=lambda r: sum(
            int((r.table(study, name)["holds"] == "yes").sum())
            for study in (STATIC, MOVING)
            for name in ("findings", "findings_of_time")
        ),
        form=count,
    ),
    "cost.claims.tried": Derived(
        made=lambda r: sum(
            len(r.table(study, name))
            for study in (STATIC, MOVING)
            for name in ("findings", "findings_of_time")
        ),
        form=count,
    ),
}


def _unmet(results: Results) -> tuple[list[str], list[list[Cell]]]:
    """Return the findings of both studies that do not hold."""
    rows: list[list[Cell]] = []
    for study in (STATIC, MOVING):
        for name in ("findings", "findings_of_time"):
            for row in results.table(study, name).query("holds == 'no'").to_dict("records"):
                rows.append(
                    [str(row["claim"]), str(row["formulation"]), f"{significant(float(row['value']), 3)}"]
                )
    return ["claim that does not hold", "for", "measured ratio"], rows or [["none", "–", "–"]]


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
    "digits-path": Listing(made=lambda r: _digits(r, STATIC, STATICS, "")),
    "digits-swing": Listing(made=lambda r: _digits(r, MOVING, DYNAMICS, "\u00a0rad")),
    "cost-unmet": Listing(made=_unmet),
}
