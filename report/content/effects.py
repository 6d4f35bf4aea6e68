"""Which effects matter where."""

import pandas as pd

from report.facts import Fact, Holds, Rows, Table, fact
from report.forms import count, percent, power, significant, times
from report.results import Results, at, distinct, largest, least, where

WORTH = "effects/worth"
QUANTITIES = ("trajectory", "torque", "swing_frequency", "first_mode")


def _worth(results: Results) -> Table:
    table = results.table(WORTH, "worth").query("status != 'refused'")
    designs = list(dict.fromkeys(table["design"]))
    rows: Rows = []
    order = table.groupby("scene")["largest"].max().sort_values(ascending=False).index
    for scene in order:
        found = where(table, scene=scene).set_index("design")["largest"]
        rows.append([scene, *("–" if pd.isna(found[design]) else power(found[design]) for design in designs)])
    return ["left out", *designs], rows


def _cheapest(results: Results) -> Table:
    rows: Rows = [
        [str(row["design"]), str(row["scene"]), power(float(row["largest"]))]
        for row in results.table(WORTH, "cheapest").to_dict("records")
    ]
    return ["design", "cheapest scene that suffices", "its largest change"], rows


def _change(design: str, scene: str) -> Fact:
    return fact(WORTH, "worth", at("largest", design=design, scene=scene), percent)


def _scene_is(results: Results, scene: str, *, within: bool) -> bool:
    """Whether leaving out `scene` keeps every design within the tolerance, or none."""
    tolerance = float(results.table(WORTH, "cheapest")["tolerance"].iloc[0])
    found = where(results.table(WORTH, "worth"), scene=scene)["largest"]
    return bool((found <= tolerance).all() if within else (found > tolerance).all())


def _exponent_miss(results: Results) -> float:
    table: pd.DataFrame = results.table(WORTH, "findings")
    return float(table[table["claim"].str.startswith("The frequency shift by massless")]["value"].iloc[0])


FACTS = {
    "effects.designs": fact(WORTH, "worth", distinct("design"), count),
    "effects.tolerance": fact(WORTH, "cheapest", largest("tolerance"), percent),
    "effects.inextensible": _change("Table 1", "inextensible strips"),
    "effects.massless": _change("Table 1", "massless strips"),
    "effects.massless.light": _change("body ten times lighter", "massless strips"),
    "effects.gravity.slender": _change("ten times more slender", "no gravity"),
    "effects.gravity": _change("Table 1", "no gravity"),
    "effects.rotary": _change("Table 1", "no section rotary inertia"),
    "effects.step.least": fact(
        WORTH,
        "findings",
        lambda t: t[t["claim"].str.startswith("Without stretching")]["value"].min(),
        times,
    ),
    "effects.step.most": fact(
        WORTH,
        "findings",
        lambda t: t[t["claim"].str.startswith("Without stretching")]["value"].max(),
        times,
    ),
    "effects.exponent": Fact(made=_exponent_miss, form=percent),
    "effects.ratio.least": fact(WORTH, "mass_ratio", least("mass_ratio"), significant),
    "effects.ratio.most": fact(WORTH, "mass_ratio", largest("mass_ratio"), significant),
}
HOLDS = {
    "effects.stretching-small": Holds(
        words="inextensible strips keep every design within the tolerance",
        test=lambda r: _scene_is(r, "inextensible strips", within=True),
    ),
    "effects.body-needed": Holds(
        words="without the body's inertia no design is within the tolerance",
        test=lambda r: _scene_is(r, "no body inertia", within=False),
    ),
    "effects.massless-cost": Holds(
        words="massless strips save no time at the same step",
        test=lambda r: (
            (
                r.table(WORTH, "findings_of_time").query(
                    "formulation.str.contains('massless') and holds == 'yes'"
                )
            ).empty
        ),
        timed=True,
    ),
}
LISTINGS = {"effects": _worth, "cheapest": _cheapest}
