"""The paper's claims on its Figs 3 to 7 and on its solver, and what was found of each."""

import pandas as pd

from report.facts import FACTS, HOLDS, LISTINGS, Fact, Results, Stored, Table, listing
from report.forms import Form, count, percent, seconds, signed_percent, times, unit

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
    "impulses.limit": LIMITS.at("measured_s", seconds, design="Table 1", group="axial", sweeps=0),
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
    "readings": Stored("paper/readings", "readings").table(
        {
            "centre of mass, or what is added": ("reading", str),
            "travel of the centre": ("travel_m", unit("mm", 3, 1e3)),
            "frequency": ("frequency_Hz", unit("Hz", 4)),
            "rotation changes by": ("rotation_rad", unit("rad")),
        },
        by="rotation_rad",
    ),
}
