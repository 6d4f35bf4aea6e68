"""Other codes beside the spline: errors and times of the static path and of the free swing, in one run.

Every error is against the limit of the code's own rod theory, with or without shear; how far the two are
apart, and how far the codes' finest answers are from the limits, stands in the tables `theories` and
`swing_theories`.
"""

import importlib.metadata
from collections.abc import Callable, Mapping
from typing import Any

import pandas as pd
from matplotlib.figure import Figure

from studies.baselines.comparison import peer_figures, peer_statics, peer_swings
from studies.baselines.comparison.ratios import kept, ratios
from studies.baselines.comparison.variants import EXUDYN, PASSES, release_variants, static_variants
from studies.baselines.peers import exudyn_ancf, openseespy_frame
from studies.baselines.registry import HINT, missing
from studies.cases.problem import named_case
from studies.paper.findings import Finding, table

__all__ = ["CASES", "compute", "draw", "missing"]

CASE = "cross_axis_pivot"
CASES = (CASE,)

#: Errors at which times are compared: of the path [1], and of the swing [rad].
LEVELS = (1e-2, 1e-3, 2e-4, 1e-5, 1e-6)
SWING_LEVELS = (2e-2, 1e-2, 5e-3, 2e-3)
#: Level -> ratio to the fastest Exudyn that the suite set out for.
AIMS = {2e-4: 50.0, 1e-6: 100.0}
SWING_AIMS = {5e-3: 20.0}


def compute(progress: Callable[[int, int], None]) -> dict[str, pd.DataFrame]:
    """Return codes, theories, errors, times, ratios and findings, each for the path and for the swing.

    What differs run by run stands in the tables of times: timings, ratios, findings_of_time.
    """
    problem = named_case(CASE)
    first, second = PASSES * len(static_variants()), PASSES * len(release_variants())
    total = first + second + 1
    limits, theories = peer_statics.limits(problem)
    paths, times = _tables(peer_statics.compared(problem, limits, lambda done: progress(done, total)))
    motion_limits, swing_theories = peer_swings.limits(problem)
    uncertainty = {row["theory"]: row["rotation_rad"] for row in swing_theories if row["theory"]}
    motions, swing_times = _tables(
        peer_swings.compared(problem, motion_limits, uncertainty, lambda done: progress(first + done, total))
    )
    progress(total, total)
    static = ratios(paths, times, "worst", LEVELS)
    swing = ratios(motions, swing_times, "rotation_rad", SWING_LEVELS, unsure="uncertainty_rad")
    steady = ratios(
        kept(motions, "rotation_rad"), swing_times, "rotation_rad", SWING_LEVELS, unsure="uncertainty_rad"
    )
    return {
        "codes": pd.DataFrame(_codes()),
        "theories": pd.DataFrame(theories),
        "statics": paths,
        "statics_timings": times,
        "statics_ratios": static,
        "swing_theories": pd.DataFrame(swing_theories),
        "swings": motions,
        "swings_timings": swing_times,
        "swings_ratios": pd.concat(
            [swing.assign(criterion="reached"), steady.assign(criterion="and kept at finer steps")]
        ),
        "findings_of_time": table(
            [*_findings(static, AIMS, "static path"), *_findings(swing, SWING_AIMS, "free swing of 0.05 s")]
        ),
    }


def draw(tables: Mapping[str, pd.DataFrame]) -> dict[str, Figure]:
    """Draw error against time, of the path and of the swing."""
    return {"peers": peer_figures.work_precision(tables)}


def _tables(
    found: tuple[list[dict[str, Any]], list[dict[str, Any]]],
) -> tuple[pd.DataFrame, pd.DataFrame]:
    rows, times = found
    return pd.DataFrame(rows), pd.DataFrame(times, columns=["model", "variant", "solve_s"])


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


def _findings(table_of_ratios: pd.DataFrame, aims: Mapping[float, float], task: str) -> list[Finding]:
    """Return whether the spline is as much faster than Exudyn as it was to be."""
    found = []
    for row in table_of_ratios[table_of_ratios["group"] == EXUDYN].to_dict("records"):
        aim = aims.get(float(row["level"]))
        if aim is not None:
            found.append(
                Finding(
                    claim=f"The spline is at least {aim:g} x faster than the fastest Exudyn at equal error",
                    formulation=f"{task}, errors of {row['level']:g}",
                    quantity="the time of Exudyn over the spline's",
                    value=float(row["ratio"]),
                    holds=bool(row["ratio"] >= aim),
                )
            )
    return found
