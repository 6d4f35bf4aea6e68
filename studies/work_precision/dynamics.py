"""What accuracy costs in motion: error of the rotation after the release against time and counted work.

The pivot of Table 1 is held at 90 degrees, let go, and followed for 0.05 s: some four swings. All models of
one theory are held against a spline that is finer than any shown, and whose own error is its distance to the
next coarser one: the explicit finite elements tend to the same motion, but reach less. Time is that of the
steps alone, without the static path to the start, the median of repeats, on one thread.
"""

from functools import cache
from typing import Any

import numpy as np
import pandas as pd

from studies.answers.frequency import swing_frequency
from studies.answers.settings import SplineSettings
from studies.baselines.registry import missing
from studies.cases.problem import named_case
from studies.engine.findings import Finding, Tables
from studies.engine.study import Answer, Part, Study
from studies.kinds import Array
from studies.work_precision import figures
from studies.work_precision.equal_error import cheapest
from studies.work_precision.motions import MovingMember, SolvedMotion, at, motion_errors, moving
from studies.work_precision.moving_series import SPLINE, MovingSeries, other_series, own_series
from studies.work_precision.static_findings import Ratio

CASE = "cross_axis_pivot"

DURATION = 0.05
INSTANTS = np.linspace(0.0, DURATION, 501)
#: The reference: leapfrog splines by control points and step [s], the coarser one first.
REFERENCE = {14: 4e-7, 16: 3e-7}
#: An error is shown where it is this many times that of the reference.
MARGIN = 10.0
#: Errors of the rotation [rad] at which models are compared.
TARGETS = (1e-1, 2e-2, 1e-2, 5e-3, 2e-3, 1e-3)
#: The error at which the paper's comparison is made [rad].
COMPARED = 1e-2


def members() -> list[tuple[MovingSeries, int, MovingMember]]:
    """Return every setting with its series and its rank there."""
    return [
        (series, rank, member)
        for series in (*own_series(), *other_series())
        for rank, member in enumerate(series.members)
    ]


def solved(series: MovingSeries, rank: int, member: MovingMember) -> Answer:
    """Return errors, work and times of a setting."""
    motion = member.solve(named_case(CASE), DURATION)
    rotation, reference = _reference()
    return {
        "errors": _errors(series, member, rank, motion, rotation, pd.DataFrame(reference)),
        "timings": _times(series, member, motion),
    }


def _cheapest(tables: Tables, cost: str) -> pd.DataFrame:
    """Return the cheapest settings at equal error of the rotation."""
    return cheapest(
        tables["errors"].merge(tables["timings"], on=["series", "setting"]),
        columns=["error_rotation_rad"],
        cost=cost,
        rank="rank",
        targets=TARGETS,
        baseline=SPLINE,
    )


@cache
def _reference() -> tuple[Array, list[dict[str, Any]]]:
    """Return the rotation at the instants (T,) [rad] and how uncertain it and its frequency are."""
    rotations = []
    for n, step in REFERENCE.items():
        member = moving(
            SplineSettings(control_points=n), f"n = {n}", "reference", integrator="leapfrog", step=step
        )
        rotations.append(at(member.solve(named_case(CASE), DURATION), INSTANTS))
    coarse, fine = rotations
    frequencies = [swing_frequency(INSTANTS, rotation).value for rotation in rotations]
    source = " and ".join(f"n = {n} at {1e6 * step:g} µs" for n, step in REFERENCE.items())
    values = {
        "rotation_rad": float(np.abs(fine - coarse).max()),
        "frequency": abs(frequencies[0] / frequencies[1] - 1.0),
    }
    return fine, [
        {"quantity": name, "uncertainty": value, "source": source} for name, value in values.items()
    ]


def _errors(
    series: MovingSeries,
    member: MovingMember,
    rank: int,
    motion: SolvedMotion,
    rotation: Array,
    reference: pd.DataFrame,
) -> dict[str, Any]:
    uncertain = reference.set_index("quantity")["uncertainty"]
    return {
        "series": series.name,
        "family": member.family,
        "setting": member.setting,
        "rank": rank,
        "step_s": member.step,
        "status": motion.status,
        **motion_errors(motion, rotation, INSTANTS),
        "reference_rotation_rad": uncertain["rotation_rad"],
        "reference_frequency": uncertain["frequency"],
        **motion.work,
        "message": motion.message,
    }


def _times(series: MovingSeries, member: MovingMember, motion: SolvedMotion) -> dict[str, Any]:
    return {
        "series": series.name,
        "setting": member.setting,
        "solve_s": motion.solve_s,
        "real_time_factor": DURATION / motion.solve_s,
        "repeats": motion.repeats,
    }


def _findings(tables: Tables) -> list[Finding]:
    """Return findings that do not depend on the machine."""
    found = _ratios(tables["digits"], "counted work")
    for row in tables["reference"].to_dict("records"):
        error = tables["errors"][f"error_{row['quantity']}"]
        least = error.min()
        found.append(
            Finding(
                claim="The reference is ten times finer than every error",
                formulation=row["quantity"],
                quantity="the uncertainty of the reference over the smallest error",
                value=float(row["uncertainty"] / least),
                holds=bool(MARGIN * row["uncertainty"] <= least),
            )
        )
    return found


def _findings_of_time(tables: Tables) -> list[Finding]:
    """Return findings of time: they differ from run to run and machine to machine."""
    found = _ratios(tables["digits_of_time"], "time")
    best = tables["digits_of_time"].query("series == @SPLINE and target == @COMPARED").iloc[0]
    factor = DURATION / float(best["solve_s"])
    found.append(
        Ratio(
            claim=f"The swing within {COMPARED:g} rad is followed five times as fast as it happens",
            formulation=str(best["setting"]),
            quantity="the duration of the motion over that of its computation",
            value=factor,
            holds=factor > 5.0,
        )
    )
    return found


def _ratios(digits: pd.DataFrame, cost: str) -> list[Finding]:
    """Return how many times the spline's cost the others take at equal error."""
    others = digits.query("series != @SPLINE and target == @COMPARED")
    return [
        Ratio(
            claim=f"At {COMPARED:g} rad over {DURATION:g} s the spline takes less {cost}",
            formulation=f"{row['series']}, {row['setting']}",
            quantity=f"its {cost} over that of the spline",
            value=float(row["ratio"]),
            holds=bool(row["ratio"] > 1.0),
        )
        for row in others[others["ratio"].notna()].to_dict("records")
    ]


STUDY = Study(
    cases=(CASE,),
    parts=(
        Part(ask=lambda: {"reference": _reference()[1]}, alone=True),
        Part(at=members, ask=solved, alone=True),
    ),
    made={
        "digits": lambda tables: _cheapest(tables, "flops"),
        "digits_of_time": lambda tables: _cheapest(tables, "solve_s"),
    },
    claims=(_findings,),
    claims_of_time=(_findings_of_time,),
    figures={"work_precision_dynamics": lambda tables: figures.dynamics(tables, MARGIN)},
    missing=missing,
)
