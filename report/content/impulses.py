"""Sequential impulses, the solver of the paper's section 4.1."""

from report.facts import Fact, Holds, Rows, Table, fact
from report.forms import percent, power, seconds, significant, times
from report.results import Results, at, largest, where

IMPULSES = "impulses/step_size"
#: Groups of modes in the order of their frequencies.
GROUPS = ("axial", "bending", "swing")
PAPERS_STEP = "Section 4.1: h = 1/100 s"


def _limits(results: Results) -> Table:
    table = where(results.table(IMPULSES, "limits"), sweeps=0)
    over = where(results.table(IMPULSES, "findings"), claim=PAPERS_STEP).set_index("formulation")["value"]
    rows: Rows = []
    for design in dict.fromkeys(table["design"]):
        for group in GROUPS:
            row = where(table, design=design, group=group).iloc[0]
            ratio = float(over[f"{design}, {group} modes, as printed"])
            rows.append(
                [
                    f"{design}, {group} modes",
                    seconds(float(row["predicted_s"])),
                    seconds(float(row["measured_s"])),
                    times(ratio),
                ]
            )
    return ["fastest modes that are kept", "2/ω", "measured limit", "the paper's step over it"], rows


def _limit(group: str) -> Fact:
    return fact(IMPULSES, "limits", at("measured_s", design="Table 1", group=group, sweeps=0), seconds)


def _over(results: Results) -> float:
    return float(
        at("value", claim=PAPERS_STEP, formulation="Table 1, axial modes, as printed")(
            results.table(IMPULSES, "findings")
        )
    )


FACTS = {
    **{f"impulses.limit.{group}": _limit(group) for group in GROUPS},
    "impulses.over": Fact(made=_over, form=times),
    "impulses.one-sweep": fact(
        IMPULSES, "limits", at("ratio", design="Table 1", group="axial", sweeps=1), percent
    ),
    "impulses.agreement": fact(
        IMPULSES, "limits", lambda t: (where(t, sweeps=0)["ratio"] - 1.0).abs().max(), power
    ),
    "impulses.drift": fact(IMPULSES, "steps", largest("drift", form="printed", status="converged"), power),
    "impulses.drift.stable": fact(
        IMPULSES, "steps", largest("drift", form="stable", status="converged"), power
    ),
    "impulses.lost": fact(
        IMPULSES,
        "steps",
        at("energy_change", design="Table 1", form="stable", step_s=0.01),
        lambda v: percent(abs(v)),
    ),
    "impulses.picture": fact(
        IMPULSES, "timings_of_pictures", largest("cpu_95_ms"), lambda v: f"{significant(v)}\u00a0ms"
    ),
    "impulses.polymer.swing": fact(
        IMPULSES, "limits", at("measured_s", design="polymer", group="swing", sweeps=0), seconds
    ),
}
HOLDS = {
    "impulses.printed-fails": Holds(
        words="the paper's step is beyond every limit of Table 1 in the form as printed",
        test=lambda r: (
            r.table(IMPULSES, "findings")
            .query(
                "claim == @claim and formulation.str.startswith('Table 1')", local_dict={"claim": PAPERS_STEP}
            )["value"]
            .gt(1.0)
            .all()
        ),
    ),
    "impulses.no-gain": Holds(
        words="the stable form gains no energy at any step",
        test=lambda r: float(where(r.table(IMPULSES, "steps"), form="stable")["energy_gain"].max()) <= 0.0,
    ),
    "impulses.in-time": Holds(
        words="four steps of the stable form take at most 1 ms at the 95th percentile",
        test=lambda r: (r.table(IMPULSES, "findings_of_time")["holds"] == "yes").all(),
        timed=True,
    ),
}
LISTINGS = {"impulse-limits": _limits}
