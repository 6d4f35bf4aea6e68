"""Control points and elements: where it locks, how fast it converges, and what the swing shows of it."""

from itertools import pairwise

import pandas as pd

from report.facts import Cell, Fact, Holds, Table, fact
from report.forms import Form, count, percent, power, signed_percent, significant, times, unit
from report.results import Results, at, largest, least, where
from studies.record.style import COUNT_COLOURS, GREY, RED

POINTS, MESHES = "convergence/control_points", "convergence/elements"
SWING, SLIDE = "convergence/frequency", "convergence/slide_stiffness"
ESTIMATE = "convergence/error_estimate"
QUANTITIES = ("trajectory", "torque", "stiffness")
#: Control points that the table shows.
COUNTS = (4, 5, 6, 8, 10)
#: The paper's formulation, integrated exactly.
PAPER = {"basis": "bezier", "measure": "spatial", "stretch": "consistent"}
#: The formulation that the suite takes by default, but for its control points.
DEFAULT = {"basis": "bezier", "measure": "material", "stretch": "mixed"}


def _default_rows(table: pd.DataFrame) -> pd.DataFrame:
    """Return the rows of the locking-free default, two axial modes fewer than control points."""
    rows = where(table, **DEFAULT)
    return rows[rows["axial_modes"] == rows["control_points"] - 2]


def _default(n: int, column: str, form: Form) -> Fact:
    return fact(POINTS, "map", lambda table: at(column, control_points=n)(_default_rows(table)), form)


def _needed(table: pd.DataFrame, **equal: object) -> int:
    """Return from how many control points on trajectory and torque are right to 1e-4."""
    rows = _default_rows(table) if not equal else where(table, **equal)
    good = rows[rows[["error_trajectory", "error_torque"]].abs().max(axis=1) <= 1e-4]
    return int(good["control_points"].min())


def _gain(results: Results) -> float:
    """Return the torque's error with one axial mode too many over that of the default, at its largest."""
    table = where(results.table(POINTS, "map"), **DEFAULT)
    best = _default_rows(table).set_index("control_points")["error_torque"].abs()
    more = table[table["axial_modes"] == table["control_points"] - 1]
    ratio = more.set_index("control_points")["error_torque"].abs() / best
    return float(ratio.max())


def _observed(what: str, formulation: str, form: Form) -> Fact:
    return fact(SWING, "findings", at("value", claim=what, formulation=formulation), form)


def _ten(results: Results) -> float:
    """Return the shift with ten control points, or the uncertainty of its reference where that is larger."""
    shift = at("shift", stretch="mixed", control_points=10)(results.table(SWING, "control_points"))
    return max(abs(float(shift)), float(results.table(SWING, "reference")["uncertainty"].max()))


def _worst_slide(results: Results) -> float:
    """Return the error with the default slide stiffness where that is farthest from the best."""
    found = results.table(SLIDE, "findings").sort_values("value").iloc[-1]
    count = int(str(found["formulation"]).removeprefix("n = "))
    table, column = (
        ("motion", "error_rotation_rad") if "motion" in found["claim"] else ("statics", "error_torque")
    )
    default = at("slide_stiffness", problem=table, control_points=count)(results.table(SLIDE, "defaults"))
    rows = where(results.table(SLIDE, table), control_points=count)
    nearest = (rows["slide_stiffness"] - default).abs().idxmin()
    return float(rows.loc[nearest, column])


def _as_good_as_six(results: Results) -> int:
    """Return the least number of elements tried whose torque is as good as that of six control points."""
    six = at("error_torque", control_points=6)(_default_rows(results.table(POINTS, "map")))
    rows = where(results.table(MESHES, "meshes"), element="corotational")
    return int(rows.loc[rows["error_torque"].abs() <= abs(six), "elements"].min())


def _floor(column: str, **formulation: str) -> Fact:
    """Return the error that a formulation ends on: that of the most control points, whatever the modes.

    Fewer points may be nearer by chance, where their own error and that of the theory cancel.
    """

    def pick(table: pd.DataFrame) -> float:
        rows = where(table, basis="bezier", **formulation)
        return float(where(rows, control_points=rows["control_points"].max())[column].abs().max())

    return fact(POINTS, "map", pick, percent)


def _agreement(results: Results) -> Table:
    table = results.table(POINTS, "map")
    locked = where(table, control_points=4, **PAPER)
    rows = [_errors("spline n = 4, as the paper", RED, locked)]
    for n in COUNTS:
        rows.append(_errors(f"spline n = {n}, locking-free", COUNT_COLOURS[n], _default_rows(table), n))
    meshes = where(results.table(MESHES, "meshes"), element="corotational", elements=20)
    rows.append(_errors("FE, 20 elements", GREY, meshes))
    limits = results.table(POINTS, "reference").set_index("quantity")["uncertainty"]
    rows.append(["uncertainty of the reference", *(power(limits[name]) for name in QUANTITIES)])
    return ["largest error from rest to 90°", *QUANTITIES], rows


def _errors(label: str, colour: str, rows: pd.DataFrame, n: int | None = None) -> list[Cell]:
    row = (rows if n is None else where(rows, control_points=n)).iloc[0]
    return [{"text": label, "colour": colour}, *(power(row[f"error_{name}"]) for name in QUANTITIES)]


FACTS = {
    "map.free.torque": _default(4, "error_torque", percent),
    "map.six.torque": _default(6, "error_torque", power),
    "map.seven.torque": _default(7, "error_torque", power),
    "map.eight.torque": _default(8, "error_torque", power),
    "map.twelve.torque": _default(12, "error_torque", power),
    "map.needed": fact(POINTS, "map", _needed, count),
    "map.needed.consistent": fact(
        POINTS, "map", lambda t: _needed(t, basis="bezier", measure="material", stretch="consistent"), count
    ),
    "map.one-more": Fact(made=_gain, form=times),
    "map.spatial.trajectory": _floor("error_trajectory", measure="spatial", stretch="mixed"),
    "map.spatial.torque": _floor("error_torque", measure="spatial", stretch="mixed"),
    "map.inextensible.torque": _floor("error_torque", measure="material", stretch="inextensible"),
    "map.bspline.torque": fact(
        POINTS,
        "map",
        at(
            "error_torque",
            control_points=12,
            basis="bspline",
            measure="material",
            stretch="mixed",
            axial_modes=10,
        ),
        power,
    ),
    "elements.order": fact(
        MESHES,
        "meshes",
        at("order_torque", element="corotational", elements=160),
        lambda v: significant(v, 4),
    ),
    "elements.twenty.torque": fact(
        MESHES, "meshes", at("error_torque", element="corotational", elements=20), power
    ),
    "elements.as-six": Fact(made=_as_good_as_six, form=count),
    "elements.largest.torque": fact(
        MESHES, "meshes", at("error_torque", element="corotational", elements=320), power
    ),
    "swing.explained": _observed(
        "Section 3.2: four control points swing faster because they are stiffer",
        "n = 4, consistent stretch",
        lambda value: percent(1.0 - value),
    ),
    "swing.locking": _observed(
        "The shift at four control points is mostly membrane locking", "n = 4, consistent stretch", percent
    ),
    "swing.consistent": fact(
        SWING, "control_points", at("shift", stretch="consistent", control_points=4), signed_percent
    ),
    "swing.mixed": fact(
        SWING, "control_points", at("shift", stretch="mixed", control_points=4), signed_percent
    ),
    "swing.ten": Fact(made=_ten, form=percent),
    "swing.at-rest": _observed(
        "The first mode at rest shows the shift of the swing", "n = 4, mixed stretch", power
    ),
    "backbone.rest": fact(SWING, "backbone", least("frequency_Hz", formulation="n = 6"), unit("Hz", 4)),
    "backbone.end": fact(SWING, "backbone", largest("frequency_Hz", formulation="n = 6"), unit("Hz", 4)),
    "backbone.difference": _observed(
        "Both models swing alike at every amplitude from 2 to 90 degrees", "n = 6", percent
    ),
    "slide.worst": fact(SLIDE, "findings", lambda t: t["value"].max(), times),
    "slide.worst.error": Fact(made=_worst_slide, form=power),
    "slide.failed": fact(SLIDE, "findings", lambda t: int((t["holds"] == "no").sum()), count),
    "slide.tried": fact(SLIDE, "findings", len, count),
    "estimate.statics": fact(
        ESTIMATE, "estimates", lambda t: len(where(t, problem="statics", counts=True)), count
    ),
    "estimate.statics.designs": fact(
        ESTIMATE, "estimates", lambda t: where(t, problem="statics", counts=True)["design"].nunique(), count
    ),
    "estimate.motion.designs": fact(
        ESTIMATE, "estimates", lambda t: where(t, problem="motion", counts=True)["design"].nunique(), count
    ),
    "estimate.least": fact(ESTIMATE, "estimates", least("effectivity", counts=True), significant),
    "estimate.largest": fact(ESTIMATE, "estimates", largest("effectivity", counts=True), significant),
    "estimate.cost": fact(ESTIMATE, "timings", largest("time_ratio"), significant),
}

HOLDS = {
    "map.two-more": Holds(
        words="the locking-free spline meets 1e-4 with fewer control points than the consistent one",
        test=lambda r: (
            _needed(r.table(POINTS, "map"))
            < _needed(r.table(POINTS, "map"), basis="bezier", measure="material", stretch="consistent")
        ),
    ),
    "map.falls": Holds(
        words="from four to six, eight and twelve control points the torque's error falls tenfold each time",
        test=lambda r: all(
            abs(fine) < abs(coarse) / 10.0
            for coarse, fine in pairwise(
                at("error_torque", control_points=n)(_default_rows(r.table(POINTS, "map")))
                for n in (4, 6, 8, 12)
            )
        ),
    ),
    "map.bspline-slower": Holds(
        words="with twelve control points the B-spline is a hundred times farther off than the Bézier curve",
        test=lambda r: (
            abs(FACTS["map.bspline.torque"].made(r)) > 100.0 * abs(FACTS["map.twelve.torque"].made(r))
        ),
    ),
    "map.one-more-worse": Holds(
        words="one axial mode more than n - 2 makes the torque worse for some n",
        test=lambda r: _gain(r) > 1.0,
    ),
    "elements.second-order": Holds(
        words="the observed order of both elements is 2 within 2 %",
        test=lambda r: (
            (
                r.table(MESHES, "meshes")
                .query("elements == 160")[["order_trajectory", "order_torque"]]
                .sub(2.0)
            )
            .abs()
            .max()
            .max()
            < 0.04
        ),
    ),
    "swing.all": Holds(
        words="all findings on the frequency hold, but for the first mode at rest",
        test=lambda r: (
            set(r.table(SWING, "findings").query("holds == 'no'")["claim"])
            == {"The first mode at rest shows the shift of the swing"}
        ),
    ),
    "slide.some-off": Holds(
        words="the default slide stiffness is off the best for some counts of control points",
        test=lambda r: (r.table(SLIDE, "findings")["holds"] == "no").any(),
    ),
    "estimate.never-above": Holds(
        words="every estimate is near the true error, and every true error below what was asked",
        test=lambda r: (r.table(ESTIMATE, "findings")["holds"] == "yes").all(),
    ),
}
LISTINGS = {"agreement": _agreement}
