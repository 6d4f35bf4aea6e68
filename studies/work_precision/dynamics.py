"""What accuracy costs in motion: error of the rotation after the release against time.

The pivot of Table 1 is held at 90 degrees, let go, and followed for 0.05 s: some four swings. All models of
one theory are held against a spline that is finer than any shown, and whose own error is its distance to the
next coarser one: the explicit finite elements tend to the same motion, but reach less. Time is that of the
steps alone, without the static path to the start, the median of repeats, on one thread.
"""

import math
from functools import cache
from typing import Any

import numpy as np
import pandas as pd

from studies.answers.adapters import answer_release
from studies.answers.metrics import swing_frequency
from studies.answers.settings import SplineSettings
from studies.baselines.compared import missing
from studies.baselines.own import FINE_RECORDS
from studies.baselines.variant import Variant, ranked
from studies.cases.problem import named_case
from studies.engine import Answer, Claim, Part, Study, Tables
from studies.kinds import Array
from studies.paper.formulations import DURATION, INSTANTS
from studies.work_precision.equal_error import digits, finer, less_time
from studies.work_precision.limits import at, counted, motion_errors
from studies.work_precision.series import SPLINE, other_swings, own_swings

#: The reference: leapfrog splines by control points and step [s], the coarser one first.
REFERENCE = {14: 4e-7, 16: 3e-7}
#: Errors of the rotation [rad] at which models are compared.
TARGETS = (1e-1, 2e-2, 1e-2, 5e-3, 2e-3, 1e-3)
#: The error at which the paper's comparison is made [rad].
COMPARED = 1e-2
AT_EQUAL = f"At {{target:g}} rad over {DURATION:g} s"
#: What every model counts, as far as it has it.
COUNTERS = ("steps", "evaluations", "factorisations")


def _solved(rank: int, variant: Variant) -> Answer:
    """Return errors, counters and times of a setting, `rank` being its place in its series."""
    motion = variant.swing(named_case(), DURATION)
    rotation, reference = _reference()
    name = {"series": variant.series, "setting": variant.setting}
    errors = {
        "series": variant.series,
        "family": variant.family,
        "setting": variant.setting,
        "rank": rank,
        "step_s": variant.settings.get("step", math.nan),
        "status": motion.status,
        **motion_errors(motion, rotation, INSTANTS),
        **{f"reference_{row['quantity']}": row["uncertainty"] for row in reference},
        **counted(COUNTERS, motion.work),
        "message": motion.message,
    }
    times = {
        "solve_s": motion.solve_s,
        "real_time_factor": DURATION / motion.solve_s,
        "repeats": motion.repeats,
    }
    return {"errors": errors, "timings": name | times}


@cache
def _reference() -> tuple[Array, list[dict[str, Any]]]:
    """Return the rotation at the instants (T,) [rad] and how uncertain it and its frequency are."""
    rotations = []
    for n, step in REFERENCE.items():
        motion = answer_release(
            named_case(), SplineSettings(control_points=n), duration=DURATION, records=FINE_RECORDS,
            integrator="leapfrog", step=step,
        )  # fmt: skip
        rotations.append(at(motion, INSTANTS))
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


def _swing(tables: Tables) -> pd.DataFrame:
    """Return the spline's cheapest setting at the error that is compared."""
    rows = tables["digits_of_time"]
    return rows[(rows["series"] == SPLINE) & (rows["target"] == COMPARED)]


STUDY = Study(
    parts=(
        Part(ask=lambda: {"reference": _reference()[1]}, alone=True),
        Part(at=lambda: ranked([*own_swings(), *other_swings()]), ask=_solved, alone=True),
    ),
    made=digits(["error_rotation_rad"], "rank", TARGETS),
    claims=(finer("The reference is ten times finer than every error", "{quantity}"),),
    claims_of_time=(
        less_time(AT_EQUAL, (COMPARED,)),
        Claim(
            claim=f"The swing within {COMPARED:g} rad is followed five times as fast as it happens",
            formulation="{setting}",
            quantity="the duration of the motion over that of its computation",
            rows=_swing,
            value=lambda row: DURATION / row["solve_s"],
            holds=lambda row: DURATION / row["solve_s"] > 5.0,
            ratio=True,
        ),
    ),
    figures={},
    missing=missing,
)
