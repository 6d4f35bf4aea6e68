"""Which effects matter where, what the paper leaves open, and its solver: sequential impulses."""

from collections.abc import Callable
from typing import Any

from report.content.basis import TORQUE
from report.facts import FACTS, LISTINGS, Cell, Results, Shown, Stored, Table, columns, holds, listing
from report.forms import Form, count, dash, percent, power, seconds, signed_percent, times, unit

WORTH, CHEAPEST = (Stored("effects/worth", name) for name in ("worth", "cheapest"))
REFERENCE = WORTH.where(design="Table 1")
IMPULSES = "impulses/step_size"
READINGS, QUADRATURE = (Stored("paper/readings", name) for name in ("readings", "quadrature"))
LIMITS = Stored(IMPULSES, "limits")
OVER = Stored(IMPULSES, "findings", claim="Section 4.1: h = 1/100 s")
#: Groups of modes in the order of their frequencies.
GROUPS = ("axial", "bending", "swing")


@listing("effects")
def _worth(results: Results) -> Table:
    rows = WORTH.rows(results).query("status != 'refused'")
    largest = rows.pivot(index="scene", columns="design", values="largest")[list(rows["design"].unique())]
    yield ["left out", *largest.columns]
    for scene in largest.max(axis=1).sort_values(ascending=False, kind="stable").index:
        yield [str(scene), *map(dash(power), largest.loc[scene])]


LISTINGS["cheapest"] = CHEAPEST.table(
    {
        "design": ("design", str),
        "cheapest scene that suffices": ("scene", str),
        "its largest change": ("largest", power),
    }
)


@listing("impulse-limits")
def _limits(results: Results) -> Table:
    table = LIMITS.rows(results, sweeps=0)
    yield ["fastest modes that are kept", "2/ω", "measured limit", "the paper's step over it"]
    for design in dict.fromkeys(table["design"]):
        for group in GROUPS:
            name = f"{design}, {group} modes"
            row = LIMITS.where(sweeps=0, design=design, group=group)
            limits = (seconds(row.value(results, each)) for each in ("predicted_s", "measured_s"))
            over = OVER.value(results, "value", formulation=f"{name}, as printed")
            yield [name, *limits, times(over)]


@listing("assumptions")
def _assumptions(results: Results) -> Table:
    table = READINGS.rows(results).sort_values("rotation_rad")
    chosen = table.iloc[0]

    def beside(name: str, form: Form) -> Callable[[Any], Cell]:
        return lambda row: f"{form(row[name])} ({form(chosen[name])})"

    shown: Shown = {
        "reading": ("reading", str),
        "travel of the centre (Fig 4)": beside("travel_m", unit("mm", 3, 1e3)),
        "frequency (Fig 6)": beside("frequency_Hz", unit("Hz", 4)),
        "rotation changes by": ("rotation_rad", unit("rad")),
    }
    return columns(table[table["reading"] != chosen["reading"]].sort_values("reading"), shown)


LISTINGS["quadrature"] = QUADRATURE.table(
    {
        "Gauss points a strip": ("gauss_points", count),
        "torque": ("error_torque", percent),
        "stiffness": ("error_stiffness", percent),
        "stiffness at the end": ("error_stiffness_end", signed_percent),
    },
    by="gauss_points",
)


FACTS |= {
    f"impulses.limit.{group}": LIMITS.at("measured_s", seconds, design="Table 1", group=group, sweeps=0)
    for group in GROUPS
}
FACTS |= {
    "effects.designs": WORTH.fact(lambda rows: rows["design"].nunique(), count),
    "effects.tolerance": CHEAPEST.largest("tolerance", percent),
    "effects.inextensible": REFERENCE.at("largest", percent, scene="inextensible strips"),
    "effects.massless": REFERENCE.at("largest", percent, scene="massless strips"),
    "effects.massless.light": WORTH.at(
        "largest", percent, design="body ten times lighter", scene="massless strips"
    ),
    "effects.gravity.slender": WORTH.at(
        "largest", percent, design="ten times more slender", scene="no gravity"
    ),
    "effects.gravity": REFERENCE.at("largest", percent, scene="no gravity"),
    "impulses.over": OVER.at("value", times, formulation="Table 1, axial modes, as printed"),
    "impulses.one-sweep": LIMITS.at("ratio", percent, design="Table 1", group="axial", sweeps=1),
    "impulses.agreement": LIMITS.fact(lambda rows: (rows["ratio"] - 1.0).abs().max(), power, sweeps=0),
}


@holds("effects.stretching-small")
def _(r: Results) -> Any:
    """inextensible strips keep every design within the tolerance"""
    tolerance = CHEAPEST.rows(r)["tolerance"].iloc[0]
    return (WORTH.rows(r, scene="inextensible strips")["largest"] <= tolerance).all()


@holds("effects.shear-more")
def _(r: Results) -> Any:
    """shear changes the torque by more than stretching does"""
    return TORQUE.value(r, "torque") > REFERENCE.value(r, "largest", scene="inextensible strips")


@holds("impulses.printed-fails")
def _(r: Results) -> Any:
    """the paper's step is beyond every limit of Table 1 in the form as printed"""
    rows = OVER.rows(r)
    return rows.loc[rows["formulation"].str.startswith("Table 1"), "value"].gt(1.0).all()


@holds("quadrature.none")
def _(r: Results) -> Any:
    """no quadrature gives a torque within three percent and a stiffness that is too high"""
    return QUADRATURE.rows(r).query("error_torque < 0.03 and error_stiffness_end > 0.0").empty
