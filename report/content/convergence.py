"""Errors of the benchmark pivot: their budget, how the formulations agree, convergence and estimates."""

import math
from typing import Any

from report.content.basis import TORQUE
from report.facts import FACTS, HOLDS, Results, Stored, Table, listing
from report.forms import percent, signed_percent, significant, unit

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
PLATE = Stored("model_form/plate", "paper")
PIVOTS = Stored("charts/pivot", "validity", pivot="cross_axis_pivot")
GRAVITY = Stored("effects/worth", "worth", design="Table 1", scene="no gravity")


def free(n: int) -> Stored:
    """Return the row of the map for the locking-free default: two axial modes fewer than control points."""
    return MAP.where(measure="material", stretch="mixed", control_points=n, axial_modes=n - 2)


#: Source of an error of the torque -> rows and column that have it; the largest of several is drawn.
BUDGET: dict[str, tuple[Stored, str]] = {
    "membrane locking, n = 4 as published": (PAPER, "error_torque"),
    "supports cut from one block": (PIVOTS, "roots"),
    "plate action at the clamps": (PLATE, "excess"),
    "n = 4 without locking": (free(4), "error_torque"),
    "shear": (TORQUE, "distance_to_material"),
    "20 elements per strip": (TWENTY, "error_torque"),
    "stretching": (RIGID, "error_torque"),
    "n = 6 without locking": (free(6), "error_torque"),
    "gravity": (GRAVITY, "torque"),
    "n = 8 without locking": (free(8), "error_torque"),
    "uncertainty of the reference": (STATICS.where(quantity="torque"), "uncertainty"),
}


@listing("budget")
def _budget(results: Results) -> Table:
    """Return every source with its error and the decimal logarithm of it, the largest first."""
    sources = {each: rows.rows(results)[name].abs() for each, (rows, name) in BUDGET.items()}
    yield ["source", "error", "logarithm"]
    for source, errors in sorted(sources.items(), key=lambda each: -each[1].max()):
        lowest = f"{percent(errors.min())} to " if len(errors) > 1 else ""
        yield [source, lowest + percent(errors.max()), str(math.log10(errors.max()))]


@listing("agreement")
def _agreement(results: Results) -> Table:
    """Return the errors of the static path and of the swing, a row a formulation."""
    shown = {"n = 4, as the paper": PAPER, "n = 4, locking-free": free(4)}
    shown |= {f"n = {n}": free(n) for n in COUNTS[1:]} | {"FE, 20 elements": TWENTY}
    yield ["largest error", *QUANTITIES, "swing frequency", "swing rotation"]
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
    "estimate.cost": Stored("convergence/error_estimate", "timings").largest("time_ratio", significant),
}
HOLDS |= {
    "elements.second-order": Stored("convergence/elements", "findings").found("The torque of the finite"),
    "swing.locking": FREQUENCY.found("The shift at four control points is mostly membrane locking"),
    "swing.rest": FREQUENCY.found("The first mode at rest shows", holds="no"),
    "estimate.never-above": Stored("convergence/error_estimate", "findings").found("The true error is below"),
}
