"""What accuracy costs: one comparison of all models, what a user waits for, and the surrogates."""

import math
import re
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import pandas as pd

from report.facts import Cell, Fact, Holds, Rows, Table, fact, unmet
from report.forms import count, decade, percent, power, seconds, significant, times, unit
from report.results import Results, absent, at, largest, where

CODES, SURROGATES, WAITS = "baselines/peers", "baselines/surrogates", "work_precision/waits"
STATIC, MOVING = "work_precision/statics", "work_precision/dynamics"
#: Groups of the comparison beside the spline, in the order of the table.
GROUPS = ("finite elements", "Exudyn", "Exudyn as delivered", "OpenSees", "surrogates")
TASKS = {"path": "statics_ratios", "swing": "swings_ratios"}
SIMPLE = {
    "linear pivot": "linear pivot",
    "pin joint": "pin joint with a spring",
    "four-bar": "four-bar with springs",
    "beam constraint model": "beam constraint model",
    "chained constraint model": "the same, chained",
}
#: Splines of four control points that the path of the four-bar is compared with.
FOUR_POINTS = {"paper": "n = 4, as the paper", "free": "n = 4, locking-free"}
#: What a setting's words are shortened to.
SHORT = (
    (r"control_points=(\d+)", r"n = \1"),
    (r"elements=(\d+)", r"\1 el."),
    (r"relative_tolerance=(\S+)", r"tol. \1"),
    (r"tolerance=(\S+)", r"tol. \1"),
    (r"spectral_radius=(\S+)", r"ρ∞ \1"),
    (r"step=(\S+)", lambda found: f"{significant(1e6 * float(found[1]), 2)} µs"),
    (r"integrator=|solver=as delivered|finite elements, |spline, |openseespy frame, ", ""),
    (r"exudyn ", ""),
    (r"integration=(\d)", r"int. \1"),
)


def _setting(words: str) -> str:
    """Return a setting in few words."""
    for pattern, short in SHORT:
        words = re.sub(pattern, short, words)
    return (
        words.strip(" ,")
        .replace("generalised-alpha", "gen.-α")
        .replace("central-difference", "central diff.")
    )


def _timed(setting: str, row: Any, kind: str) -> str:
    median, low, high = (float(row[f"{kind}_{part}"]) for part in ("s", "low_s", "high_s"))
    return f"{_setting(setting)}: {seconds(median)} ({seconds(low)} to {seconds(high)})"


def _cost(results: Results) -> Table:
    """Return all models at equal error: setting, median and quartiles, and the ratio to the spline."""
    rows: Rows = []
    for task, name in TASKS.items():
        table = results.table(CODES, name)
        for level in sorted(set(table["level"]), reverse=True):
            found = table[table["level"] == level].set_index("group")
            error = decade(level) if task == "path" else f"{significant(level, 1)}\u00a0rad"
            first = found.iloc[0]
            cells: list[Cell] = [f"{task}, {error}", _timed(first["spline"], first, "spline")]
            rows.append(cells + [_peer(found, group) for group in GROUPS])
    return ["task, error", "spline", *GROUPS], rows


def _peer(found: pd.DataFrame, group: str) -> str:
    row: Any = found.loc[group] if group in found.index else None
    if row is None or absent(row["ratio"]):
        return "–"
    return f"{_timed(row['peer'], row, 'peer')}, {times(float(row['ratio']))}"


def _waits(results: Results) -> Table:
    table = results.table(WAITS, "waits_of_time")
    models = list(dict.fromkeys(table["model"]))
    rows: Rows = []
    for what in ("command line", "import of the suite", "first call", "whole call", "increments alone"):
        cells: list[Cell] = []
        for model in models:
            row: Any = where(table, what=what, model=model).iloc[0]
            median, low, high = (seconds(float(row[name])) for name in ("solve_s", "low_s", "high_s"))
            cells.append(f"{median} ({low} to {high})")
        rows.append([what, *cells])
    return ["what is waited for", *models], rows


def _waited(results: Results, what: str, model: str = "spline, n = 6") -> float:
    return float(at("solve_s", model=model, what=what)(results.table(WAITS, "waits_of_time")))


def _slower(results: Results, what: str) -> float:
    """How many times the spline's wait the elements' is."""
    return _waited(results, what, "80 elements") / _waited(results, what)


def _around(results: Results, model: str) -> float:
    """How many times its increments a whole call takes."""
    return _waited(results, "whole call", model) / _waited(results, "increments alone", model)


def _models(results: Results) -> Table:
    errors = results.table(SURROGATES, "errors")
    reached = results.table(SURROGATES, "thresholds")
    rows: Rows = []
    for model in (*SIMPLE, "n = 4, as the paper", "n = 4, locking-free", "n = 6"):
        mine = where(errors, model=model)
        cells: list[Cell] = [SIMPLE.get(model, f"spline {model}")]
        cells += [percent(mine[name].abs().max()) for name in ("trajectory", "torque", "stiffness")]
        for quantity in ("trajectory", "torque", "stiffness"):
            row = where(reached, model=model, quantity=quantity, level=0.01).iloc[0]
            cells.append("the end" if absent(row["rotation_deg"]) else _degrees(row["rotation_deg"]))
        rows.append(cells)
    head = ["model", "trajectory", "torque", "stiffness", "path within 1 % to", "torque to", "stiffness to"]
    return head, rows


def _nearer(results: Results, model: str) -> list[float]:
    """Return the rotations [deg] at which the four-bar's path is nearer to the truth than that of `model`."""
    errors = _path_errors(results)
    return [math.degrees(angle) for angle in errors.index[errors[model] > errors["four-bar"]]]


def _path_errors(results: Results) -> pd.DataFrame:
    """Return the errors of the path by rotation, but for rest, and model."""
    table = results.table(SURROGATES, "errors")
    errors = table.pivot(index="rotation_rad", columns="model", values="trajectory").abs()
    return errors[errors.index > 0.0]


def _one_range(results: Results, model: str) -> bool:
    """Return whether the rotations of `_nearer` follow one another, and do not reach the end of the path."""
    angles = np.degrees(_path_errors(results).index)
    nearer = np.isin(angles.round(6), np.round(_nearer(results, model), 6))
    return bool(np.abs(np.diff(nearer.astype(int))).sum() == 2 and not nearer[-1])


def _picked(pick: Callable[[list[float]], Any], model: str, results: Results) -> Any:
    return pick(_nearer(results, model))


def _degrees(value: float) -> str:
    return f"{significant(value, 2)}°"


def _ratios(results: Results, task: str, group: str, *, fine: bool = True) -> "pd.Series[Any]":
    """Return how many times the spline's time a group takes, by error; `fine`: but for the coarsest."""
    table = results.table(CODES, TASKS[task])
    rows = table[table["group"] == group]
    if fine:
        rows = rows[rows["level"] < rows["level"].max()]
    found: pd.Series[Any] = rows["ratio"].dropna()
    return found


def _extreme(task: str, group: str, pick: Callable[[Any], Any]) -> Fact:
    return Fact(made=lambda r: float(pick(_ratios(r, task, group))), form=times)


def _speeds(results: Results, column: str) -> float:
    rows = where(results.table(STATIC, "language"), series="finite elements", setting="20 elements")
    return float(rows[column].iloc[0])


def _cost_unmet(results: Results) -> Table:
    """Return the statements on cost of both studies that do not hold."""
    tables = ((study, name) for study in (STATIC, MOVING) for name in ("findings", "findings_of_time"))
    return unmet(results, tables, partial(significant, digits=3), "measured ratio")


FACTS = {
    **{
        f"cost.{task}.{short}.{name}": _extreme(task, group, pick)
        for task in TASKS
        for short, group in (("exudyn", "Exudyn"), ("fe", "finite elements"))
        for name, pick in (("least", min), ("most", max))
    },
    "cost.path.spline": fact(CODES, "statics_ratios", at("spline_s", group="Exudyn", level=2e-4), seconds),
    "cost.swing.duration": fact("paper/fig06_release", "motions", largest("time_s"), unit("s", 1)),
    "cost.kept": fact(
        CODES,
        "swings_ratios",
        lambda t: t[(t["group"] == "Exudyn") & t["ratio"].notna()]["level"].min(),
        unit("rad", 1),
    ),
    "cost.independent": fact(CODES, "theories", at("torque", what="exudyn ancf, 64 elements"), power),
    "cost.exudyn.version": fact(CODES, "codes", at("version", code="exudyn"), str),
    "cost.opensees.version": fact(CODES, "codes", at("version", code="openseespy"), str),
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
    "cost.python": Fact(made=lambda r: _speeds(r, "python_share"), form=percent),
    "cost.fe20": Fact(made=lambda r: _speeds(r, "solve_s"), form=seconds),
    "cost.fe20.compiled": Fact(made=lambda r: _speeds(r, "compiled_s"), form=seconds),
    "waits.whole.spline": Fact(made=lambda r: _waited(r, "whole call"), form=seconds),
    "waits.slower.whole": Fact(made=lambda r: _slower(r, "whole call"), form=times),
    "waits.slower.increments": Fact(made=lambda r: _slower(r, "increments alone"), form=times),
    "waits.around.spline": Fact(made=lambda r: _around(r, "spline, n = 6"), form=times),
    "waits.around.fe": Fact(made=lambda r: _around(r, "80 elements"), form=times),
    "waits.command.spline": Fact(made=lambda r: _waited(r, "command line"), form=seconds),
    "surrogates.states": Fact(made=lambda r: len(_path_errors(r)), form=count),
    **{
        f"surrogates.path.{name}.{what}": Fact(made=partial(_picked, pick, model), form=form)
        for name, model in FOUR_POINTS.items()
        for what, pick, form in (("nearer", len, count), ("from", min, _degrees), ("to", max, _degrees))
    },
    "surrogates.over": fact(
        SURROGATES,
        "findings",
        at(
            "value",
            formulation="n = 4, as the paper",
            quantity="the largest error of the torque over the best such model's",
        ),
        times,
    ),
    "surrogates.swing": fact(SURROGATES, "motion", largest("difference_rad", model="four-bar"), unit("rad")),
}

HOLDS = {
    "cost.surrogates-win": Holds(
        words="at the coarsest error of the path a surrogate takes no longer than the spline",
        test=lambda r: _ratios(r, "path", "surrogates", fine=False).min() <= 1.1,
        timed=True,
    ),
    "cost.command-loses": Holds(
        words="the command line takes longer with the spline than with elements",
        test=lambda r: _waited(r, "command line") > _waited(r, "command line", "80 elements"),
        timed=True,
    ),
    "cost.slower": Holds(
        words="elements and other codes take longer than the spline at all but the coarsest error",
        test=lambda r: all((_ratios(r, task, group) > 1.0).all() for task in TASKS for group in GROUPS[:4]),
        timed=True,
    ),
    "surrogates.not-everywhere": Holds(
        words="the four-bar's path is nearer than that of either four-point spline over one range that ends",
        test=lambda r: all(_one_range(r, model) for model in FOUR_POINTS.values()),
    ),
    "surrogates.six-nearer": Holds(
        words="the path of six control points is nearer than the four-bar's at every rotation",
        test=lambda r: not _nearer(r, "n = 6"),
    ),
    "surrogates.paper-worse": Holds(
        words="the locked spline alone is worse than the best surrogate in something",
        test=lambda r: (
            set(r.table(SURROGATES, "findings").query("holds == 'no'")["formulation"])
            == {"n = 4, as the paper"}
        ),
    ),
}
LISTINGS = {"cost": _cost, "waits": _waits, "surrogates": _models, "cost-unmet": _cost_unmet}
