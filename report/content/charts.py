"""Design charts: ranges, loads, control points and where the theory ends."""

from functools import partial
from typing import Any

import pandas as pd

from report.content.designs import SPACE
from report.facts import Fact, Holds, Rows, Table, fact
from report.forms import count, percent, significant, unit
from report.results import Results, absent, at, largest, where

CHARTS = "charts/pivot"
#: Strength sigma_y / E and slenderness of the example, and the ratios it is asked at.
EXAMPLE_STRAIN, EXAMPLE_SLENDERNESS, MIDDLE, SHIFTLESS = 0.005, 40.0, 0.5, 0.1273
#: Slenderness from which on the charts are said to hold; a stress that designs of the sample stay below [Pa].
FROM, STRENGTH = 30.0, 600e6
#: What a share of the stiffness is worth saying [1].
ONE = 0.01


def _ranges(results: Results) -> Table:
    table = results.table(CHARTS, "ranges")
    strengths = sorted(set(table["strength"]))
    rows: Rows = []
    for ratio in sorted(set(table["crossing_ratio"])):
        own = where(table, crossing_ratio=ratio).set_index("strength")["rotation_deg"]
        cells = ["–" if absent(own[each]) else f"{significant(own[each], 2)}°" for each in strengths]
        rows.append([f"λ = {significant(ratio, 3)}", *cells])
    return ["crossing ratio", *(f"strength {significant(each, 1)}" for each in strengths)], rows


def _points(results: Results) -> Table:
    table = results.table(CHARTS, "points")
    turns = sorted(set(table["rotation_deg"]))
    rows: Rows = []
    for quantity in ("torque", "stiffness"):
        for level in sorted(set(table["error"]), reverse=True):
            own = where(table, quantity=quantity, error=level).set_index("rotation_deg")["control_points"]
            cells = ["–" if absent(own[turn]) else count(own[turn]) for turn in turns]
            rows.append([f"{quantity} to {percent(level)}", *cells])
    return ["error", *(f"{turn:.0f}°" for turn in turns)], rows


def _validity(results: Results) -> Table:
    rows: Rows = [
        [
            str(row["pivot"])
            .replace("cross_axis_pivot", "reference")
            .replace("_pivot", "")
            .replace("_", " "),
            f"{row['rotation_deg']:.0f}°",
            significant(row["thickness_ratio"]),
            significant(row["width_ratio"]),
            significant(row["curvature_ratio"]),
            f"+{percent(row['clamped_least'])} to +{percent(row['clamped_most'])}",
            f"+{percent(row['flattened'])}",
            percent(row["roots"]),
            percent(row["shear"]),
        ]
        for row in results.table(CHARTS, "validity").sort_values("thickness_ratio").to_dict("records")
    ]
    head = ["pivot", "to", "t/L", "b/L", "b²/(R t)", "clamped width", "flattening", "roots", "shear"]
    return head, rows


def _collapse(results: Results, pick: str, *quantities: str) -> float:
    table = results.table(CHARTS, "collapse")
    rows = table[table["quantity"].isin(quantities) & (table["slenderness"] >= FROM)]
    return float(rows[pick].max())


def _range(results: Results, ratio: float) -> float:
    """Return the example's rotation [deg] within its strength."""
    strength = EXAMPLE_STRAIN * EXAMPLE_SLENDERNESS
    table = results.table(CHARTS, "ranges")
    rows = table[(table["crossing_ratio"] == ratio) & ((table["strength"] - strength).abs() < 1e-9)]
    return float(rows["rotation_deg"].iloc[0])


def _kept(results: Results) -> float:
    """Return the largest rotation [deg] to which four points keep a percent of the torque."""
    table = where(results.table(CHARTS, "points"), quantity="torque", error=0.01)
    return float(table.loc[table["control_points"] <= 4, "rotation_deg"].max())


def _loads(results: Results, ratio: float, direction: str) -> pd.DataFrame:
    table = results.table(CHARTS, "loads")
    return where(table, crossing_ratio=ratio, direction=direction, inclination_deg=45)


def _tips(results: Results) -> float:
    """Return the pull at which the pivot that crosses at mid-length has no stiffness left."""
    rows = _loads(results, MIDDLE, "away from the ground")
    past = int((rows["stiffness"] <= 0.0).to_numpy().argmax())
    load, stiffness = (rows[name].to_numpy()[past - 1 : past + 1] for name in ("load", "stiffness"))
    return float(load[0] + (load[1] - load[0]) * stiffness[0] / (stiffness[0] - stiffness[1]))


def _insensitive(results: Results) -> float:
    """Return how much the stiffness of the pivot without shift changes by loads along its axis."""
    rows = pd.concat([_loads(results, SHIFTLESS, f"{way} the ground") for way in ("towards", "away from")])
    return float((rows["stiffness"] / rows["stiffness"].iloc[0] - 1.0).abs().max())


def _first(column: str, results: Results) -> float:
    """Return the ratio at which what a beam leaves out is a percent."""
    return float(at("value", ratio=column, share=ONE)(results.table(CHARTS, "limits")))


def _deg(digits: int) -> Any:
    return lambda value: f"{significant(value, digits)}°"


FACTS = {
    "charts.from": Fact(made=lambda _: FROM, form=significant),
    "charts.collapse.most": Fact(
        made=lambda r: _collapse(r, "largest", "stiffness", "stress", "variation"), form=percent
    ),
    "charts.collapse.shift": Fact(made=lambda r: _collapse(r, "largest", "shift"), form=percent),
    "charts.collapse.shift.median": Fact(made=lambda r: _collapse(r, "median", "shift"), form=percent),
    "charts.example.strain": Fact(made=lambda _: EXAMPLE_STRAIN, form=lambda v: significant(v, 1)),
    "charts.example.slenderness": Fact(made=lambda _: EXAMPLE_SLENDERNESS, form=significant),
    "charts.example.strength": Fact(
        made=lambda _: EXAMPLE_STRAIN * EXAMPLE_SLENDERNESS, form=lambda v: significant(v, 1)
    ),
    "charts.example.range": Fact(made=lambda r: _range(r, MIDDLE), form=_deg(2)),
    "charts.example.range.shiftless": Fact(made=lambda r: _range(r, SHIFTLESS), form=_deg(2)),
    "charts.example.ratio": Fact(made=lambda _: SHIFTLESS, form=lambda v: significant(v, 4)),
    "charts.farthest": fact(CHARTS, "map", largest("rotation_deg"), _deg(2)),
    "charts.tips": Fact(made=_tips, form=significant),
    "charts.buckles": fact(
        CHARTS, "buckling", at("load", crossing_ratio=MIDDLE, inclination_deg=45), significant
    ),
    "charts.insensitive": Fact(made=_insensitive, form=percent),
    "charts.load": fact(CHARTS, "loads", largest("load"), significant),
    "charts.four": Fact(made=_kept, form=_deg(2)),
    "charts.width-one": Fact(made=partial(_first, "width_ratio"), form=percent),
    "charts.thick-one": Fact(made=partial(_first, "thickness_ratio"), form=percent),
    "charts.bent-one": Fact(made=partial(_first, "curvature_ratio"), form=significant),
    "space.below": fact(SPACE, "designs", lambda t: int((t["stress_max_Pa"] < STRENGTH).sum()), count),
    "space.strength": Fact(made=lambda _: STRENGTH, form=unit("MPa", 1, 1e-6)),
}
HOLDS = {
    "charts.collapse": Holds(
        words="stiffness, stress and variation of pivots of L/t from 30 on are within 1 % of the charts",
        test=lambda r: _collapse(r, "largest", "stiffness", "stress", "variation") < 0.01,
    ),
    "charts.thick-shift": Holds(
        words="the shift of thick strips is farther from the charts than all else",
        test=lambda r: (
            _collapse(r, "largest", "shift") > _collapse(r, "largest", "stiffness", "stress", "variation")
        ),
    ),
    "charts.pulled": Holds(
        words="pulled, a pivot that crosses at mid-length loses its stiffness; pushed, it gains",
        test=lambda r: (
            _loads(r, MIDDLE, "away from the ground")["stiffness"].min() < 0.0
            and _loads(r, MIDDLE, "towards the ground")["stiffness"].is_monotonic_increasing
        ),
    ),
    "charts.insensitive": Holds(
        words="loads change the stiffness of the pivot without shift by less than a quarter",
        test=lambda r: _insensitive(r) < 0.25,
    ),
    "charts.paper-four": Holds(
        words="four control points keep one percent of the torque to some rotation of the charts",
        test=lambda r: _kept(r) > 0.0,
    ),
    "designer.ends": Holds(
        words="each limit of a plain beam lies within the range of the pivots it is taken from",
        test=lambda r: all(
            _first(name, r) > 0.0 for name in ("width_ratio", "thickness_ratio", "curvature_ratio")
        ),
    ),
}
LISTINGS = {"ranges": _ranges, "points": _points, "validity": _validity}
