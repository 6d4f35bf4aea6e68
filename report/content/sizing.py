"""The pivot sized anew by exact gradients."""

from typing import Any

from report.facts import Cell, Derived, Fact, Holds, Listing, fact
from report.forms import count, degrees, percent, power, significant, times, unit
from report.pick import at, distinct, largest
from report.results import Results

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


def _designs(results: Results) -> tuple[list[str], list[list[Cell]]]:
    rows: list[list[Cell]] = []
    found: Any = results.table(SIZING, "designs").set_index("design")
    baselines = dict.fromkeys(found["baseline"])
    for name in (*baselines, *FACTORS):
        row = found.loc[name]
        rows.append(
            [
                name,
                unit("mm", 3, 1e3)(row["length_m"]),
                degrees(row["inclination_rad"]),
                significant(row["crossing_ratio"], 3),
                unit("mm", 3, 1e3)(row["thickness_m"]),
                unit("mm", 3, 1e3)(row["width_m"]),
                unit("mm", 2, 1e3)(row["centre_shift_m"]),
                percent(row["variation"]),
                "–" if name in baselines else times(row[FACTORS[name]]),
            ]
        )
    head = "design, length, inclination, crossing, depth, width, shift, variation, better by"
    return head.split(", "), rows


def _checked(results: Results, against: str) -> float:
    """Return the largest error of all checks against elements or differences."""
    rows = results.table(SIZING, "checks")
    return float(rows.loc[rows["against"].str.startswith(against), "error"].abs().max())


def _factor(question: str) -> Fact:
    return fact(SIZING, "designs", at(FACTORS[question], design=question), times)


def _reached(results: Results) -> int:
    """Return how many starts led to the best optimum of their question, or its mirror image."""
    rows = results.table(SIZING, "starts")
    return int((rows["optimum"] == 1).sum())


FACTS: dict[str, Fact | Derived] = {
    "sizing.shift": _factor(SHIFT),
    "sizing.shift.narrow": _factor(SHIFT + NARROW),
    "sizing.variation": _factor(VARIATION),
    "sizing.variation.narrow": _factor(VARIATION + NARROW),
    "sizing.elements": Derived(made=lambda r: _checked(r, "finite elements"), form=power),
    "sizing.gradients": Derived(made=lambda r: _checked(r, "differences"), form=power),
    "sizing.questions": fact(SIZING, "starts", distinct("question"), count),
    "sizing.starts": fact(SIZING, "starts", len, count),
    "sizing.reached": Derived(made=_reached, form=count),
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

HOLDS = {
    "sizing.better": Holds(
        words="each optimum betters Table 1 in what it was asked for",
        test=lambda r: all(
            at(column, design=question)(r.table(SIZING, "designs")) > 1.0
            for question, column in FACTORS.items()
        ),
    ),
    "sizing.verified": Holds(
        words="finite elements agree with every optimum within 1 %, differences with the gradients to 1e-7",
        test=lambda r: _checked(r, "finite elements") < ELEMENTS and _checked(r, "differences") < GRADIENT,
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
LISTINGS = {"sizing": Listing(made=_designs)}
