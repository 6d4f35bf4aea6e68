"""Designs: charts and where their theory ends, pivots sized by gradients."""

from functools import partial
from typing import Any

import pandas as pd

from report.facts import FACTS, LISTINGS, Fact, Results, Shown, Stored, Table, columns, holds, listing
from report.forms import Form, angle, count, dash, degrees, digits, percent, power, significant, times, unit

RANGES, POINTS, VALIDITY, COLLAPSE, LOADS, LIMITS = (
    Stored("charts/pivot", name) for name in ("ranges", "points", "validity", "collapse", "loads", "limits")
)
#: Strain sigma_y / E and slenderness of the example, the ratios it is asked at, and its strength.
EXAMPLE_STRAIN, EXAMPLE_SLENDERNESS, MIDDLE, SHIFTLESS = 0.005, 40.0, 0.5, 0.1273
EXAMPLE = EXAMPLE_STRAIN * EXAMPLE_SLENDERNESS
#: Slenderness from which on the charts are said to hold.
FROM = 30.0
#: Ways in which a beam is left, by the ratio that says how far, and how that is written.
ENDS: dict[str, tuple[str, Form]] = {
    "width": ("width_ratio", percent),
    "thick": ("thickness_ratio", percent),
    "bent": ("curvature_ratio", significant),
}


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


def _short(pivot: str) -> str:
    return pivot.replace("cross_axis", "reference").replace("_", " ").removesuffix(" pivot")


LISTINGS["validity"] = VALIDITY.table(
    {
        "pivot": ("pivot", _short),
        "to": ("rotation_deg", lambda turn: f"{turn:.0f}°"),
        "t/L": ("thickness_ratio", significant),
        "b/L": ("width_ratio", significant),
        "b²/(R t)": ("curvature_ratio", significant),
        "clamped width": lambda row: f"+{percent(row['clamped_least'])} to +{percent(row['clamped_most'])}",
        "flattening": ("flattened", lambda share: f"+{percent(share)}"),
        "roots": ("roots", percent),
        "shear": ("shear", percent),
    },
    by="thickness_ratio",
)


def _collapse(results: Results, pick: str, *quantities: str) -> float:
    rows = COLLAPSE.rows(results).query("quantity in @quantities and slenderness >= @FROM")
    return float(rows[pick].max())


def _others(results: Results) -> float:
    return _collapse(results, "largest", "stiffness", "stress", "variation")


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


FACTS |= {
    f"charts.{name}-one": LIMITS.at("value", form, ratio=ratio, share=0.01)
    for name, (ratio, form) in ENDS.items()
}
FACTS |= {
    "charts.from": Fact(made=lambda _: FROM, form=significant),
    "charts.collapse.most": Fact(made=_others, form=percent),
    "charts.collapse.shift": Fact(made=lambda r: _collapse(r, "largest", "shift"), form=percent),
    "charts.collapse.shift.median": Fact(made=lambda r: _collapse(r, "median", "shift"), form=percent),
    "charts.example.strain": Fact(made=lambda _: EXAMPLE_STRAIN, form=digits(1)),
    "charts.example.slenderness": Fact(made=lambda _: EXAMPLE_SLENDERNESS, form=significant),
    "charts.example.strength": Fact(made=lambda _: EXAMPLE, form=digits(1)),
    "charts.example.range": RANGES.at("rotation_deg", angle(), crossing_ratio=MIDDLE, strength=EXAMPLE),
    "charts.example.range.shiftless": RANGES.at(
        "rotation_deg", angle(), crossing_ratio=SHIFTLESS, strength=EXAMPLE
    ),
    "charts.example.ratio": Fact(made=lambda _: SHIFTLESS, form=digits(4)),
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
    return all(FACTS[f"charts.{name}-one"].made(r) > 0.0 for name in ENDS)


DESIGNS = Stored("design/sizing", "designs")
BEAMS, EFFECTS, AGAIN, TOLERANCES = "as beams", "with effects", "sized again", "at tolerances"
SHIFT, VARIATION = "least centre shift", "least variation of stiffness"
NARROW, STEEL = ", narrow strips", ", spring steel"
BASELINES = ("Table 1", "spring steel")
#: Short name -> question.
QUESTIONS = {
    "shift": SHIFT,
    "shift.narrow": SHIFT + NARROW,
    "variation": VARIATION,
    "variation.narrow": VARIATION + NARROW,
    "steel.shift": SHIFT + STEEL,
    "steel.variation": VARIATION + STEEL,
}


@listing("sizing")
def _designs(results: Results) -> Table:
    """Return each pivot, and the optimum of each question, with plate effects and supports."""
    shown: Shown = {
        "design": ("design", str),
        "length": ("length_m", unit("mm", 3, 1e3)),
        "inclination": ("inclination_rad", degrees),
        "crossing": ("crossing_ratio", digits(3)),
        "thickness": ("thickness_m", unit("mm", 3, 1e3)),
        "width": ("width_m", unit("mm", 3, 1e3)),
        "shift": ("centre_shift_m", unit("mm", 2, 1e3)),
        "variation": ("variation", percent),
    }
    found: Any = DESIGNS.rows(results).set_index(["design", "basis"], drop=False)
    rows = [(each, EFFECTS) for each in BASELINES] + [(each, AGAIN) for each in QUESTIONS.values()]
    return columns(found.loc[rows], shown)


@listing("sized")
def _sized(results: Results) -> Table:
    """Return the aim of every question by what is taken into account."""
    yield ["design", "pivot it begins from", BEAMS, EFFECTS, AGAIN, TOLERANCES]
    for question in QUESTIONS.values():
        form = unit("mm", 3, 1e3) if _aim(question) == "centre_shift_m" else percent
        cells = [form(_value(results, question, basis)) for basis in (BEAMS, EFFECTS, AGAIN, TOLERANCES)]
        begun = _value(results, _baseline(results, question), EFFECTS, _aim(question))
        yield [question, form(begun), *cells]


def _aim(question: str) -> str:
    return "centre_shift_m" if question.startswith(SHIFT) else "variation"


def _baseline(results: Results, question: str) -> str:
    return str(DESIGNS.value(results, "baseline", design=question, basis=BEAMS))


def _value(results: Results, design: str, basis: str, aim: str = "") -> float:
    return float(DESIGNS.value(results, aim or _aim(design), design=design, basis=basis))


def _gain(results: Results, question: str, basis: str = AGAIN, begun: str = EFFECTS) -> float:
    """Return how many times less the aim of a question is than at the pivot that it begins from."""
    own = _value(results, _baseline(results, question), begun, _aim(question))
    return own / _value(results, question, basis)


def _over(results: Results, basis: str) -> float:
    """Return the most times that the aim of a design that was sized as beams is larger than as beams."""
    return max(_value(results, each, basis) / _value(results, each, BEAMS) for each in QUESTIONS.values())


def _farthest(results: Results) -> float:
    """Return the largest difference of an optimum to the elements."""
    return float(DESIGNS.rows(results)["error"].max())


FACTS |= {
    f"sizing.{name}": Fact(made=partial(_gain, question=each), form=times) for name, each in QUESTIONS.items()
}
FACTS |= {
    "sizing.beams.most": Fact(
        made=lambda r: max(_gain(r, each, BEAMS, BEAMS) for each in QUESTIONS.values()), form=times
    ),
    "sizing.effects.most": Fact(made=lambda r: _over(r, EFFECTS), form=times),
    "sizing.tolerances.most": Fact(made=lambda r: _over(r, TOLERANCES), form=times),
    "sizing.tolerances.stiffness": Fact(
        made=lambda r: (
            max(
                _value(r, each, TOLERANCES, "stiffness_Nm_per_rad")
                / _value(r, each, BEAMS, "stiffness_Nm_per_rad")
                for each in QUESTIONS.values()
            )
            - 1.0
        ),
        form=percent,
    ),
    "sizing.steel.begins": DESIGNS.at(
        "largest_stress_Pa", unit("MPa", 3, 1e-6), design="spring steel", basis=BEAMS
    ),
    "sizing.steel.stress": DESIGNS.largest(
        "largest_stress_Pa", unit("MPa", 3, 1e-6), baseline="spring steel", basis=AGAIN
    ),
    "sizing.elements": Fact(made=_farthest, form=power),
}


@holds("sizing.better")
def _(r: Results) -> Any:
    """each optimum is better than its pivot in what it was asked for, with plate effects and supports"""
    return all(_gain(r, question) > 1.0 for question in QUESTIONS.values())


@holds("sizing.verified")
def _(r: Results) -> Any:
    """finite elements agree with every optimum within 1 %"""
    return _farthest(r) < 0.01


@holds("sizing.wide-better")
def _(r: Results) -> Any:
    """narrow strips gain less than wide ones"""
    return all(_gain(r, question) > _gain(r, question + NARROW) for question in (SHIFT, VARIATION))
