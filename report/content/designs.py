"""The sample of the design space, its throughput, and the pivot sized by exact gradients."""

from typing import Any

from report.content.basis import pivot
from report.facts import FACTS, Fact, Results, Shown, Stored, Table, columns, holds, listing
from report.forms import angle, count, degrees, digits, percent, power, significant, times, unit

SPACE, THROUGHPUT, SIZING = "sweep/design_space", "sweep/throughput", "design/sizing"
SAMPLE, CHECKS, COMPARED = (Stored(SPACE, name) for name in ("designs", "checks", "comparison"))
DESIGNS, ACTIVE, CHECKED = (Stored(SIZING, name) for name in ("designs", "active", "checks"))
STARTS, TOLERANCES = Stored(SIZING, "starts"), Stored(SIZING, "tolerances")
SHIFT, VARIATION = "least centre shift", "least variation of stiffness"
NARROW, STEEL = ", narrow strips", ", spring steel"
#: Question -> column of the factor by which it betters its baseline.
QUESTIONS = (SHIFT, SHIFT + NARROW, VARIATION, VARIATION + NARROW, SHIFT + STEEL, VARIATION + STEEL)
FACTORS = {
    question: "factor_centre_shift" if SHIFT in question else "factor_stiffness_variation"
    for question in QUESTIONS
}
#: Column of whose tolerance a row is of, and what begins the name of all of them together.
DIMENSION, ALL = "dimension", "all, "
#: A stress that designs of the sample stay below [Pa].
STRENGTH = 600e6


def _checked(results: Results, *, variation: bool = False) -> float:
    """Return the largest difference of splines and elements over the chosen designs: relative, of the
    variation, which is itself relative to the stiffness at rest, as it is."""
    table = COMPARED.rows(results)
    rows = table[(table["quantity"] == "stiffness_variation") == variation]
    return float(rows["error"].abs().max())


def _dominating(results: Results) -> float:
    """Return how many designs are better than the reference pivot in all four quantities at once."""
    share = Stored(SPACE, "findings", quantity="the share of designs that better it").value(results, "value")
    return round(float(share) * len(SAMPLE.rows(results)), 6)


@listing("chosen")
def _chosen(results: Results) -> Table:
    shown: Shown = {
        "design": ("design", str),
        "crossing": ("crossing_ratio", digits(3)),
        "inclination": ("inclination_deg", angle()),
        "slenderness": ("slenderness", digits(3)),
        "stiffness": ("stiffness_rest_Nm_per_rad", unit("N m/rad", 3)),
        "variation": ("stiffness_variation", percent),
        "shift": ("centre_shift_max_m", unit("mm", 2, 1e3)),
        "stress": ("stress_max_Pa", unit("GPa", 2, 1e-9)),
    }
    return columns(CHECKS.rows(results), shown)


@listing("sizing")
def _designs(results: Results) -> Table:
    bounds = ACTIVE.rows(results).groupby("question")["constraint"].agg(", ".join)
    shown: Shown = {
        "design": ("design", str),
        "length": ("length_m", unit("mm", 3, 1e3)),
        "inclination": ("inclination_rad", degrees),
        "crossing": ("crossing_ratio", digits(3)),
        "thickness": ("thickness_m", unit("mm", 3, 1e3)),
        "width": ("width_m", unit("mm", 3, 1e3)),
        "shift": ("centre_shift_m", unit("mm", 2, 1e3)),
        "variation": ("variation", percent),
        "bounds that are active": ("design", lambda name: str(bounds.get(name, "–")).replace("_", " ")),
    }
    found: Any = DESIGNS.rows(results).set_index("design", drop=False)
    return columns(found.loc[[*dict.fromkeys(found["baseline"]), *QUESTIONS]], shown)


@listing("tolerances")
def _tolerances(results: Results) -> Table:
    """Return what all tolerances together do: the worst of whole solves, and the root of the squares."""
    rows = TOLERANCES.rows(results)
    both = rows[rows[DIMENSION].str.startswith(ALL)].set_index(["design", DIMENSION, "quantity"])
    cells = both["solved"].map(percent) + " (" + both["squares"].map(percent) + ")"
    wide = cells.unstack("quantity").reset_index()
    wide[DIMENSION] = wide[DIMENSION].str.removeprefix(ALL)
    yield [str(name).replace("-", " ") for name in wide.columns]
    yield from wide.to_numpy().tolist()


def _farthest(results: Results, against: str) -> float:
    """Return the largest error of all checks against elements or differences."""
    rows = CHECKED.rows(results)
    return float(rows.loc[rows["against"].str.startswith(against), "error"].abs().max())


def _plate(results: Results) -> float:
    """Return by how much a strip of Table 1's material is stiffer where its section stays flat."""
    square = float(pivot().poisson_ratio) ** 2
    return square / (1.0 - square)


def _gain(results: Results, question: str) -> float:
    return float(DESIGNS.value(results, FACTORS[question], design=question))


def _factor(question: str) -> Fact:
    return DESIGNS.at(FACTORS[question], times, design=question)


FACTS |= {
    "space.designs": SAMPLE.fact(len, count),
    "space.front": SAMPLE.fact(len, count, front="yes"),
    "space.dominating": Fact(made=_dominating, form=count),
    "space.below": SAMPLE.fact(lambda rows: (rows["stress_max_Pa"] < STRENGTH).sum(), count),
    "space.strength": Fact(made=lambda _: STRENGTH, form=unit("MPa", 1, 1e-6)),
    "space.checked": Fact(made=_checked, form=percent),
    "space.checked.variation": Fact(made=lambda r: 100.0 * _checked(r, variation=True), form=digits(1)),
    "throughput.rate": Stored(THROUGHPUT, "timings").fact(
        lambda rows: (rows["designs"] / rows["wall_s"]).max(), significant
    ),
    "sizing.shift": _factor(SHIFT),
    "sizing.shift.narrow": _factor(SHIFT + NARROW),
    "sizing.variation": _factor(VARIATION),
    "sizing.variation.narrow": _factor(VARIATION + NARROW),
    "sizing.steel.shift": _factor(SHIFT + STEEL),
    "sizing.steel.variation": _factor(VARIATION + STEEL),
    "sizing.steel.stress": DESIGNS.largest(
        "largest_stress_Pa", unit("MPa", 3, 1e-6), baseline="spring steel"
    ),
    "sizing.elements": Fact(made=lambda r: _farthest(r, "finite elements"), form=power),
    "sizing.questions": STARTS.fact(lambda rows: rows["question"].nunique(), count),
    "sizing.starts": STARTS.fact(len, count),
    "sizing.reached": STARTS.fact(len, count, optimum=1),
    "sizing.plate": Fact(made=_plate, form=percent),
    "tolerances.stiffness": TOLERANCES.largest("solved", percent, quantity="stiffness"),
    "tolerances.shift": TOLERANCES.largest("solved", percent, quantity="centre-shift"),
    "sizing.range": Stored(SIZING, "curves").largest("rotation_rad", degrees, design="Table 1"),
}


@holds("space.checked")
def _(r: Results) -> Any:
    """finite elements agree with every chosen design within 1 %"""
    return _checked(r) < 0.01


@holds("sizing.better")
def _(r: Results) -> Any:
    """each optimum betters Table 1 in what it was asked for"""
    return all(_gain(r, question) > 1.0 for question in QUESTIONS)


@holds("sizing.verified")
def _(r: Results) -> Any:
    """finite elements agree with every optimum within 1 %, differences with the gradients to 1e-7"""
    return _farthest(r, "finite elements") < 0.01 and _farthest(r, "differences") < 1e-7


@holds("sizing.wide-better")
def _(r: Results) -> Any:
    """narrow strips gain less than wide ones"""
    return all(_gain(r, question) > _gain(r, question + NARROW) for question in (SHIFT, VARIATION))
