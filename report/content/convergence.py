"""Control points and elements: where it locks, how fast it converges, and what the swing shows of it."""

from itertools import pairwise
from typing import Any

import pandas as pd

from report.facts import FACTS, Fact, Results, Stored, Table, holds, listing, where
from report.forms import count, digits, percent, power, signed_percent, significant, times, unit
from studies.record.style import COUNT_COLOURS, GREY, RED

QUANTITIES = ("trajectory", "torque", "stiffness")
#: Control points that the table shows.
COUNTS = (4, 5, 6, 8, 10)
MAP = Stored("convergence/control_points", "map")
#: The paper's formulation, integrated exactly, and that of the suite but for its control points and modes.
PAPER = {"basis": "bezier", "measure": "spatial", "stretch": "consistent"}
DEFAULT = {"basis": "bezier", "measure": "material", "stretch": "mixed"}
UNSURE = Stored("convergence/control_points", "reference")
MESHES = Stored("convergence/elements", "meshes", element="corotational")
SHIFTS = Stored("convergence/frequency", "control_points")
SWING = Stored("convergence/frequency", "findings")
BACKBONE = Stored("convergence/frequency", "backbone", formulation="n = 6")
ESTIMATES = Stored("convergence/error_estimate", "estimates", counts=True)


def free(n: int) -> Stored:
    """Return the row of the map for the locking-free default: two axial modes fewer than control points."""
    return MAP.where(**DEFAULT, control_points=n, axial_modes=n - 2)


def _fewer(results: Results, fewer: int) -> pd.DataFrame:
    """Return the rows of the locking-free spline with so many axial modes fewer than control points."""
    rows = MAP.rows(results, **DEFAULT)
    return rows[rows["axial_modes"] == rows["control_points"] - fewer]


def _consistent(results: Results) -> pd.DataFrame:
    return MAP.rows(results, basis="bezier", measure="material", stretch="consistent")


def _needed(rows: pd.DataFrame) -> int:
    """Return from how many control points on trajectory and torque are right to 1e-4."""
    good = rows[rows[["error_trajectory", "error_torque"]].abs().max(axis=1) <= 1e-4]
    return int(good["control_points"].min())


def _gain(results: Results) -> float:
    """Return the torque's error with one axial mode too many over that of the default, at its largest."""
    best, more = (_fewer(results, n).set_index("control_points")["error_torque"].abs() for n in (2, 1))
    return float((more / best).max())


def _ten(results: Results) -> float:
    """Return the shift with ten control points, or the uncertainty of its reference where that is larger."""
    shift = SHIFTS.value(results, "shift", stretch="mixed", control_points=10)
    unsure = results.table("convergence/frequency", "reference")["uncertainty"].max()
    return max(abs(float(shift)), float(unsure))


def _as_good_as_six(results: Results) -> int:
    """Return the least number of elements tried whose torque is as good as that of six control points."""
    rows = MESHES.rows(results)
    good = rows["error_torque"].abs() <= abs(free(6).value(results, "error_torque"))
    return int(rows.loc[good, "elements"].min())


def _designs(rows: pd.DataFrame) -> int:
    return int(rows["design"].nunique())


def _floor(name: str, **formulation: str) -> Fact:
    """Return the error that a formulation ends on: that of the most control points, whatever the modes.

    Fewer points may be nearer by chance, where their own error and that of the theory cancel.
    """

    def pick(rows: pd.DataFrame) -> float:
        return float(where(rows, control_points=rows["control_points"].max())[name].abs().max())

    return MAP.fact(pick, percent, basis="bezier", **formulation)


@listing("agreement")
def _agreement(results: Results) -> Table:
    shown = [
        ("spline n = 4, as the paper", RED, MAP.where(**PAPER, control_points=4)),
        *((f"spline n = {n}, locking-free", COUNT_COLOURS[n], free(n)) for n in COUNTS),
        ("FE, 20 elements", GREY, MESHES.where(elements=20)),
    ]
    yield ["largest error from rest to 90°", *QUANTITIES]
    for label, colour, errors in shown:
        own = (power(errors.value(results, f"error_{name}")) for name in QUANTITIES)
        yield [{"text": label, "colour": colour}, *own]
    unsure = (power(UNSURE.value(results, "uncertainty", quantity=name)) for name in QUANTITIES)
    yield ["uncertainty of the reference", *unsure]


LOCKS, UNLOCKED = "n = 4, consistent stretch", "n = 4, mixed stretch"
STIFFER = "Section 3.2: four control points swing faster because they are stiffer"
MEMBRANE = "The shift at four control points is mostly membrane locking"
AT_REST = "The first mode at rest shows the shift of the swing"
ALIKE = "Both models swing alike at every amplitude from 2 to 90 degrees"
TWELVE = MAP.where(**DEFAULT | {"basis": "bspline"}, control_points=12, axial_modes=10)

FACTS |= {
    "map.free.torque": free(4).at("error_torque", percent),
    **{
        f"map.{name}.torque": free(n).at("error_torque", power)
        for name, n in (("six", 6), ("seven", 7), ("eight", 8), ("twelve", 12))
    },
    "map.needed": Fact(made=lambda r: _needed(_fewer(r, 2)), form=count),
    "map.needed.consistent": Fact(made=lambda r: _needed(_consistent(r)), form=count),
    "map.one-more": Fact(made=_gain, form=times),
    "map.spatial.trajectory": _floor("error_trajectory", measure="spatial", stretch="consistent"),
    "map.spatial.torque": _floor("error_torque", measure="spatial", stretch="consistent"),
    "map.inextensible.torque": _floor("error_torque", measure="material", stretch="inextensible"),
    "map.bspline.torque": TWELVE.at("error_torque", power),
    "elements.order": MESHES.at("order_torque", digits(4), elements=160),
    "elements.twenty.torque": MESHES.at("error_torque", power, elements=20),
    "elements.as-six": Fact(made=_as_good_as_six, form=count),
    "elements.largest.torque": MESHES.at("error_torque", power, elements=320),
    "swing.explained": SWING.at("value", lambda v: percent(1.0 - v), claim=STIFFER, formulation=LOCKS),
    "swing.locking": SWING.at("value", percent, claim=MEMBRANE, formulation=LOCKS),
    "swing.consistent": SHIFTS.at("shift", signed_percent, stretch="consistent", control_points=4),
    "swing.mixed": SHIFTS.at("shift", signed_percent, stretch="mixed", control_points=4),
    "swing.ten": Fact(made=_ten, form=percent),
    "swing.at-rest": SWING.at("value", power, claim=AT_REST, formulation=UNLOCKED),
    "backbone.rest": BACKBONE.least("frequency_Hz", unit("Hz", 4)),
    "backbone.end": BACKBONE.largest("frequency_Hz", unit("Hz", 4)),
    "backbone.difference": SWING.at("value", percent, claim=ALIKE, formulation="n = 6"),
    "estimate.statics": ESTIMATES.fact(len, count, problem="statics"),
    "estimate.statics.designs": ESTIMATES.fact(_designs, count, problem="statics"),
    "estimate.motion.designs": ESTIMATES.fact(_designs, count, problem="motion"),
    "estimate.motion.all": Stored("convergence/error_estimate", "estimates").fact(
        _designs, count, problem="motion"
    ),
    "estimate.least": ESTIMATES.least("effectivity", significant),
    "estimate.largest": ESTIMATES.largest("effectivity", significant),
    "estimate.cost": Stored("convergence/error_estimate", "timings").largest("time_ratio", significant),
}


@holds("map.two-more")
def _(r: Results) -> Any:
    """the locking-free spline meets 1e-4 with fewer control points than the consistent one"""
    return _needed(_fewer(r, 2)) < _needed(_consistent(r))


@holds("map.falls")
def _(r: Results) -> Any:
    """from four to six, eight and twelve control points the torque's error falls tenfold each time"""
    errors = [abs(free(n).value(r, "error_torque")) for n in (4, 6, 8, 12)]
    return all(fine < coarse / 10.0 for coarse, fine in pairwise(errors))


@holds("map.bspline-slower")
def _(r: Results) -> Any:
    """with twelve control points the B-spline is a hundred times farther off than the Bézier curve"""
    return abs(TWELVE.value(r, "error_torque")) > 100.0 * abs(free(12).value(r, "error_torque"))


@holds("map.one-more-worse")
def _(r: Results) -> Any:
    """one axial mode more than n - 2 makes the torque worse for some n"""
    return _gain(r) > 1.0


@holds("elements.second-order")
def _(r: Results) -> Any:
    """the observed order of both elements is 2 within 2 %"""
    rows = where(r.table("convergence/elements", "meshes"), elements=160)
    return (rows[["order_trajectory", "order_torque"]] - 2.0).abs().max().max() < 0.04


@holds("swing.all")
def _(r: Results) -> Any:
    """all findings on the frequency hold, but for the first mode at rest"""
    return set(SWING.rows(r, holds="no")["claim"]) == {AT_REST}


@holds("estimate.never-above")
def _(r: Results) -> Any:
    """no estimate is optimistic by more than three times, and every true error is below what was asked"""
    found = r.table("convergence/error_estimate", "findings")
    near = found["claim"].str.startswith("Estimates lie")  # their factors are printed
    return (found[~near]["holds"] == "yes").all()
