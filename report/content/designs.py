"""The sample of the design space, its throughput, and the pivot sized by exact gradients."""

from functools import partial
from typing import Any

import pandas as pd

from report.content.problem import pivot
from report.facts import Fact, Holds, Shown, Table, columns, fact, unmet
from report.forms import count, degrees, percent, power, significant, text, times, unit
from report.results import Results, at, distinct, largest, least

SPACE, THROUGHPUT = "sweep/design_space", "sweep/throughput"
GAIN = "Two workers solve at least"


def _checked(results: Results, *, variation: bool = False) -> float:
    """Return the largest difference of splines and elements over the chosen designs: relative, of the
    variation, which is itself relative to the stiffness at rest, as it is."""
    table = results.table(SPACE, "comparison")
    rows = table[(table["quantity"] == "stiffness_variation") == variation]
    return float(rows["error"].abs().max())


def _chosen(results: Results) -> Table:
    shown: Shown = {
        "design": ("design", text),
        "crossing": ("crossing_ratio", partial(significant, digits=3)),
        "inclination": ("inclination_deg", lambda value: f"{significant(value, 2)}°"),
        "slenderness": ("slenderness", partial(significant, digits=3)),
        "stiffness": ("stiffness_rest_Nm_per_rad", unit("N m/rad", 3)),
        "variation": ("stiffness_variation", percent),
        "shift": ("centre_shift_max_m", unit("mm", 2, 1e3)),
        "stress": ("stress_max_Pa", unit("GPa", 2, 1e-9)),
    }
    return columns(results.table(SPACE, "checks"), shown)


def _unmet(results: Results) -> Table:
    tables = ((SPACE, "findings"), (THROUGHPUT, "findings_of_time"))
    return unmet(results, tables, significant, "measured")


def _gains(results: Results) -> "pd.Series[Any]":
    table = results.table(THROUGHPUT, "findings_of_time")
    found: pd.Series[Any] = table.loc[table["claim"].str.startswith(GAIN), "value"]
    return found


def _front(table: pd.DataFrame) -> int:
    return int((table["front"] == "yes").sum())


def _best(column: str) -> Any:
    """Return a pick of the least of `column` among the designs that no other betters."""
    return least(column, front="yes")


FACTS = {
    "space.designs": fact(SPACE, "designs", len, count),
    "space.front": fact(SPACE, "designs", _front, count),
    "space.checked": Fact(made=_checked, form=percent),
    "space.checked.variation": Fact(
        made=lambda r: 100.0 * _checked(r, variation=True), form=lambda v: significant(v, 1)
    ),
    "throughput.rate": fact(THROUGHPUT, "timings", lambda t: (t["designs"] / t["wall_s"]).max(), significant),
}

HOLDS = {
    "space.checked": Holds(
        words="finite elements agree with every chosen design within 1 %",
        test=lambda r: _checked(r) < 0.01,
    ),
}
LISTINGS = {"chosen": _chosen, "space-unmet": _unmet}


SIZING = "design/sizing"
TABLE_1 = "Table 1"
SHIFT, VARIATION = "least centre shift", "least variation of stiffness"
NARROW, STEEL = ", narrow strips", ", spring steel"
#: Question -> column of the factor by which it betters Table 1.
FACTORS = {
    SHIFT: "factor_centre_shift",
    SHIFT + NARROW: "factor_centre_shift",
    VARIATION: "factor_stiffness_variation",
    VARIATION + NARROW: "factor_stiffness_variation",
    SHIFT + STEEL: "factor_centre_shift",
    VARIATION + STEEL: "factor_stiffness_variation",
}
#: What a check by the finite elements may be off by, and a gradient by.
ELEMENTS, GRADIENT = 0.01, 1e-7


def _designs(results: Results) -> Table:
    found: Any = results.table(SIZING, "designs").set_index("design", drop=False)
    baselines = dict.fromkeys(found["baseline"])
    shown: Shown = {
        "design": ("design", text),
        "length": ("length_m", unit("mm", 3, 1e3)),
        "inclination": ("inclination_rad", degrees),
        "crossing": ("crossing_ratio", partial(significant, digits=3)),
        "depth": ("thickness_m", unit("mm", 3, 1e3)),
        "width": ("width_m", unit("mm", 3, 1e3)),
        "shift": ("centre_shift_m", unit("mm", 2, 1e3)),
        "variation": ("variation", percent),
    }
    head, rows = columns(found.loc[[*baselines, *FACTORS]], shown)
    bounds = results.table(SIZING, "active").groupby("question")["constraint"].agg(", ".join)
    more = [bounds.get(name, "–") for name in (*baselines, *FACTORS)]
    return [*head, "bounds that are active"], [[*row, each] for row, each in zip(rows, more, strict=True)]


def _farthest(results: Results, against: str) -> float:
    """Return the largest error of all checks against elements or differences."""
    rows = results.table(SIZING, "checks")
    return float(rows.loc[rows["against"].str.startswith(against), "error"].abs().max())


def _plate() -> float:
    """Return by how much a strip of Table 1's material is stiffer where its section stays flat."""
    square = pivot().poisson_ratio ** 2
    return square / (1.0 - square)


def _factor(question: str) -> Fact:
    return fact(SIZING, "designs", at(FACTORS[question], design=question), times)


def _reached(results: Results) -> int:
    """Return how many starts led to the best optimum of their question, or its mirror image."""
    rows = results.table(SIZING, "starts")
    return int((rows["optimum"] == 1).sum())


FACTS |= {
    "sizing.shift": _factor(SHIFT),
    "sizing.shift.narrow": _factor(SHIFT + NARROW),
    "sizing.variation": _factor(VARIATION),
    "sizing.variation.narrow": _factor(VARIATION + NARROW),
    "sizing.elements": Fact(made=lambda r: _farthest(r, "finite elements"), form=power),
    "sizing.questions": fact(SIZING, "starts", distinct("question"), count),
    "sizing.starts": fact(SIZING, "starts", len, count),
    "sizing.reached": Fact(made=_reached, form=count),
    "sizing.plate": Fact(made=lambda _: _plate(), form=percent),
    "sizing.range": fact(SIZING, "curves", largest("rotation_rad", design=TABLE_1), degrees),
    "sizing.steel.shift": _factor(SHIFT + STEEL),
    "sizing.steel.variation": _factor(VARIATION + STEEL),
    "sizing.steel.stress": fact(
        SIZING, "designs", largest("largest_stress_Pa", baseline="spring steel"), unit("MPa", 3, 1e-6)
    ),
}

HOLDS |= {
    "sizing.better": Holds(
        words="each optimum betters Table 1 in what it was asked for",
        test=lambda r: all(
            at(column, design=question)(r.table(SIZING, "designs")) > 1.0
            for question, column in FACTORS.items()
        ),
    ),
    "sizing.verified": Holds(
        words="finite elements agree with every optimum within 1 %, differences with the gradients to 1e-7",
        test=lambda r: _farthest(r, "finite elements") < ELEMENTS and _farthest(r, "differences") < GRADIENT,
    ),
    "sizing.wide-better": Holds(
        words="narrow strips gain less than wide ones",
        test=lambda r: all(
            at(FACTORS[question], design=question)(r.table(SIZING, "designs"))
            > at(FACTORS[question], design=question + NARROW)(r.table(SIZING, "designs"))
            for question in (SHIFT, VARIATION)
        ),
    ),
}
LISTINGS |= {"sizing": _designs}
