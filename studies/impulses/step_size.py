"""Error, drift, energy and time of the sequential impulses against the step, and where their limits lie."""

import itertools
from collections.abc import Callable, Mapping

import pandas as pd
from matplotlib.figure import Figure

from studies.impulses import designs, figures, step_tables
from studies.impulses.step_tables import PAPER_STEP
from studies.paper.findings import Finding, table

CASE = designs.CASE
CASES = (CASE,)

#: What "stable up to 2 / omega" is read as: the measured limit within this part of it.
NEAR = 0.01
#: Time of the four steps of a picture that an interactive scene can afford [ms].
AFFORDABLE = 1.0


def compute(progress: Callable[[int, int], None]) -> dict[str, pd.DataFrame]:
    """Return the motions against the step, the limits, the sweeps, the work of a picture, times and findings.

    Tables: steps, limits, sweeps, contraction, pictures; of time timings, timings_of_pictures and
    findings_of_time.
    """
    done = itertools.count(1)
    total = 2 * len(step_tables.FORMS) + 3 * len(designs.designs())

    def advance() -> None:
        progress(next(done), total)

    tables = {}
    tables["steps"], tables["timings"] = step_tables.steps(advance)
    tables["limits"] = step_tables.limits(advance)
    tables["sweeps"], tables["contraction"] = step_tables.sweeps(advance)
    tables["pictures"], tables["timings_of_pictures"] = step_tables.pictures(advance)
    tables["findings"] = table(_findings(tables))
    tables["findings_of_time"] = table(_findings_of_time(tables["timings_of_pictures"]))
    return tables


def draw(tables: Mapping[str, pd.DataFrame]) -> dict[str, Figure]:
    """Draw the motions against the step, and the limits with the sweeps."""
    return {
        "impulse_step_size": figures.step_size(tables),
        "impulse_limits": figures.limits_and_sweeps(tables),
    }


def _findings(tables: Mapping[str, pd.DataFrame]) -> list[Finding]:
    """Return whether the limits are those of the spectrum, and what runs at the paper's step."""
    found = []
    for row in tables["limits"].query("sweeps == 0").to_dict("records"):
        name = f"{row['design']}, {row['group']} modes"
        found += [
            Finding(
                claim=f"The form as printed is stable up to 2/ω (within {100 * NEAR:g} %)",
                formulation=name,
                quantity="the measured limit over 2/ω",
                value=row["ratio"],
                holds=abs(row["ratio"] - 1.0) <= NEAR,
            ),
            Finding(
                claim="Section 4.1: h = 1/100 s",
                formulation=f"{name}, as printed",
                quantity="h over the limit",
                value=PAPER_STEP / row["measured_s"],
                holds=row["measured_s"] >= PAPER_STEP,
            ),
        ]
    stable = tables["steps"].query("form == 'stable'")
    for design, rows in stable.groupby("design", sort=False):
        found.append(
            Finding(
                claim="The stable form gains no energy at any step up to 1/100 s",
                formulation=str(design),
                quantity="the largest gain",
                value=float(rows["energy_gain"].max()),
                holds=bool((rows["status"] == "converged").all() and rows["energy_gain"].max() <= 1e-12),
            )
        )
    return found


def _findings_of_time(rows: pd.DataFrame) -> list[Finding]:
    """Return whether the four steps of a picture take at most a millisecond: this differs run by run."""
    return [
        Finding(
            claim=f"Four steps take at most {AFFORDABLE:g} ms at the 95th percentile",
            formulation=f"{row['design']}, n = {row['control_points']}, h = {row['step_s']:g} s",
            quantity="the 95th percentile of the processor's time over it",
            value=row["cpu_95_ms"] / AFFORDABLE,
            holds=row["cpu_95_ms"] <= AFFORDABLE,
        )
        for row in rows.to_dict("records")
    ]
