"""Designs: charts and where beam theory ends, effects, pivots sized by gradients."""

from typing import Any

import pandas as pd

from report.facts import FACTS, HOLDS, LISTINGS, Fact, Results, Stored, Table, listing
from report.forms import angle, count, dash, degrees, digits, percent, significant, times, unit

CHARTS = Stored("charts/pivot", "findings")
RANGES, POINTS, VALIDITY = (Stored("charts/pivot", name) for name in ("ranges", "points", "validity"))
WORTH = Stored("effects/worth", "worth", status="converged")


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


@listing("effects")
def _effects(results: Results) -> Table:
    """Return the largest change by leaving out each effect, a column a design."""
    rows = WORTH.rows(results)
    largest = rows.pivot(index="scene", columns="design", values="largest")[list(rows["design"].unique())]
    yield ["left out", *largest.columns]
    yield from ([str(scene), *map(dash(percent), own)] for scene, own in largest.iterrows())


LISTINGS["validity"] = VALIDITY.table(
    {
        "pivot": ("pivot", lambda name: name.replace("cross_axis", "benchmark").replace("_", " ")),
        "rotation": ("rotation_deg", angle()),
        "t/L": ("thickness_ratio", significant),
        "b/L": ("width_ratio", significant),
        "clamping, from": ("clamped_least", percent),
        "to": ("clamped_most", percent),
        "anticlastic": ("flattened", percent),
        "supports": ("roots", percent),
        "shear": ("shear", percent),
    },
    by="thickness_ratio",
)


DESIGNS = Stored("design/sizing", "designs")
BEAMS, EFFECTS, AGAIN, TOLERANCES = "as beams", "with effects", "sized again", "at tolerances"


def _aim(question: str) -> str:
    return "centre_shift_m" if "shift" in question else "variation"


@listing("sizing")
def _sizing(results: Results) -> Table:
    """Return both pivots and the optimum of every question, with plate effects and supports."""
    rows = DESIGNS.rows(results)
    begun = rows[(rows["basis"] == EFFECTS) & (rows["design"] == rows["baseline"])].set_index(
        "design", drop=False
    )
    again = rows[rows["basis"] == AGAIN]
    yield ["design", "L, t, b [mm]", "inclination", "crossing", "shift", "variation", "improvement"]
    for row in [*begun.to_dict("records"), *again.to_dict("records")]:
        aim = _aim(row["design"])
        better = begun.loc[row["baseline"], aim] / row[aim]
        yield [
            row["design"],
            ", ".join(digits(3)(1e3 * row[f"{name}_m"]) for name in ("length", "thickness", "width")),
            degrees(row["inclination_rad"]),
            digits(3)(row["crossing_ratio"]),
            unit("mm", 2, 1e3)(row["centre_shift_m"]),
            percent(row["variation"]),
            times(better) if row["basis"] == AGAIN else "–",
        ]


def _promised(results: Results) -> pd.DataFrame:
    """Return the aim of every question over that as beams, by what is taken into account."""
    rows = DESIGNS.rows(results)
    own: Any = [row[_aim(row["design"])] for row in rows.to_dict("records")]
    aims = rows.assign(aim=own).pivot(index="design", columns="basis", values="aim")
    return aims.loc[aims[AGAIN].notna()].pipe(lambda each: each.div(each[BEAMS], axis=0))


FACTS |= {
    "charts.shift": CHARTS.at("value", percent, formulation="shift"),
    "charts.buckles": Stored("charts/pivot", "buckling").at(
        "load", significant, crossing_ratio=0.5, inclination_deg=45
    ),
    "sizing.effects": Fact(made=lambda r: float(_promised(r)[EFFECTS].max()), form=times),
    "sizing.tolerances": Fact(made=lambda r: float(_promised(r)[TOLERANCES].max()), form=times),
    "sizing.elements": DESIGNS.largest("error", percent),
    "sizing.steel.begins": DESIGNS.at(
        "largest_stress_Pa", unit("MPa", 3, 1e-6), design="spring steel", basis=BEAMS
    ),
    "sizing.steel.stress": DESIGNS.largest(
        "largest_stress_Pa", unit("MPa", 3, 1e-6), baseline="spring steel", basis=AGAIN
    ),
}
HOLDS |= {
    "charts.collapse": CHARTS.found("From a slenderness", "stiffness", "stress", "variation"),
}
