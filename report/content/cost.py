"""What accuracy costs: all models as whole calls at equal error, and simpler models."""

from collections.abc import Callable
from typing import Any

import pandas as pd

from report.facts import FACTS, HOLDS, Fact, Results, Stored, Table, listing
from report.forms import angle, decade, percent, seconds, times, unit

CODES = "cost/codes"
#: Groups of the comparison in addition to the spline, in the order of the table.
GROUPS = ("spline, by itself", "finite elements", "Exudyn", "Exudyn as delivered", "OpenSees", "surrogates")
#: Task -> its stored table, and how an error is written.
TASKS = {
    "path": (Stored(CODES, "path_ratios"), decade),
    "swing": (Stored(CODES, "swing_ratios"), unit("rad", 1)),
}
SIMPLE = ("linear pivot", "pin joint", "four-bar", "beam constraint model")
SPLINES = ("n = 4, as the paper", "n = 4, locking-free", "n = 6")
QUANTITIES = ("trajectory", "torque", "stiffness")
SURROGATES = Stored("cost/surrogates", "findings")


@listing("cost")
def _cost(results: Results) -> Table:
    """Return all models at equal error: median of whole calls, and ratio to the spline."""
    yield ["task, error", "spline (increments alone)", *GROUPS]
    for task, (stored, form) in TASKS.items():
        for level, rows in sorted(stored.rows(results).groupby("level"), reverse=True):
            groups: Any = rows.set_index("group")
            spline = rows.iloc[0]
            own = f"{seconds(spline['spline_s'])} ({seconds(spline['spline_solve_s'])})"
            yield [f"{task}, {form(level)}", own, *(_peer(groups, group) for group in GROUPS)]


def _peer(groups: Any, group: str) -> str:
    """Return time and ratio of a group; a dash where none of its settings keeps the error."""
    if group not in groups.index or pd.isna(groups.loc[group, "ratio"]):
        return "–"
    return f"{seconds(groups.loc[group, 'whole_s'])}, {times(groups.loc[group, 'ratio'])}"


@listing("surrogates")
def _surrogates(results: Results) -> Table:
    """Return up to which rotation each simple model, and each spline beside them, keeps one percent."""
    reached = Stored("cost/surrogates", "thresholds", level=0.01).rows(results)
    ends: Any = reached.pivot(index="model", columns="quantity", values="rotation_deg")
    yield ["error below 1 % up to", *QUANTITIES]
    for model in (*SIMPLE, *SPLINES):
        own = (ends.loc[model, quantity] for quantity in QUANTITIES)
        yield [model, *("the end" if pd.isna(end) else angle()(end) for end in own)]


def _nearer(results: Results) -> float:
    """Return the share of the rotations at which the four-bar's path is nearer than the paper's spline's."""
    rows = Stored("cost/surrogates", "errors").rows(results).query("rotation_rad > 0.0")
    errors = rows.pivot(index="rotation_rad", columns="model", values="trajectory").abs()
    return float((errors["four-bar"] < errors[SPLINES[0]]).mean())


def _extreme(task: str, group: str, pick: Callable[[Any], Any]) -> Fact:
    """Return the least or largest ratio of a group over all errors."""
    return Fact(made=lambda r: pick(TASKS[task][0].rows(r, group=group)["ratio"].dropna()), form=times)


WAITS = Stored(CODES, "waits_of_time", what="command line")
FACTS |= {
    f"cost.{task}.{short}.{name}": _extreme(task, group, pick)
    for task in TASKS
    for short, group in (("exudyn", "Exudyn"), ("fe", "finite elements"))
    for name, pick in (("least", min), ("most", max))
}
FACTS |= {
    "cost.surrogates": _extreme("path", "surrogates", min),
    "cost.path.spline": TASKS["path"][0].at("spline_solve_s", seconds, group="Exudyn", level=2e-4),
    "cost.path.whole": TASKS["path"][0].at("spline_s", seconds, group="Exudyn", level=2e-4),
    "cost.command.spline": WAITS.at("whole_s", seconds, model="spline, n = 6"),
    "cost.command.fe": WAITS.at("whole_s", seconds, model="80 elements"),
    "cost.independent": Stored(CODES, "finest").at("torque", percent, model="exudyn ancf"),
    "surrogates.nearer": Fact(made=_nearer, form=percent),
    "surrogates.torque": SURROGATES.at(
        "value",
        times,
        quantity="the largest error of the torque over the best such model's",
        formulation=SPLINES[0],
    ),
}
HOLDS |= {"surrogates.free": SURROGATES.found("Dynamic splines are more accurate", *SPLINES[1:])}
