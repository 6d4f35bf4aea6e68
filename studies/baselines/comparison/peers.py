"""Other codes beside the spline: errors and times of the static path and of the free swing, in one run.

Every error is against the limit of the code's own rod theory, with or without shear; how far the two are
apart, and how far the codes' finest answers are from the limits, stands in the tables `theories` and
`swing_theories`.
"""

import importlib.metadata
from collections.abc import Mapping
from typing import Any

import pandas as pd

from studies.baselines.comparison import peer_figures, peer_statics, peer_swings
from studies.baselines.comparison.ratios import kept, ratios
from studies.baselines.comparison.variants import EXUDYN
from studies.baselines.peers import exudyn_ancf, openseespy_frame
from studies.baselines.registry import HINT, missing
from studies.cases.problem import named_case
from studies.engine.findings import Claim, Tables, records
from studies.engine.study import Answer, Part, Study

CASE = "cross_axis_pivot"

#: Errors at which times are compared: of the path [1], and of the swing [rad].
LEVELS = (1e-2, 1e-3, 2e-4, 1e-5, 1e-6)
SWING_LEVELS = (2e-2, 1e-2, 5e-3, 2e-3)
#: Level -> ratio to the fastest Exudyn that the suite set out for.
AIMS = {2e-4: 50.0, 1e-6: 100.0}
SWING_AIMS = {5e-3: 20.0}


def paths() -> Answer:
    """Return theories, errors and times of the static path."""
    limits, theories = peer_statics.limits(named_case(CASE))
    rows, times = peer_statics.compared(named_case(CASE), limits)
    return {"theories": theories, "statics": rows, "statics_timings": times}


def motions() -> Answer:
    """Return theories, errors and times of the swing."""
    limits, theories = peer_swings.limits(named_case(CASE))
    uncertainty = {row["theory"]: row["rotation_rad"] for row in theories if row["theory"]}
    rows, times = peer_swings.compared(named_case(CASE), limits, uncertainty)
    return {"swing_theories": theories, "swings": rows, "swings_timings": times}


def _path_ratios(tables: Tables) -> pd.DataFrame:
    return ratios(tables["statics"], tables["statics_timings"], "worst", LEVELS)


def _swing_ratios(tables: Tables) -> pd.DataFrame:
    asked = {"reached": tables["swings"], "and kept at finer steps": kept(tables["swings"], "rotation_rad")}
    return pd.concat(
        ratios(rows, tables["swings_timings"], "rotation_rad", SWING_LEVELS, unsure="uncertainty_rad").assign(
            criterion=name
        )
        for name, rows in asked.items()
    )


def _codes() -> list[dict[str, str]]:
    """Return which of the other codes are there, and in which version."""
    rows = []
    for package, module in (("exudyn", exudyn_ancf), ("openseespy", openseespy_frame)):
        there = module.installed()
        rows.append(
            {
                "code": package,
                "status": "installed" if there else "not installed",
                "version": importlib.metadata.version(package) if there else "",
                "hint": "" if there else HINT,
            }
        )
    return rows


def _wanted(task: str, rows: pd.DataFrame, aims: Mapping[float, float]) -> list[dict[str, Any]]:
    """Return the ratios to Exudyn that were aimed at."""
    found = rows[(rows["group"] == EXUDYN) & rows["level"].isin(list(aims))]
    return [{**row, "task": task, "aim": aims[row["level"]]} for row in records(found)]


STUDY = Study(
    cases=(CASE,),
    parts=(
        Part(ask=lambda: {"codes": _codes()}),
        Part(ask=paths, alone=True),
        Part(ask=motions, alone=True),
    ),
    made={"statics_ratios": _path_ratios, "swings_ratios": _swing_ratios},
    claims_of_time=(
        Claim(
            claim="The spline is at least {aim:g} x faster than the fastest Exudyn at equal error",
            formulation="{task}, errors of {level:g}",
            quantity="the time of Exudyn over the spline's",
            rows=lambda tables: [
                *_wanted("static path", tables["statics_ratios"], AIMS),
                *_wanted(
                    "free swing of 0.05 s",
                    tables["swings_ratios"].query("criterion == 'reached'"),
                    SWING_AIMS,
                ),
            ],
            value="ratio",
            holds=lambda row: row["ratio"] >= row["aim"],
        ),
    ),
    varying=("statics_ratios", "swings_ratios"),
    figures={"peers": peer_figures.work_precision},
    missing=missing,
)
