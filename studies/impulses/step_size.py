"""Error, drift, energy and time of the sequential impulses against the step, and where their limits lie."""

from studies.engine.findings import Claim
from studies.engine.study import Part, Study
from studies.impulses import figures, step_tables
from studies.impulses.designs import CASE
from studies.impulses.step_tables import PAPER_STEP

#: What "stable up to 2 / omega" is read as: the measured limit within this part of it.
NEAR = 0.01
#: Time of the four steps of a picture that an interactive scene can afford [ms].
AFFORDABLE = 1.0


STUDY = Study(
    cases=(CASE,),
    parts=(
        Part(at=step_tables.steps, ask=step_tables.released, alone=True),
        Part(at=step_tables.limits, ask=step_tables.limit),
        Part(at=step_tables.sweeps, ask=step_tables.swept),
        Part(at=step_tables.pictures, ask=step_tables.watched, alone=True),
    ),
    claims=(
        Claim(
            claim=f"The form as printed is stable up to 2/ω (within {100 * NEAR:g} %)",
            formulation="{design}, {group} modes",
            quantity="the measured limit over 2/ω",
            rows=lambda tables: tables["limits"].query("sweeps == 0"),
            value="ratio",
            holds=lambda row: abs(row["ratio"] - 1.0) <= NEAR,
        ),
        Claim(
            claim="Section 4.1: h = 1/100 s",
            formulation="{design}, {group} modes, as printed",
            quantity="h over the limit",
            rows=lambda tables: tables["limits"].query("sweeps == 0"),
            value=lambda row: PAPER_STEP / row["measured_s"],
            most=1.0,
        ),
        Claim(
            claim="The stable form gains no energy at any step up to 1/100 s",
            formulation="{design}",
            quantity="the largest gain",
            rows=lambda tables: (
                tables["steps"]
                .query("form == 'stable'")
                .groupby("design", as_index=False)
                .agg(gain=("energy_gain", "max"), whole=("status", lambda each: (each == "converged").all()))
            ),
            value="gain",
            holds=lambda row: row["whole"] and row["gain"] <= 1e-12,
        ),
    ),
    claims_of_time=(
        Claim(
            claim=f"Four steps take at most {AFFORDABLE:g} ms at the 95th percentile",
            formulation="{design}, n = {control_points}, h = {step_s:g} s",
            quantity="the 95th percentile of the processor's time over it",
            rows=lambda tables: tables["timings_of_pictures"],
            value=lambda row: row["cpu_95_ms"] / AFFORDABLE,
            most=1.0,
        ),
    ),
    figures={"impulse_step_size": figures.step_size, "impulse_limits": figures.limits_and_sweeps},
)
