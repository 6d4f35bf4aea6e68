"""Design charts: ranges, loads, control points and where the theory ends."""

from typing import Any

import pandas as pd

from report.facts import FACTS, Fact, Results, Shown, Stored, Table, columns, holds, listing
from report.forms import angle, count, dash, digits, percent, significant

RANGES, POINTS, VALIDITY, COLLAPSE, LOADS, LIMITS = (
    Stored("charts/pivot", name) for name in ("ranges", "points", "validity", "collapse", "loads", "limits")
)
#: Strength sigma_y / E and slenderness of the example, and the ratios it is asked at.
EXAMPLE_STRAIN, EXAMPLE_SLENDERNESS, MIDDLE, SHIFTLESS = 0.005, 40.0, 0.5, 0.1273
#: Slenderness from which on the charts are said to hold.
FROM = 30.0
#: Ways in which a beam is left, by the ratio that says how far.
ENDS = {"width": "width_ratio", "thick": "thickness_ratio", "bent": "curvature_ratio"}


@listing("ranges")
def _ranges(results: Results) -> Table:
    found = RANGES.rows(results).pivot(index="crossing_ratio", columns="strength", values="rotation_deg")
    yield ["crossing ratio", *(f"strength {significant(each, 1)}" for each in found.columns)]
    for ratio, own in found.iterrows():
        yield [f"λ = {significant(ratio, 3)}", *map(dash(angle()), own)]


@listing("points")
def _points(results: Results) -> Table:
    found = POINTS.rows(results).pivot(
        index=["quantity", "error"], columns="rotation_deg", values="control_points"
    )
    yield ["error", *(f"{turn:.0f}°" for turn in found.columns)]
    for row in found.sort_index(ascending=False).reset_index().to_dict("split")["data"]:
        yield [f"{row[0]} to {percent(row[1])}", *map(dash(count), row[2:])]


@listing("validity")
def _validity(results: Results) -> Table:
    pivots = VALIDITY.rows(results).sort_values("thickness_ratio")
    shown: Shown = {
        "pivot": (
            "pivot",
            lambda name: (
                "reference" if "cross_axis" in name else name.replace("_", " ").removesuffix(" pivot")
            ),
        ),
        "to": ("rotation_deg", lambda turn: f"{turn:.0f}°"),
        "t/L": ("thickness_ratio", significant),
        "b/L": ("width_ratio", significant),
        "b²/(R t)": ("curvature_ratio", significant),
        "clamped width": lambda row: f"+{percent(row['clamped_least'])} to +{percent(row['clamped_most'])}",
        "flattening": ("flattened", lambda share: f"+{percent(share)}"),
        "roots": ("roots", percent),
        "shear": ("shear", percent),
    }
    return columns(pivots, shown)


def _collapse(results: Results, pick: str, *quantities: str) -> float:
    table = COLLAPSE.rows(results)
    rows = table[table["quantity"].isin(quantities) & (table["slenderness"] >= FROM)]
    return float(rows[pick].max())


def _others(results: Results) -> float:
    return _collapse(results, "largest", "stiffness", "stress", "variation")


def _range(ratio: float) -> Fact:
    """Return the example's rotation [deg] within its strength."""

    def pick(rows: pd.DataFrame) -> float:
        within = (rows["strength"] - EXAMPLE_STRAIN * EXAMPLE_SLENDERNESS).abs() < 1e-9
        return float(rows.loc[within, "rotation_deg"].iloc[0])

    return RANGES.fact(pick, angle(), crossing_ratio=ratio)


def _kept(results: Results) -> float:
    """Return the largest rotation [deg] to which four points keep a percent of the torque."""
    table = POINTS.rows(results, quantity="torque", error=0.01)
    return float(table.loc[table["control_points"] <= 4, "rotation_deg"].max())


def _loads(results: Results, ratio: float, direction: str) -> pd.DataFrame:
    return LOADS.rows(results, crossing_ratio=ratio, direction=f"{direction} the ground", inclination_deg=45)


def _tips(results: Results) -> float:
    """Return the pull at which the pivot that crosses at mid-length has no stiffness left."""
    rows = _loads(results, MIDDLE, "away from")
    past = int((rows["stiffness"] <= 0.0).to_numpy().argmax())
    load, stiffness = (rows[name].to_numpy()[past - 1 : past + 1] for name in ("load", "stiffness"))
    return float(load[0] + (load[1] - load[0]) * stiffness[0] / (stiffness[0] - stiffness[1]))


def _insensitive(results: Results) -> float:
    """Return how much the stiffness of the pivot without shift changes by loads along its axis."""
    rows = pd.concat([_loads(results, SHIFTLESS, way) for way in ("towards", "away from")])
    return float((rows["stiffness"] / rows["stiffness"].iloc[0] - 1.0).abs().max())


def _first(name: str) -> Fact:
    """Return the ratio at which what a beam leaves out is a percent."""
    form = significant if name == "bent" else percent
    return LIMITS.at("value", form, ratio=ENDS[name], share=0.01)


FACTS |= {f"charts.{name}-one": _first(name) for name in ENDS}
FACTS |= {
    "charts.from": Fact(made=lambda _: FROM, form=significant),
    "charts.collapse.most": Fact(made=_others, form=percent),
    "charts.collapse.shift": Fact(made=lambda r: _collapse(r, "largest", "shift"), form=percent),
    "charts.collapse.shift.median": Fact(made=lambda r: _collapse(r, "median", "shift"), form=percent),
    "charts.example.strain": Fact(made=lambda _: EXAMPLE_STRAIN, form=digits(1)),
    "charts.example.slenderness": Fact(made=lambda _: EXAMPLE_SLENDERNESS, form=significant),
    "charts.example.strength": Fact(made=lambda _: EXAMPLE_STRAIN * EXAMPLE_SLENDERNESS, form=digits(1)),
    "charts.example.range": _range(MIDDLE),
    "charts.example.range.shiftless": _range(SHIFTLESS),
    "charts.example.ratio": Fact(made=lambda _: SHIFTLESS, form=digits(4)),
    "charts.farthest": Stored("charts/pivot", "map").largest("rotation_deg", angle()),
    "charts.tips": Fact(made=_tips, form=significant),
    "charts.buckles": Stored("charts/pivot", "buckling").at(
        "load", significant, crossing_ratio=MIDDLE, inclination_deg=45
    ),
    "charts.insensitive": Fact(made=_insensitive, form=percent),
    "charts.load": LOADS.largest("load", significant),
    "charts.four": Fact(made=_kept, form=angle()),
}


@holds("charts.collapse")
def _(r: Results) -> Any:
    """stiffness, stress and variation of pivots of L/t from 30 on are within 1 % of the charts"""
    return _others(r) < 0.01


@holds("charts.thick-shift")
def _(r: Results) -> Any:
    """the shift of thick strips is farther from the charts than all else"""
    return _collapse(r, "largest", "shift") > _others(r)


@holds("charts.pulled")
def _(r: Results) -> Any:
    """pulled, a pivot that crosses at mid-length loses its stiffness; pushed, it gains"""
    pulled, pushed = (_loads(r, MIDDLE, way)["stiffness"] for way in ("away from", "towards"))
    return pulled.min() < 0.0 and pushed.is_monotonic_increasing


@holds("charts.insensitive")
def _(r: Results) -> Any:
    """loads change the stiffness of the pivot without shift by less than a quarter"""
    return _insensitive(r) < 0.25


@holds("charts.paper-four")
def _(r: Results) -> Any:
    """four control points keep one percent of the torque to some rotation of the charts"""
    return _kept(r) > 0.0


@holds("designer.ends")
def _(r: Results) -> Any:
    """each limit of a plain beam lies within the range of the pivots it is taken from"""
    return all(_first(name).made(r) > 0.0 for name in ENDS)
