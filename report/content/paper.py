"""Figs 3 to 7 of the paper, its claims, and what became of each."""

from functools import partial
from typing import Any

import numpy as np
import pandas as pd

from report.facts import Cell, Fact, Holds, Rows, Shown, Table, columns, fact
from report.forms import Form, count, percent, power, signed_percent, significant, unit
from report.results import Results, at, largest, where
from studies.paper.formulations import FE, LOCKING_FREE, MEANING, PAPER
from studies.record.style import LOOKS

#: Formulations that the claims are held against.
CLAIMED = ("n = 4, as the paper", "n = 4, locking-free", "n = 6")
STUDIES_OF_CLAIMS = (
    "paper/fig03_snapshots",
    "paper/fig04_trajectory",
    "paper/fig05_stiffness",
    "paper/fig06_release",
)
#: How it is said whether a claim holds: neither is good or bad.
#: Words of the claims that say which way something is off, and not how far.
SIGNS = ("overestimates", "higher frequency")
VERDICTS = {"yes": "as claimed", "no": "not as claimed"}


def findings(results: Results) -> pd.DataFrame:
    """Return the findings on all claims of the paper's Figs 3 to 6."""
    return pd.concat([results.table(study, "findings") for study in STUDIES_OF_CLAIMS])


def _claims(results: Results) -> Table:
    rows: Rows = []
    for claim, some in findings(results).groupby("claim", sort=True):
        verdicts = some.set_index("formulation")
        cells: list[Cell] = [str(claim)]
        for name in CLAIMED:
            if name not in verdicts.index:
                cells.append("–")
                continue
            row: Any = verdicts.loc[name]
            sign = "sign " if any(word in str(claim) for word in SIGNS) else ""
            cells.append(f"{sign}{VERDICTS[str(row['holds'])]} ({percent(row['value'])})")
        rows.append(cells)
    return ["claim of the paper, as it is read", *(LOOKS[name].label for name in CLAIMED)], rows


SIX = "n = 6"
PRINTED = "n = 4, printed forces"
THREE = "n = 4, 3 Gauss points"
SHORT = {"paper": PAPER, "free": LOCKING_FREE, "six": SIX, "fe": FE, "printed": PRINTED, "three": THREE}
STATIC = (PAPER, PRINTED, THREE, LOCKING_FREE, SIX, FE)
TRAJECTORY, STIFFNESS, RELEASE = "paper/fig04_trajectory", "paper/fig05_stiffness", "paper/fig06_release"
INTERACTIVE = "paper/fig07_interactive"


def _of(study: str, column: str, form: Form, *names: str) -> dict[str, Fact]:
    figure = study.removeprefix("paper/").partition("_")[0]
    return {
        f"{figure}.{name}.{column}": fact(study, "summary", at(column, formulation=SHORT[name]), form)
        for name in names
    }


def _distance(name: str) -> Fact:
    return fact("paper/fig03_snapshots", "distances", largest("distance", formulation=SHORT[name]), percent)


def _coloured(name: str) -> Cell:
    return {"text": LOOKS[name].label, "colour": LOOKS[name].colour}


def _statics(results: Results) -> Table:
    path: Any = results.table(TRAJECTORY, "summary").set_index("formulation")
    force: Any = results.table(STIFFNESS, "summary").set_index("formulation")
    rows: Rows = [
        [
            _coloured(name),
            MEANING[name],
            power(path.loc[name, "error_largest"]),
            power(force.loc[name, "error_torque_largest"]),
            power(force.loc[name, "error_stiffness_largest"]),
            f"{unit('J', 3)(force.loc[name, 'axial_energy_end_J'])}",
        ]
        for name in STATIC
    ]
    head = ["formulation", "what it is", "trajectory", "torque", "stiffness", "axial energy at the end"]
    return head, rows


def _beyond(unsure: float, value: float) -> str:
    """Return a shift, or that it is less than the uncertainty of what it is against."""
    return signed_percent(value) if abs(value) > unsure else f"< {percent(unsure)}"


def _release(results: Results) -> Table:
    found = results.table(RELEASE, "summary").set_index("formulation", drop=False)
    unsure = float(at("uncertainty", quantity="frequency")(results.table(RELEASE, "reference")))
    shown: Shown = {
        "formulation": ("formulation", str),
        "frequency": ("frequency_Hz", unit("Hz", 5)),
        "shift": ("frequency_shift", partial(_beyond, unsure)),
        "rotation": ("error_rotation_rad", unit("rad")),
        "centre": ("error_centre_m", unit("mm", 2, 1e3)),
        "energy": ("energy_error", power),
        "integrator": ("integrator", str),
        "step": ("step_s", unit("µs", 2, 1e6)),
    }
    names = [PAPER, LOCKING_FREE, SIX, "n = 10", FE]
    head, rows = columns(found.loc[names], shown)
    labels = (_coloured(name) if name in LOOKS else f"spline {name}" for name in names)
    return head, [[label, *row[1:]] for label, row in zip(labels, rows, strict=True)]


def _frames(table: pd.DataFrame) -> float:
    return float((len(table) - 1) / (table["at_s"].max() - table["at_s"].min()))


#: What is timed of a picture in the loop, by the columns that hold it.
PARTS = {"track": ["track_ms"], "solve": ["solve_ms"], "both": ["track_ms", "solve_ms"]}


def _within(part: str, share: float, table: pd.DataFrame) -> float:
    """Return the time [ms] that a part takes at most for this share of the pictures."""
    return float(table[PARTS[part]].sum(axis=1).quantile(share))


def _alone(table: pd.DataFrame) -> float:
    """Return the 95th percentile of the slowest work and preset [ms], the best repeat of each."""
    best = table.groupby(["preset", "work", "frame"])["time_ms"].min()
    return float(best.groupby(["preset", "work"]).quantile(0.95).max())


def _share_of_energy(name: str) -> Fact:
    def made(results: Results) -> float:
        row = where(results.table(STIFFNESS, "summary"), formulation=SHORT[name]).iloc[0]
        return float(row["axial_energy_end_J"] / (row["axial_energy_end_J"] + row["bending_energy_end_J"]))

    return Fact(made=made, form=percent)


def _within_percent(column: str, share: float, results: Results) -> float:
    """Return the rotation [deg] at which the paper's four points pass an error, between increments."""
    rows = where(results.table(STIFFNESS, "curves"), formulation=PAPER).sort_values("rotation_rad")
    rows = rows.dropna(subset=[column])
    errors, turns = rows[column].abs().to_numpy(), np.degrees(rows["rotation_rad"].to_numpy())
    return float(np.interp(share, errors, turns))


def _free_error(results: Results, n: int, quantity: str) -> float:
    """Return the largest error of the locking-free spline of n control points."""
    settings = {"basis": "bezier", "measure": "material", "stretch": "mixed", "axial_modes": n - 2}
    table = results.table("convergence/control_points", "map")
    return abs(float(at(f"error_{quantity}", control_points=n, **settings)(table)))


def _value(results: Results, study: str, column: str, name: str) -> float:
    return float(at(column, formulation=name)(results.table(study, "summary")))


FACTS = {
    **{f"fig03.{name}": _distance(name) for name in ("paper", "free", "six", "fe")},
    **_of(TRAJECTORY, "difference_to_fe20_end", percent, "paper", "free", "six", "three"),
    **_of(STIFFNESS, "error_torque_largest", percent, "paper", "free", "printed"),
    **_of(STIFFNESS, "error_torque_largest", power, "six"),
    **_of(STIFFNESS, "error_torque_half", percent, "paper"),
    **_of(STIFFNESS, "error_stiffness_largest", percent, "paper", "free"),
    **_of(STIFFNESS, "error_stiffness_largest", power, "six"),
    **_of(RELEASE, "frequency_Hz", unit("Hz", 4), "paper", "fe"),
    **_of(RELEASE, "frequency_shift", signed_percent, "paper", "free"),
    **_of(RELEASE, "error_rotation_rad", unit("rad"), "free", "six", "fe"),
    "fig05.paper.axial-share": _share_of_energy("paper"),
    "fig05.free.axial-share": _share_of_energy("free"),
    **{
        f"fig05.paper.{name}": Fact(
            made=partial(_within_percent, column, share), form=lambda value: f"{significant(value, 2)}°"
        )
        for name, column, share in (
            ("within", "error_torque", 0.01),
            ("within.stiffness", "error_stiffness", 0.01),
            ("lost", "error_torque", 0.03),
        )
    },
    "fig05.torque": fact(STIFFNESS, "curves", largest("torque_Nm", formulation="FE refined"), unit("N m", 4)),
    "fig05.paper.torque": fact(STIFFNESS, "curves", largest("torque_Nm", formulation=PAPER), unit("N m", 4)),
    "fig06.energy": fact(
        RELEASE, "motions", at("strain_J", formulation="FE refined", time_s=0.0), unit("J", 3)
    ),
    "fig07.rate": fact(INTERACTIVE, "frames_times", _frames, unit("Hz", 3)),
    **{
        f"fig07.{part}.{name}": fact(INTERACTIVE, "frames_times", partial(_within, part, share), unit("ms"))
        for part in PARTS
        for name, share in (("median", 0.5), ("most", 0.95))
    },
    "fig07.both.longest": fact(INTERACTIVE, "frames_times", partial(_within, "both", 1.0), unit("ms")),
    "fig07.first": fact(INTERACTIVE, "frames_times", at("solve_ms", frame=0), unit("s", 2, 1e-3)),
    "fig07.alone": fact(INTERACTIVE, "alone_times", _alone, unit("ms")),
    "fig07.frames": fact(INTERACTIVE, "frames_times", len, count),
}

HOLDS = {
    "fig03.paper-beyond": Holds(
        words="the locked spline is off by more than 1 % of the length, the locking-free one by less",
        test=lambda r: (
            largest("distance", formulation=PAPER)(r.table("paper/fig03_snapshots", "distances"))
            > 0.01
            > largest("distance", formulation=LOCKING_FREE)(r.table("paper/fig03_snapshots", "distances"))
        ),
    ),
    "fig04.holds": Holds(
        words="all paths differ from that of 20 elements by less than 1 % at the end",
        test=lambda r: all(
            abs(_value(r, TRAJECTORY, "difference_to_fe20_end", name)) < 0.01
            for name in (PAPER, LOCKING_FREE, SIX)
        ),
    ),
    "fig04.only-three": Holds(
        words="three Gauss points alone are off by more than 1 % of the displacement",
        test=lambda r: (
            list(r.table(TRAJECTORY, "summary").query("error_largest > 0.01")["formulation"]) == [THREE]
        ),
    ),
    "fig05.locks": Holds(
        words="the locked spline's torque is off by more than its own size, the others' by under 3 %",
        test=lambda r: (
            _value(r, STIFFNESS, "error_torque_largest", PAPER) > 1.0
            and all(_value(r, STIFFNESS, "error_torque_largest", name) < 0.03 for name in (LOCKING_FREE, SIX))
        ),
    ),
    "fig05.overestimates": Holds(
        words="both four-point splines overestimate the stiffness at the end",
        test=lambda r: all(
            _value(r, STIFFNESS, "error_stiffness_end", name) > 0.0 for name in (PAPER, LOCKING_FREE)
        ),
    ),
    "designer.trust": Holds(
        words="six points keep 1e-4 and eight 1e-6 in torque, four 1 % in the path",
        test=lambda r: all(
            _free_error(r, n, quantity) <= most
            for n, quantity, most in ((6, "torque", 1e-4), (8, "torque", 1e-6), (4, "trajectory", 1e-2))
        ),
    ),
    "fig06.faster": Holds(
        words="both four-point splines swing faster than 20 elements, the locked one by half or more",
        test=lambda r: (
            _value(r, RELEASE, "frequency_shift", PAPER) > 0.5
            and 0.01
            > _value(r, RELEASE, "frequency_shift", LOCKING_FREE)
            > _value(r, RELEASE, "frequency_shift", FE)
        ),
    ),
    "fig06.six-finer": Holds(
        words="six control points follow the swing better than 20 elements",
        test=lambda r: (
            _value(r, RELEASE, "error_rotation_rad", SIX) < _value(r, RELEASE, "error_rotation_rad", FE)
        ),
    ),
    "fig07.real-time": Holds(
        words="the mean rate is at least 24 pictures a second and the solver alone takes under 1 ms for 95 %",
        test=lambda r: (
            _frames(r.table(INTERACTIVE, "frames_times")) > 24.0
            and _alone(r.table(INTERACTIVE, "alone_times")) < 1.0
        ),
        timed=True,
    ),
    "fig07.keeps-up": Holds(
        words="finding the markers and solving take less than the time between pictures, for each of them",
        test=lambda r: (
            _within("both", 1.0, r.table(INTERACTIVE, "frames_times"))
            < 1e3 / _frames(r.table(INTERACTIVE, "frames_times"))
        ),
        timed=True,
    ),
    "fig07.first-longest": Holds(
        words="the first picture takes the longest to solve",
        test=lambda r: r.table(INTERACTIVE, "frames_times").sort_values("solve_ms")["frame"].iloc[-1] == 0,
        timed=True,
    ),
}
LISTINGS = {"claims": _claims, "statics": _statics, "release": _release}
