"""What accuracy costs: one comparison of all models as whole calls, first calls, and the surrogates."""

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import pandas as pd

from report.facts import FACTS, Fact, Results, Stored, Table, holds, listing
from report.forms import angle, count, decade, percent, power, seconds, times, unit

CODES = "cost/codes"
#: Groups of the comparison beside the spline, in the order of the table.
GROUPS = ("spline, by itself", "finite elements", "Exudyn", "Exudyn as delivered", "OpenSees", "surrogates")
TASKS = {"path": Stored(CODES, "path_ratios"), "swing": Stored(CODES, "swing_ratios")}
WAITS = Stored(CODES, "waits_of_time")
SPLINE, ELEMENTS = "spline, n = 6", "80 elements"
TIMES = Stored(CODES, "path_times", group="spline", setting="n = 6")
SURROGATES = "cost/surrogates"
ERRORS, REACHED = Stored(SURROGATES, "errors"), Stored(SURROGATES, "thresholds", level=0.01)
SIMPLE = {
    "linear pivot": "linear pivot",
    "pin joint": "pin joint with a spring",
    "four-bar": "four-bar with springs",
    "beam constraint model": "beam constraint model",
}
#: Splines of four control points that the path of the four-bar is compared with.
FOUR_POINTS = {"paper": "n = 4, as the paper", "free": "n = 4, locking-free"}
QUANTITIES = ("trajectory", "torque", "stiffness")


@listing("cost")
def _cost(results: Results) -> Table:
    """Return all models at equal error: median of whole calls, and ratio to the spline."""
    yield ["task, error", "spline (increments alone)", *GROUPS]
    for task, table in TASKS.items():
        for level, found in sorted(table.rows(results).groupby("level"), reverse=True):
            groups = {str(row["group"]): row for row in found.to_dict("records")}
            error = decade(level) if task == "path" else unit("rad", 1)(level)
            held = [groups.get(group, {"ratio": np.nan}) for group in GROUPS]
            cells = ["–" if pd.isna(row["ratio"]) else _peer(row) for row in held]
            spline = found.iloc[0]
            own = f"{seconds(spline['spline_s'])} ({seconds(spline['spline_solve_s'])})"
            yield [f"{task}, {error}", own, *cells]


def _peer(row: Any) -> str:
    return f"{seconds(row['whole_s'])}, {times(row['ratio'])}"


@listing("waits")
def _waits(results: Results) -> Table:
    models = list(dict.fromkeys(WAITS.rows(results)["model"]))
    yield ["what is waited for", *models]
    for what in ("command line", "import of the suite", "first call"):
        found = (WAITS.rows(results, what=what, model=model).iloc[0] for model in models)
        times_of = ([seconds(row[name]) for name in ("whole_s", "low_s", "high_s")] for row in found)
        yield [what, *(f"{median} ({low} to {high})" for median, low, high in times_of)]


def _waited(results: Results, what: str, model: str = SPLINE) -> float:
    return float(WAITS.value(results, "whole_s", what=what, model=model))


@listing("surrogates")
def _models(results: Results) -> Table:
    yield ["model", *QUANTITIES, "path within 1 % to", "torque to", "stiffness to"]
    for model in (*SIMPLE, *FOUR_POINTS.values(), "n = 6"):
        errors = ERRORS.rows(results, model=model)[list(QUANTITIES)].abs().max()
        ends = (REACHED.value(results, "rotation_deg", model=model, quantity=name) for name in QUANTITIES)
        reached = ("the end" if pd.isna(end) else angle()(end) for end in ends)
        yield [SIMPLE.get(model, f"spline {model}"), *map(percent, errors), *reached]


def _path_errors(results: Results) -> pd.DataFrame:
    """Return the errors of the path by rotation [deg], but for rest, and model."""
    errors = ERRORS.rows(results).pivot(index="rotation_rad", columns="model", values="trajectory").abs()
    errors.index = np.degrees(errors.index)
    return errors[errors.index > 0.0]


def _nearer(results: Results, model: str) -> Any:
    """Return whether the four-bar's path is nearer to the truth than that of `model`, by rotation [deg]."""
    errors = _path_errors(results)
    return errors[model] > errors["four-bar"]


def _turns(model: str, pick: Callable[[Any], Any], results: Results) -> Any:
    nearer = _nearer(results, model)
    return pick(nearer.index[nearer])


def _ratios(results: Results, task: str, group: str, *, fine: bool = True) -> Any:
    """Return how many times the spline's time a group takes, by error; `fine`: but for the coarsest."""
    rows = TASKS[task].rows(results).query("group == @group")
    kept = rows["level"] < rows["level"].max() if fine else rows["level"] > 0.0
    return rows.loc[kept, "ratio"].dropna()


def _extreme(task: str, group: str, pick: Callable[[Any], Any]) -> Fact:
    return Fact(made=lambda r: pick(_ratios(r, task, group)), form=times)


OVER = "the largest error of the torque over the best such model's"
FACTS |= {
    f"cost.{task}.{short}.{name}": _extreme(task, group, pick)
    for task in TASKS
    for short, group in (("exudyn", "Exudyn"), ("fe", "finite elements"))
    for name, pick in (("least", min), ("most", max))
}
FACTS |= {
    f"surrogates.path.{name}.{what}": Fact(made=partial(_turns, model, pick), form=form)
    for name, model in FOUR_POINTS.items()
    for what, pick, form in (("nearer", len, count), ("from", min, angle()), ("to", max, angle()))
}
FACTS |= {
    "cost.path.spline": TASKS["path"].at("spline_solve_s", seconds, group="Exudyn", level=2e-4),
    "cost.path.whole": TASKS["path"].at("spline_s", seconds, group="Exudyn", level=2e-4),
    "cost.path.around": Fact(
        made=lambda r: TIMES.value(r, "whole_s") / TIMES.value(r, "solve_s"), form=times
    ),
    "cost.swing.duration": Stored("paper/fig06_release", "motions").largest("time_s", unit("s", 1)),
    "cost.kept": TASKS["swing"].fact(
        lambda rows: rows.dropna(subset="ratio")["level"].min(), unit("rad", 1), group="Exudyn"
    ),
    "cost.independent": Stored(CODES, "finest").at("torque", power, model="exudyn ancf"),
    "cost.exudyn.version": Stored(CODES, "codes").at("version", str, code="exudyn"),
    "cost.opensees.version": Stored(CODES, "codes").at("version", str, code="openseespy"),
    "waits.command.spline": WAITS.at("whole_s", seconds, what="command line", model=SPLINE),
    "surrogates.states": Fact(made=lambda r: len(_path_errors(r)), form=count),
    "surrogates.over": Stored(SURROGATES, "findings", quantity=OVER).at(
        "value", times, formulation=FOUR_POINTS["paper"]
    ),
}


@holds("cost.surrogates-win", timed=True)
def _(r: Results) -> Any:
    """at the coarsest error of the path a surrogate takes no longer than the spline"""
    return _ratios(r, "path", "surrogates", fine=False).min() <= 1.1


@holds("cost.command-loses", timed=True)
def _(r: Results) -> Any:
    """the command line takes longer with the spline than with elements"""
    return _waited(r, "command line") > _waited(r, "command line", ELEMENTS)


@holds("cost.slower", timed=True)
def _(r: Results) -> Any:
    """elements and other codes take longer than the spline at all but the coarsest error"""
    return all((_ratios(r, task, group) > 1.0).all() for task in TASKS for group in GROUPS[:4])


@holds("surrogates.not-everywhere")
def _(r: Results) -> Any:
    """the four-bar's path is nearer than that of either four-point spline over one range that ends"""
    found = [_nearer(r, model) for model in FOUR_POINTS.values()]
    return all(each.astype(int).diff().abs().sum() == 2 and not each.iloc[-1] for each in found)


@holds("surrogates.six-nearer")
def _(r: Results) -> Any:
    """the path of six control points is nearer than the four-bar's at every rotation"""
    return not _nearer(r, "n = 6").any()


@holds("surrogates.paper-worse")
def _(r: Results) -> Any:
    """the locked spline alone is worse than the best surrogate in something"""
    return set(Stored(SURROGATES, "findings").rows(r, holds="no")["formulation"]) == {FOUR_POINTS["paper"]}
