"""The claims of the paper, errors of the benchmark pivot, hard cases, published values, solids."""

from typing import Any

import pandas as pd

from report.facts import FACTS, HOLDS, LISTINGS, Fact, Results, Stored, Table, listing
from report.forms import Form, count, percent, seconds, signed_percent, significant, times, unit
from studies.registry import STUDIES

#: Formulations that the claims are held against.
CLAIMED = ("n = 4, as the paper", "n = 4, locking-free", "n = 6")

FIGURES = {
    name: Stored(f"paper/{study}", "findings")
    for name, study in (
        ("fig03", "fig03_snapshots"),
        ("fig04", "fig04_trajectory"),
        ("fig05", "fig05_stiffness"),
        ("fig06", "fig06_release"),
    )
}
FRAMES, ALONE = (Stored("paper/fig07_interactive", name) for name in ("frames_times", "alone_times"))
LIMITS, IMPULSES = (Stored("impulses/step_size", name) for name in ("limits", "findings"))
QUADRATURE = Stored("paper/readings", "quadrature")
#: Columns of the times of a frame.
LOOP = ["track_ms", "solve_ms"]


@listing("claims")
def _claims(results: Results) -> Table:
    found = pd.concat([figure.rows(results) for figure in FIGURES.values()])
    yield ["claim of the paper, as it is read", *CLAIMED]
    for claim, rows in found.groupby("claim"):
        verdicts = rows.set_index("formulation")
        held = (verdicts.loc[name] for name in CLAIMED)
        yield [str(claim), *(f"{row['holds']} ({percent(row['value'])})" for row in held)]


def _rate(results: Results) -> float:
    at = FRAMES.rows(results)["at_s"]
    return float((len(at) - 1) / (at.max() - at.min()))


def _loop(results: Results) -> float:
    """Return the time [ms] of search and solution that 95 % of the frames stay below."""
    return float(FRAMES.rows(results)[LOOP].sum(axis=1).quantile(0.95))


def _alone(results: Results) -> float:
    """Return the 95th percentile of the slowest work and preset [ms], the best repeat of each."""
    best = ALONE.rows(results).groupby(["preset", "work", "frame"])["time_ms"].min()
    return float(best.groupby(["preset", "work"]).quantile(0.95).max())


def _none(results: Results) -> bool:
    """Return whether no quadrature gives a torque within 3 % and a stiffness that is too high."""
    return QUADRATURE.rows(results).query("error_torque < 0.03 and error_stiffness_end > 0.0").empty


def _asked(form: Form, most: float) -> Form:
    """Return a form that writes a value, its target and whether it is met."""
    return lambda value: f"{form(value)} (target {form(most)}: {'met' if value <= most else 'missed'})"


FACTS |= {
    "fig06.paper.shift": Stored("paper/fig06_release", "summary").at(
        "frequency_shift", signed_percent, formulation=CLAIMED[0]
    ),
    "fig07.rate": Fact(made=_rate, form=unit("Hz", 3)),
    "fig07.loop": Fact(made=_loop, form=_asked(unit("ms", 3), 40.0)),
    "fig07.alone": Fact(made=_alone, form=_asked(unit("ms", 3), 1.0)),
    "impulses.limit": LIMITS.largest("measured_s", seconds, design="Table 1", group="axial"),
    "impulses.over": IMPULSES.at(
        "value", times, claim="Section 4.1: h = 1/100 s", formulation="Table 1, axial modes, as printed"
    ),
}
HOLDS |= {
    "fig04.holds": FIGURES["fig04"].found("Fig 4", *CLAIMED),
    "fig05.locks": FIGURES["fig05"].found("Fig 5: the differences", CLAIMED[0], holds="no"),
    "fig05.free": FIGURES["fig05"].found("Fig 5: the differences are negligible (torque", *CLAIMED[1:]),
    "fig05.overestimates": FIGURES["fig05"].found("Fig 5: the spline overestimates", *CLAIMED[:2]),
    "fig06.faster": FIGURES["fig06"].found("Fig 6: the spline swings", *CLAIMED[:2]),
    "quadrature.none": Fact(made=_none, form=bool),
    "impulses.limits": IMPULSES.found("The form as printed is stable up to"),
}
LISTINGS |= {
    "quadrature": QUADRATURE.table(
        {
            "Gauss points per strip": ("gauss_points", count),
            "torque": ("error_torque", percent),
            "stiffness": ("error_stiffness", percent),
            "stiffness at the end": ("error_stiffness_end", signed_percent),
        },
        by="gauss_points",
    ),
}


QUANTITIES = ("trajectory", "torque", "stiffness")
#: Splines without locking that the table shows, by their control points.
COUNTS = (4, 6, 8, 10)
MAP = Stored("convergence/control_points", "map", segments=1)
#: Four control points as published, integrated exactly; strips that cannot stretch, refined.
PAPER = MAP.where(measure="spatial", stretch="consistent", control_points=4)
RIGID = MAP.where(measure="material", stretch="inextensible", control_points=12, axial_modes=10)
STATICS = Stored("convergence/control_points", "reference")
RELEASE = Stored("paper/fig06_release", "reference")
MESHES = Stored("convergence/elements", "meshes", element="corotational")
TWENTY = MESHES.where(elements=20)
MOTIONS = Stored("paper/fig06_release", "summary")


def free(n: int) -> Stored:
    """Return the row of the map for the locking-free default: two axial modes fewer than control points."""
    return MAP.where(measure="material", stretch="mixed", control_points=n, axial_modes=n - 2)


@listing("agreement")
def _agreement(results: Results) -> Table:
    """Return the errors of the static path and of the swing, a row a formulation."""
    shown = {"n = 4, as the paper": PAPER, "n = 4, locking-free": free(4)}
    shown |= {f"n = {n}": free(n) for n in COUNTS[1:]} | {"FE, 20 elements": TWENTY}
    yield [
        "largest error; spline with n control points",
        *QUANTITIES,
        "vibration frequency",
        "vibration rotation",
    ]
    for label, errors in shown.items():
        own = [percent(errors.value(results, f"error_{name}")) for name in QUANTITIES]
        yield [label, *own, *_swing(results, label)]
    unsure = [percent(STATICS.value(results, "uncertainty", quantity=name)) for name in QUANTITIES]
    moving = [RELEASE.value(results, "uncertainty", quantity=name) for name in ("frequency", "rotation_rad")]
    yield ["uncertainty of the reference", *unsure, percent(moving[0]), unit("rad")(moving[1])]


def _swing(results: Results, formulation: str) -> list[str]:
    """Return the shift of the frequency and the error of the rotation; dashes where there is no motion."""
    motions: Any = MOTIONS.rows(results).set_index("formulation")
    if formulation not in motions.index:
        return ["–", "–"]
    row, unsure = motions.loc[formulation], RELEASE.value(results, "uncertainty", quantity="frequency")
    shift = row["frequency_shift"]
    written = signed_percent(shift) if abs(shift) > unsure else f"< {percent(unsure)}"
    return [written, unit("rad")(row["error_rotation_rad"])]


FREQUENCY = Stored("convergence/frequency", "findings")
ESTIMATES = Stored("convergence/error_estimate", "estimates", counts=True)
FACTS |= {
    "locking.torque": PAPER.at("error_torque", percent),
    "locking.stiffness": PAPER.at("error_stiffness", percent),
    **{f"free.{n}.torque": free(n).at("error_torque", percent) for n in (4, 6)},
    **{f"free.{n}.torque": free(n).at("error_torque", percent) for n in (8, 12)},
    "rigid.torque": RIGID.at("error_torque", percent),
    "elements.twenty.torque": TWENTY.at("error_torque", percent),
    "elements.largest.torque": MESHES.at("error_torque", percent, elements=320),
    "swing.locking": FREQUENCY.at(
        "value",
        percent,
        claim="The shift at four control points is mostly membrane locking",
        formulation="n = 4, consistent stretch",
    ),
    "estimate.largest": ESTIMATES.largest("effectivity", significant),
}
HOLDS |= {
    "elements.second-order": Stored("convergence/elements", "findings").found("The torque of the finite"),
    "swing.locking": FREQUENCY.found("The shift at four control points is mostly membrane locking"),
    "swing.rest": FREQUENCY.found("The first mode at rest shows", holds="no"),
    "estimate.never-above": Stored("convergence/error_estimate", "findings").found("The true error is below"),
}


#: Families in the order of the register, and the criterion of each.
FAMILIES = [study for study in STUDIES if study.startswith("stability/")]
PATHS = "path and torque within 5 % of a refined spline and of finite elements"
CRITERIA = {
    "rotation": PATHS,
    "slenderness": PATHS,
    "geometry": PATHS,
    "buckling": "load or deflection within 5 % of a refined spline, finite elements and publication",
    "step_size": "rotation within 5 % of the amplitude over 1200 steps or the first period",
    "long_run": "energy within 10⁻⁶ over 100\u202f000 steps",
    "ratios": "rotation within 5 % of the amplitude over the first period",
    "axial_modes": "torque within 5 % of a refined spline",
    "events": "rotation and energy within 5 %; energy balance",
}
DEFAULT, FE, AS_PAPER = "spline, default", "FE, 20 elements", "spline n = 4, as the paper"
COLUMNS = {DEFAULT: "spline, default", FE: "20 elements", AS_PAPER: "n = 4, as the paper"}
OUTCOMES = ["right", "refused", "wrong", "bad input"]
BRANCHES = Stored("stability/buckling", "branches")


@listing("families")
def _families(results: Results) -> Table:
    yield ["family", "correct if", *COLUMNS.values()]
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
    "hard.paper.tried": _total(AS_PAPER, "tried"),
    "hard.paper.wrong": _total(AS_PAPER, "wrong"),
    "buckling.pivot": BRANCHES.largest("first_bifurcation_mm", unit("mm", 3), model="spline n = 12"),
}


VALUES = Stored("published/problems", "values")
DEVIATIONS = Stored("model_form/solid_pivot", "deviations")


@listing("published")
def _published(results: Results) -> Table:
    """Return of each problem and each kind of answer the value that is met worst, by the splines where they
    answer."""
    yield ["published problem", "quantity", "published", "ours", "difference", "limit"]
    for _, every in VALUES.rows(results).groupby(["problem", "answer"], sort=False):
        rows = every[every["model"] == "spline"] if (every["model"] == "spline").any() else every
        row = rows.iloc[int(rows["error"].abs().argmax())]
        name = row["problem"] if row["answer"] == "beam" else f"{row['problem']}, {row['answer']}"
        bound = "" if row["bound"] == "equal" else f"{row['bound']} "
        unit = "" if row["unit"] == "1" else f" {row['unit']}"
        printed = f"{bound}{row['published']:.6g} ± {row['uncertainty']:.1g}{unit}"
        said = row["quantity"].replace("_", " ")
        ours, apart = f"{row['found']:.6g}{unit}", signed_percent(row["error"])
        yield [name, said, printed, ours, apart, percent(row["limit"])]


@listing("solids")
def _solids(results: Results) -> Table:
    """Return the deviations of the torque of beam models from that of solids, at the first and the last
    compared rotation of each design."""
    rows: Any = DEVIATIONS.rows(results)
    designs = list(rows["design"].unique())
    ends = rows.groupby(["model", "design"], sort=False)["error_torque"].agg(
        lambda own: f"{signed_percent(own.iloc[0])} to {signed_percent(own.iloc[-1])}"
    )
    yield ["model, torque", *designs]
    for name in rows["model"].unique():
        yield [name, *ends[name].reindex(designs).fillna("–")]
    yield ["uncertainty of the solids", *rows.groupby("design")["uncertainty"].max()[designs].map(percent)]
