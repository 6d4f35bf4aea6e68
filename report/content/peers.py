"""Other models and other codes."""

import math
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import pandas as pd

from report.facts import Cell, Fact, Holds, Rows, Table, fact
from report.forms import count, decade, percent, seconds, significant, times, unit
from report.results import Results, absent, at, largest, where

CODES, SURROGATES = "baselines/peers", "baselines/surrogates"
#: Groups of the ratios, in the order of the table.
GROUPS = ("Exudyn", "Exudyn as delivered", "OpenSees")
SIMPLE = {
    "linear pivot": "linear pivot",
    "pin joint": "pin joint with a spring",
    "four-bar": "four-bar with springs",
    "beam constraint model": "beam constraint model",
    "chained constraint model": "the same, chained",
}
#: Splines of four control points that the path of the four-bar is compared with.
FOUR_POINTS = {"paper": "n = 4, as the paper", "free": "n = 4, locking-free"}


def _ratios(results: Results) -> Table:
    rows: Rows = []
    tables = (("path to 90°", "statics_ratios", ""), ("swing", "swings_ratios", "\u00a0rad"))
    for task, name, unit_ in tables:
        table = results.table(CODES, name)
        if "criterion" in table:
            table = table[table["criterion"] == "reached"]
        for level in sorted(set(table["level"]), reverse=True):
            found = table[table["level"] == level].set_index("group")
            shown = decade(level) if not unit_ else significant(level)
            row: list[Cell] = [f"{task}, {shown}{unit_}", seconds(float(found["spline_s"].iloc[0]))]
            rows.append(row + [_peer(found, group) for group in GROUPS])
    return ["task and error", "spline", *GROUPS], rows


def _peer(found: pd.DataFrame, group: str) -> str:
    if group not in found.index:
        return "not tried"
    row: Any = found.loc[group]
    if absent(row["ratio"]):
        return f"not reached (up to {seconds(float(row['tried_s']))})"
    return f"{seconds(float(row['peer_s']))} ({times(float(row['ratio']))})"


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
            cells.append(
                "the end" if absent(row["rotation_deg"]) else f"{significant(row['rotation_deg'], 2)}°"
            )
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


def _lowest(results: Results, table: str, group: str) -> float:
    found = where(results.table(CODES, table), group=group)["ratio"].dropna()
    return float(found.min())


def _picked(pick: Callable[[list[float]], Any], model: str, results: Results) -> Any:
    return pick(_nearer(results, model))


def _degrees(value: float) -> str:
    return f"{significant(value, 2)}°"


FACTS = {
    "peers.exudyn.version": fact(CODES, "codes", at("version", code="exudyn"), str),
    "peers.opensees.version": fact(CODES, "codes", at("version", code="openseespy"), str),
    "peers.path.least": Fact(made=lambda r: _lowest(r, "statics_ratios", "Exudyn"), form=times),
    "peers.path.most": fact(CODES, "statics_ratios", largest("ratio", group="Exudyn"), times),
    "peers.swing.least": Fact(made=lambda r: _lowest(r, "swings_ratios", "Exudyn"), form=times),
    "peers.swing.most": fact(CODES, "swings_ratios", largest("ratio", group="Exudyn"), times),
    "peers.wanted.tried": fact(CODES, "findings_of_time", len, lambda v: str(int(v))),
    "peers.wanted.path": fact(
        CODES, "findings_of_time", at("claim", formulation="static path, errors of 1e-06"), str
    ),
    "peers.wanted.found": fact(
        CODES, "findings_of_time", at("value", formulation="static path, errors of 1e-06"), times
    ),
    "surrogates.best.torque": fact(SURROGATES, "errors", largest("torque", model="four-bar"), percent),
    "surrogates.free.torque": fact(
        SURROGATES, "errors", largest("torque", model="n = 4, locking-free"), percent
    ),
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
    "peers.agree": Holds(
        words="refined, both codes agree with the references of their theories to 1e-5",
        test=lambda r: (
            r.table(CODES, "theories")
            .query("what.str.contains('elements')")[["trajectory", "torque"]]
            .max()
            .max()
            < 1e-5
        ),
    ),
    "peers.slower": Holds(
        words="the fastest setting of either code takes longer than the spline at every error of either task",
        test=lambda r: all(
            _lowest(r, table, group) > 1.0
            for table in ("statics_ratios", "swings_ratios")
            for group in ("Exudyn", "OpenSees")
        ),
        timed=True,
    ),
    "peers.wanted-missed": Holds(
        words="none of the factors that were wished for against Exudyn is reached",
        test=lambda r: (r.table(CODES, "findings_of_time")["holds"] == "no").all(),
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
LISTINGS = {"peer-ratios": _ratios, "surrogates": _models}
