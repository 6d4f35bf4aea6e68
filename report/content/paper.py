"""Figs 3 to 7 of the paper, its claims, and what became of each."""

from functools import partial
from typing import Any

import numpy as np
import pandas as pd

from report.content.convergence import free
from report.facts import FACTS, Cell, Fact, Results, Shown, Stored, Table, columns, holds, listing
from report.forms import Form, angle, count, percent, power, signed_percent, unit
from studies.record.style import LOOKS

PAPER, LOCKING_FREE, SIX, FE = "n = 4, as the paper", "n = 4, locking-free", "n = 6", "FE, 20 elements"
PRINTED, THREE, REFINED = "n = 4, printed forces", "n = 4, 3 Gauss points", "FE refined"
#: Formulations that the claims are held against, and all that the figures compare.
CLAIMED = (PAPER, LOCKING_FREE, SIX)
STATIC = (PAPER, PRINTED, THREE, LOCKING_FREE, SIX, FE)
#: Short name -> formulation.
SHORT = {"paper": PAPER, "free": LOCKING_FREE, "six": SIX, "fe": FE, "printed": PRINTED, "three": THREE}
SNAPSHOTS, TRAJECTORY = "paper/fig03_snapshots", "paper/fig04_trajectory"
STIFFNESS, RELEASE = "paper/fig05_stiffness", "paper/fig06_release"
SHAPES = Stored(SNAPSHOTS, "distances")
PATH, FORCE, SWING = (Stored(study, "summary") for study in (TRAJECTORY, STIFFNESS, RELEASE))
CURVES = Stored(STIFFNESS, "curves")
FRAMES, ALONE = (Stored("paper/fig07_interactive", name) for name in ("frames_times", "alone_times"))
#: Words of the claims that say which way something is off, and not how far.
SIGNS = ("overestimates", "higher frequency")
#: How it is said whether a claim holds: neither is good or bad.
VERDICTS = {"yes": "as claimed", "no": "not as claimed"}
#: Thresholds that every claim of a size is held against as well.
THRESHOLDS = (0.01, 0.03, 0.1)


def _findings(results: Results) -> pd.DataFrame:
    """Return the findings on all claims of the paper's Figs 3 to 6."""
    studies = (SNAPSHOTS, TRAJECTORY, STIFFNESS, RELEASE)
    return pd.concat([results.table(study, "findings") for study in studies])


def _is_sign(claim: str) -> bool:
    return any(word in claim for word in SIGNS)


@listing("claims")
def _claims(results: Results) -> Table:
    yield ["claim of the paper, as it is read", *(LOOKS[name].label for name in CLAIMED)]
    for claim, some in _findings(results).groupby("claim"):
        verdicts = {row["formulation"]: row for row in some.to_dict("records")}
        sign = "sign " if _is_sign(str(claim)) else ""
        held = [verdicts.get(name) for name in CLAIMED]
        cells = [row and f"{sign}{VERDICTS[row['holds']]} ({percent(row['value'])})" for row in held]
        yield [str(claim), *(cell or "–" for cell in cells)]


@listing("thresholds")
def _thresholds(results: Results) -> Table:
    """Return which formulations would be within other thresholds than those that are taken."""
    yield ["claim of a size", *(f"within {100.0 * level:.0f} %" for level in THRESHOLDS)]
    for claim, some in _findings(results).groupby("claim"):
        off = some.set_index("formulation")["value"].abs()
        within = ([name for name in CLAIMED if off[name] <= level] for level in THRESHOLDS)
        cells = ("all" if len(names) == len(CLAIMED) else "; ".join(names) or "none" for names in within)
        if not _is_sign(str(claim)):
            yield [str(claim), *cells]


def _coloured(name: str) -> Cell:
    if name not in LOOKS:
        return f"spline {name}"
    return {"text": LOOKS[name].label, "colour": LOOKS[name].colour}


@listing("statics")
def _statics(results: Results) -> Table:
    both = PATH.rows(results).merge(FORCE.rows(results).drop(columns="meaning"), on="formulation")
    shown: Shown = {
        "formulation": ("formulation", _coloured),
        "what it is": ("meaning", str),
        "trajectory": ("error_largest", power),
        "torque": ("error_torque_largest", power),
        "stiffness": ("error_stiffness_largest", power),
        "axial energy at the end": ("axial_energy_end_J", unit("J", 3)),
    }
    return columns(both.set_index("formulation", drop=False).loc[list(STATIC)], shown)


def _beyond(unsure: float, value: float) -> str:
    """Return a shift, or that it is less than the uncertainty of what it is against."""
    return signed_percent(value) if abs(value) > unsure else f"< {percent(unsure)}"


@listing("release")
def _release(results: Results) -> Table:
    unsure = float(Stored(RELEASE, "reference").value(results, "uncertainty", quantity="frequency"))
    shown: Shown = {
        "formulation": ("formulation", _coloured),
        "frequency": ("frequency_Hz", unit("Hz", 5)),
        "shift": ("frequency_shift", partial(_beyond, unsure)),
        "rotation": ("error_rotation_rad", unit("rad")),
        "centre": ("error_centre_m", unit("mm", 2, 1e3)),
        "energy": ("energy_error", power),
        "integrator": ("integrator", str),
        "step": ("step_s", unit("µs", 2, 1e6)),
    }
    found: Any = SWING.rows(results).set_index("formulation", drop=False)
    return columns(found.loc[[PAPER, LOCKING_FREE, SIX, "n = 10", FE]], shown)


def _rate(frames: pd.DataFrame) -> float:
    return float((len(frames) - 1) / (frames["at_s"].max() - frames["at_s"].min()))


#: What is timed of a picture in the loop, by the columns that hold it.
PARTS = {"track": ["track_ms"], "solve": ["solve_ms"], "both": ["track_ms", "solve_ms"]}


def _within(part: str, share: float, frames: pd.DataFrame) -> float:
    """Return the time [ms] that a part takes at most for this share of the pictures."""
    return float(frames[PARTS[part]].sum(axis=1).quantile(share))


def _slowest(frames: pd.DataFrame) -> float:
    """Return the 95th percentile of the slowest work and preset [ms], the best repeat of each."""
    best = frames.groupby(["preset", "work", "frame"])["time_ms"].min()
    return float(best.groupby(["preset", "work"]).quantile(0.95).max())


def _axial_share(summary: pd.DataFrame) -> float:
    axial, bending = (float(summary[f"{part}_energy_end_J"].iloc[0]) for part in ("axial", "bending"))
    return axial / (axial + bending)


def _passes(name: str, share: float, curves: pd.DataFrame) -> float:
    """Return the rotation [deg] at which an error passes a share, between increments."""
    rows = curves.sort_values("rotation_rad").dropna(subset=name)
    return float(np.interp(share, rows[name].abs(), np.degrees(rows["rotation_rad"])))


def _of(figure: str, stored: Stored, name: str, form: Form, *formulations: str) -> dict[str, Fact]:
    return {
        f"{figure}.{short}.{name}": stored.at(name, form, formulation=SHORT[short]) for short in formulations
    }


FACTS |= {
    f"fig03.{name}": SHAPES.largest("distance", percent, formulation=SHORT[name])
    for name in ("paper", "free", "six", "fe")
}
FACTS |= _of("fig04", PATH, "difference_to_fe20_end", percent, "paper", "free", "six", "three")
FACTS |= _of("fig05", FORCE, "error_torque_largest", percent, "paper", "free", "printed")
FACTS |= _of("fig05", FORCE, "error_torque_half", percent, "paper")
FACTS |= _of("fig05", FORCE, "error_stiffness_largest", percent, "paper", "free")
FACTS |= _of("fig05", FORCE, "error_torque_largest", power, "six")
FACTS |= _of("fig05", FORCE, "error_stiffness_largest", power, "six")
FACTS |= _of("fig06", SWING, "frequency_Hz", unit("Hz", 4), "paper", "fe")
FACTS |= _of("fig06", SWING, "frequency_shift", signed_percent, "paper", "free")
FACTS |= _of("fig06", SWING, "error_rotation_rad", unit("rad"), "free", "six", "fe")
FACTS |= {
    f"fig05.paper.{name}": CURVES.fact(partial(_passes, error, share), angle(), formulation=PAPER)
    for name, error, share in (
        ("within", "error_torque", 0.01),
        ("within.stiffness", "error_stiffness", 0.01),
        ("lost", "error_torque", 0.03),
    )
}
FACTS |= {
    f"fig07.{part}.{name}": FRAMES.fact(partial(_within, part, share), unit("ms"))
    for part in PARTS
    for name, share in (("median", 0.5), ("most", 0.95))
}
FACTS |= {
    "fig05.paper.axial-share": FORCE.fact(_axial_share, percent, formulation=PAPER),
    "fig05.free.axial-share": FORCE.fact(_axial_share, percent, formulation=LOCKING_FREE),
    "fig05.torque": CURVES.largest("torque_Nm", unit("N m", 4), formulation=REFINED),
    "fig05.paper.torque": CURVES.largest("torque_Nm", unit("N m", 4), formulation=PAPER),
    "fig06.energy": Stored(RELEASE, "motions", formulation=REFINED, time_s=0.0).at("strain_J", unit("J", 3)),
    "fig07.rate": FRAMES.fact(_rate, unit("Hz", 3)),
    "fig07.both.longest": FRAMES.fact(partial(_within, "both", 1.0), unit("ms")),
    "fig07.first": FRAMES.at("solve_ms", unit("s", 2, 1e-3), frame=0),
    "fig07.alone": ALONE.fact(_slowest, unit("ms")),
    "fig07.frames": FRAMES.fact(len, count),
}


@holds("claims.threshold")
def _(r: Results) -> Any:
    """only in shape and path are the paper's choices within any of the thresholds, in the path in all"""
    off = _findings(r).query("formulation == @PAPER").set_index("claim")["value"].abs()
    sizes = off[[not _is_sign(claim) for claim in off.index]]
    forces = [each.startswith(("Fig 5", "Fig 6")) for each in sizes.index]
    return (sizes[forces] > max(THRESHOLDS)).all() and sizes.filter(like="Fig 4").max() < min(THRESHOLDS)


@holds("fig03.paper-beyond")
def _(r: Results) -> Any:
    """the locked spline is off by more than 1 % of the length, the locking-free one by less"""
    locked, released = (SHAPES.rows(r, formulation=name)["distance"].max() for name in (PAPER, LOCKING_FREE))
    return locked > 0.01 > released


@holds("fig04.holds")
def _(r: Results) -> Any:
    """all paths differ from that of 20 elements by less than 1 % at the end"""
    return all(abs(PATH.value(r, "difference_to_fe20_end", formulation=name)) < 0.01 for name in CLAIMED)


@holds("fig04.only-three")
def _(r: Results) -> Any:
    """three Gauss points alone are off by more than 1 % of the displacement"""
    return list(PATH.rows(r).query("error_largest > 0.01")["formulation"]) == [THREE]


@holds("fig05.locks")
def _(r: Results) -> Any:
    """the locked spline's torque is off by more than its own size, the others' by under 3 %"""
    locked, *others = (FORCE.value(r, "error_torque_largest", formulation=name) for name in CLAIMED)
    return locked > 1.0 and max(others) < 0.03


@holds("fig05.overestimates")
def _(r: Results) -> Any:
    """both four-point splines overestimate the stiffness at the end"""
    return all(FORCE.value(r, "error_stiffness_end", formulation=name) > 0.0 for name in CLAIMED[:2])


@holds("designer.trust")
def _(r: Results) -> Any:
    """six points keep 1e-4 and eight 1e-6 in torque, four 1 % in the path"""
    kept = ((6, "torque", 1e-4), (8, "torque", 1e-6), (4, "trajectory", 1e-2))
    return all(abs(free(n).value(r, f"error_{quantity}")) <= most for n, quantity, most in kept)


@holds("fig06.faster")
def _(r: Results) -> Any:
    """both four-point splines swing faster than 20 elements, the locked one by half or more"""
    paper, released, fe = (
        SWING.value(r, "frequency_shift", formulation=name) for name in (PAPER, LOCKING_FREE, FE)
    )
    return paper > 0.5 and 0.01 > released > fe


@holds("fig06.six-finer")
def _(r: Results) -> Any:
    """six control points follow the swing better than 20 elements"""
    six, fe = (SWING.value(r, "error_rotation_rad", formulation=name) for name in (SIX, FE))
    return six < fe


@holds("fig07.real-time", timed=True)
def _(r: Results) -> Any:
    """the mean rate is at least 24 pictures a second and the solver alone takes under 1 ms for 95 %"""
    return _rate(FRAMES.rows(r)) > 24.0 and _slowest(ALONE.rows(r)) < 1.0


@holds("fig07.keeps-up", timed=True)
def _(r: Results) -> Any:
    """finding the markers and solving take less than the time between pictures, for each of them"""
    return _within("both", 1.0, FRAMES.rows(r)) < 1e3 / _rate(FRAMES.rows(r))


@holds("fig07.first-longest", timed=True)
def _(r: Results) -> Any:
    """the first picture takes the longest to solve"""
    return FRAMES.rows(r).sort_values("solve_ms")["frame"].iloc[-1] == 0
