"""The hard cases: outcomes of every family, as the studies count them."""

from report.facts import FACTS, Fact, Results, Stored, Table, listing
from report.forms import count, digits, percent, unit
from studies.registry import STUDIES

#: Families in the order of the register, and what counts as right in each.
FAMILIES = [study for study in STUDIES if study.startswith("stability/")]
PATHS = "path and torque within 5 % of a refined spline and of finite elements"
CRITERIA = {
    "rotation": PATHS,
    "slenderness": PATHS,
    "geometry": PATHS,
    "buckling": "load or deflection within 5 % of a refined spline, finite elements and publication",
    "step_size": "rotation within 5 % of the amplitude over 1200 steps or the first swing",
    "long_run": "energy within 10⁻⁶ over 100\u202f000 steps",
    "ratios": "rotation within 5 % of the amplitude over the first swing",
    "axial_modes": "torque within 5 % of a refined spline",
    "fuzz": "path within 5 % of the same spline with 17 points; energy balance to 10⁻⁸",
    "events": "rotation and energy within 5 %; energy balance",
}
DEFAULT, FE, PAPER = "spline, default", "FE, 20 elements", "spline n = 4, as the paper"
COLUMNS = {DEFAULT: "spline, default", FE: "20 elements", PAPER: "n = 4, as the paper"}
OUTCOMES = ["right", "refused", "wrong", "bad input"]
STEPS = Stored("stability/step_size", "counts")
BRANCHES = Stored("stability/buckling", "branches")


@listing("families")
def _families(results: Results) -> Table:
    yield ["family", "right if", *COLUMNS.values()]
    for study in FAMILIES:
        counts = results.table(study, "counts").set_index("model")[OUTCOMES]
        cells = (
            " / ".join(map(count, counts.loc[each])) if each in counts.index else "–" for each in COLUMNS
        )
        family = study.partition("/")[2]
        yield [family.replace("_", " "), CRITERIA[family], *cells]


def _total(model: str, column: str) -> Fact:
    """Return how many cases of a model end so, over all families."""

    def made(results: Results) -> int:
        counts = (results.table(study, "counts") for study in FAMILIES)
        return int(sum(each.loc[each["model"] == model, column].sum() for each in counts))

    return Fact(made=made, form=count)


FACTS |= {
    "hard.default.tried": _total(DEFAULT, "tried"),
    "hard.default.wrong": _total(DEFAULT, "wrong"),
    "hard.paper.tried": _total(PAPER, "tried"),
    "hard.paper.wrong": _total(PAPER, "wrong"),
    "hard.steps.default": STEPS.at("right", count, model=DEFAULT),
    "hard.steps.fe": STEPS.at("right", count, model=FE),
    "hard.steps.tried": STEPS.at("tried", count, model=FE),
    "hard.random": Stored("stability/fuzz", "elements").largest("error", percent),
    "buckling.column": Stored("stability/buckling", "critical", part="column", kind="bifurcation").at(
        "load", digits(6), model=DEFAULT
    ),
    "buckling.pivot": BRANCHES.largest("first_bifurcation_mm", unit("mm", 3), model="spline n = 12"),
}
