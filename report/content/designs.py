"""The pivot's design space, how many designs a second are solved, and the pivot sized by exact gradients."""

from functools import partial
from typing import Any

import pandas as pd

from report.facts import Fact, Holds, Shown, Table, columns, fact, unmet
from report.forms import count, degrees, percent, power, seconds, significant, text, times, unit
from report.results import Results, at, distinct, largest, least

SPACE, THROUGHPUT = "sweep/design_space", "sweep/throughput"
GAIN = "Two workers solve at least"


def _checked(results: Results) -> float:
    """Return the largest relative difference of splines and elements over all chosen designs."""
    return float(results.table(SPACE, "comparison")["error"].abs().max())


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
    "space.shift": fact(SPACE, "designs", _best("centre_shift_max_m"), unit("mm", 2, 1e3)),
    "space.shift.table-1": fact(
        SPACE, "checks", at("centre_shift_max_m", design="Table 1"), unit("mm", 2, 1e3)
    ),
    "space.variation": fact(SPACE, "designs", _best("stiffness_variation"), percent),
    "space.variation.table-1": fact(SPACE, "checks", at("stiffness_variation", design="Table 1"), percent),
    "space.checked": Fact(made=_checked, form=percent),
    "throughput.designs": fact(THROUGHPUT, "timings", largest("designs"), count),
    "throughput.time": fact(
        THROUGHPUT, "timings", lambda t: t.loc[t["designs"] == t["designs"].max(), "wall_s"].min(), seconds
    ),
    "throughput.rate": fact(THROUGHPUT, "timings", lambda t: (t["designs"] / t["wall_s"]).max(), significant),
    "throughput.gain.least": Fact(made=lambda r: float(_gains(r).min()), form=times),
    "throughput.gain.most": Fact(made=lambda r: float(_gains(r).max()), form=times),
    "throughput.chunk": fact(
        THROUGHPUT,
        "findings_of_time",
        lambda t: 0.01 * t.loc[t["claim"].str.startswith("A chunk costs"), "value"].max(),
        seconds,
    ),
}

HOLDS = {
    "space.front-ends": Holds(
        words="the least centre shift and the least variation of the front are a tenth of Table 1's at most",
        test=lambda r: (
            _best("centre_shift_max_m")(r.table(SPACE, "designs"))
            < 0.1 * at("centre_shift_max_m", design="Table 1")(r.table(SPACE, "checks"))
            and _best("stiffness_variation")(r.table(SPACE, "designs"))
            < 0.1 * at("stiffness_variation", design="Table 1")(r.table(SPACE, "checks"))
        ),
    ),
    "space.table-1-not-bettered": Holds(
        words="no design betters Table 1 in stiffness, variation, shift and stress at once",
        test=lambda r: bool(
            (
                r.table(SPACE, "findings").query("claim.str.startswith('Table 1 is not bettered')")["holds"]
                == "yes"
            ).all()
        ),
    ),
    "space.checked": Holds(
        words="finite elements agree with every chosen design within 1 %",
        test=lambda r: _checked(r) < 0.01,
    ),
    "throughput.cores": Holds(
        words="two workers gain as much as was wanted, by every way of working",
        test=lambda r: bool(
            (
                r.table(THROUGHPUT, "findings_of_time").query(
                    "claim.str.startswith(@GAIN)", local_dict={"GAIN": GAIN}
                )["holds"]
                == "yes"
            ).all()
        ),
        timed=True,
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
    better = [
        "–" if name in baselines else times(found.loc[name, FACTORS[name]]) for name in (*baselines, *FACTORS)
    ]
    return [*head, "better by"], [[*row, each] for row, each in zip(rows, better, strict=True)]


def _farthest(results: Results, against: str) -> float:
    """Return the largest error of all checks against elements or differences."""
    rows = results.table(SIZING, "checks")
    return float(rows.loc[rows["against"].str.startswith(against), "error"].abs().max())


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
    "sizing.gradients": Fact(made=lambda r: _farthest(r, "differences"), form=power),
    "sizing.questions": fact(SIZING, "starts", distinct("question"), count),
    "sizing.starts": fact(SIZING, "starts", len, count),
    "sizing.reached": Fact(made=_reached, form=count),
    "sizing.stiffness": fact(
        SIZING, "designs", at("stiffness_Nm_per_rad", design=TABLE_1), unit("N m/rad", 4)
    ),
    "sizing.stress": fact(SIZING, "designs", at("largest_stress_Pa", design=TABLE_1), unit("GPa", 2, 1e-9)),
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
