"""Which effects matter where, what the paper leaves open, and its solver: sequential impulses."""

import pandas as pd

from report.facts import Fact, Holds, Rows, Table, fact
from report.forms import count, percent, power, seconds, signed_percent, significant, times, unit
from report.results import Results, at, distinct, largest, where

WORTH = "effects/worth"
QUANTITIES = ("trajectory", "torque", "swing_frequency", "first_mode")


def _worth(results: Results) -> Table:
    table = results.table(WORTH, "worth").query("status != 'refused'")
    designs = list(dict.fromkeys(table["design"]))
    rows: Rows = []
    order = table.groupby("scene")["largest"].max().sort_values(ascending=False).index
    for scene in order:
        found = where(table, scene=scene).set_index("design")["largest"]
        rows.append([scene, *("–" if pd.isna(found[design]) else power(found[design]) for design in designs)])
    return ["left out", *designs], rows


def _cheapest(results: Results) -> Table:
    rows: Rows = [
        [str(row["design"]), str(row["scene"]), power(float(row["largest"]))]
        for row in results.table(WORTH, "cheapest").to_dict("records")
    ]
    return ["design", "cheapest scene that suffices", "its largest change"], rows


def _change(design: str, scene: str) -> Fact:
    return fact(WORTH, "worth", at("largest", design=design, scene=scene), percent)


def _scene_is(results: Results, scene: str, *, within: bool) -> bool:
    """Whether leaving out `scene` keeps every design within the tolerance, or none."""
    tolerance = float(results.table(WORTH, "cheapest")["tolerance"].iloc[0])
    found = where(results.table(WORTH, "worth"), scene=scene)["largest"]
    return bool((found <= tolerance).all() if within else (found > tolerance).all())


def _exponent_miss(results: Results) -> float:
    table: pd.DataFrame = results.table(WORTH, "findings")
    return float(table[table["claim"].str.startswith("The frequency shift by massless")]["value"].iloc[0])


FACTS = {
    "effects.designs": fact(WORTH, "worth", distinct("design"), count),
    "effects.tolerance": fact(WORTH, "cheapest", largest("tolerance"), percent),
    "effects.inextensible": _change("Table 1", "inextensible strips"),
    "effects.massless": _change("Table 1", "massless strips"),
    "effects.massless.light": _change("body ten times lighter", "massless strips"),
    "effects.gravity.slender": _change("ten times more slender", "no gravity"),
    "effects.gravity": _change("Table 1", "no gravity"),
}
HOLDS = {
    "effects.stretching-small": Holds(
        words="inextensible strips keep every design within the tolerance",
        test=lambda r: _scene_is(r, "inextensible strips", within=True),
    ),
}
LISTINGS = {"effects": _worth, "cheapest": _cheapest}


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


FACTS |= {
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
    "impulses.lost.polymer": fact(
        IMPULSES,
        "steps",
        at("energy_change", design="polymer", form="stable", step_s=0.01),
        lambda v: percent(abs(v)),
    ),
    "impulses.polymer.time": fact(
        IMPULSES,
        "steps",
        lambda t: at("steps", design="polymer", form="stable", step_s=0.01)(t) * 0.01,
        seconds,
    ),
    "impulses.picture": fact(
        IMPULSES, "timings_of_pictures", largest("cpu_95_ms"), lambda v: f"{significant(v)}\u00a0ms"
    ),
}
HOLDS |= {
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
LISTINGS |= {"impulse-limits": _limits}


READINGS = "paper/readings"


def _assumptions(results: Results) -> Table:
    table = results.table(READINGS, "readings")
    chosen = table.sort_values("rotation_rad").iloc[0]
    rows: Rows = []
    for row in table[table["reading"] != chosen["reading"]].to_dict("records"):
        rows.append(
            [
                str(row["reading"]),
                f"{unit('mm', 3, 1e3)(row['travel_m'])} ({unit('mm', 3, 1e3)(chosen['travel_m'])})",
                f"{unit('Hz', 4)(row['frequency_Hz'])} ({unit('Hz', 4)(chosen['frequency_Hz'])})",
                unit("rad")(row["rotation_rad"]),
            ]
        )
    return ["reading", "travel of the centre (Fig 4)", "frequency (Fig 6)", "rotation changes by"], rows


HOLDS["effects.shear-more"] = Holds(
    words="shear changes the torque by more than stretching does",
    test=lambda r: (
        at("torque", what="difference of the theories")(r.table("baselines/peers", "theories"))
        > at("largest", design="Table 1", scene="inextensible strips")(r.table(WORTH, "worth"))
    ),
)
LISTINGS["assumptions"] = _assumptions


def _quadrature(results: Results) -> Table:
    table = results.table(READINGS, "quadrature").sort_values("gauss_points")
    rows: Rows = [
        [
            count(row["gauss_points"]),
            percent(row["error_torque"]),
            percent(row["error_stiffness"]),
            signed_percent(row["error_stiffness_end"]),
        ]
        for row in table.to_dict("records")
    ]
    return ["Gauss points a strip", "torque", "stiffness", "stiffness at the end"], rows


HOLDS["quadrature.none"] = Holds(
    words="no quadrature gives a torque within three percent and a stiffness that is too high",
    test=lambda r: (
        not (
            (r.table(READINGS, "quadrature")["error_torque"] < 0.03)
            & (r.table(READINGS, "quadrature")["error_stiffness_end"] > 0.0)
        ).any()
    ),
)
LISTINGS["quadrature"] = _quadrature
