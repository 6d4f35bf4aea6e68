"""What accuracy costs in motion: error of the rotation after the release against time and counted work.

The pivot of Table 1 is held at 90 degrees, let go, and followed for 0.05 s: some four swings. All models of
one theory are held against a spline that is finer than any shown, and whose own error is its distance to the
next coarser one: the explicit finite elements tend to the same motion, but reach less. Time is that of the
steps alone, without the static path to the start, the median of repeats, on one thread.
"""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from studies.answers.frequency import swing_frequency
from studies.answers.metrics import Array
from studies.answers.settings import SplineSettings
from studies.baselines.registry import missing
from studies.cases.problem import Problem, named_case
from studies.paper.findings import Finding, table
from studies.work_precision import figures
from studies.work_precision.equal_error import cheapest
from studies.work_precision.motions import MovingMember, SolvedMotion, at, motion_errors, moving
from studies.work_precision.moving_series import SPLINE, MovingSeries, other_series, own_series
from studies.work_precision.static_findings import Ratio

__all__ = ["CASES", "compute", "draw", "equal_error", "missing"]

CASE = "cross_axis_pivot"
CASES = (CASE,)

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


def compute(progress: Callable[[int, int], None]) -> dict[str, pd.DataFrame]:
    """Return errors, work and times of all settings, what is cheapest at equal error, and the findings.

    Tables: errors, timings, reference, digits (cheapest by counted work), digits_of_time, findings and
    findings_of_time.
    """
    problem, series = named_case(CASE), [*own_series(), *other_series()]
    total = 2 + sum(len(each.members) for each in series)
    rotation, reference = _reference(problem, lambda done: progress(done, total))
    errors: list[dict[str, Any]] = []
    times: list[dict[str, Any]] = []
    for each in series:
        for rank, member in enumerate(each.members):
            progress(2 + len(errors), total)
            motion = member.solve(problem, DURATION)
            errors.append(_errors(each, member, rank, motion, rotation, reference))
            times.append(_times(each, member, motion))
    progress(total, total)
    tables = {"errors": pd.DataFrame(errors), "timings": pd.DataFrame(times), "reference": reference}
    tables |= equal_error(tables)
    return tables | {
        "findings": table(_findings(tables)),
        "findings_of_time": table(_findings_of_time(tables)),
    }


def draw(tables: Mapping[str, pd.DataFrame]) -> dict[str, Figure]:
    """Draw the work-precision diagram of the motion."""
    return {"work_precision_dynamics": figures.dynamics(tables, MARGIN)}


def equal_error(tables: Mapping[str, pd.DataFrame]) -> dict[str, pd.DataFrame]:
    """Return the cheapest settings at equal error of the rotation, by work and by time."""
    rows = tables["errors"].merge(tables["timings"], on=["series", "setting"])
    asked: dict[str, Any] = {
        "columns": ["error_rotation_rad"],
        "rank": "rank",
        "targets": TARGETS,
        "baseline": SPLINE,
    }
    return {
        "digits": cheapest(rows, cost="flops", **asked),
        "digits_of_time": cheapest(rows, cost="solve_s", **asked),
    }


def _reference(problem: Problem, progress: Callable[[int], None]) -> tuple[Array, pd.DataFrame]:
    """Return the rotation at the instants (T,) [rad] and how uncertain it and its frequency are."""
    rotations = []
    for done, (n, step) in enumerate(REFERENCE.items()):
        progress(done)
        member = moving(
            SplineSettings(control_points=n), f"n = {n}", "reference", integrator="leapfrog", step=step
        )
        rotations.append(at(member.solve(problem, DURATION), INSTANTS))
    coarse, fine = rotations
    frequencies = [swing_frequency(INSTANTS, rotation).value for rotation in rotations]
    source = " and ".join(f"n = {n} at {1e6 * step:g} µs" for n, step in REFERENCE.items())
    values = {
        "rotation_rad": float(np.abs(fine - coarse).max()),
        "frequency": abs(frequencies[0] / frequencies[1] - 1.0),
    }
    rows = [{"quantity": name, "uncertainty": value, "source": source} for name, value in values.items()]
    return fine, pd.DataFrame(rows)


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


def _findings(tables: Mapping[str, pd.DataFrame]) -> list[Finding]:
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


def _findings_of_time(tables: Mapping[str, pd.DataFrame]) -> list[Finding]:
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
