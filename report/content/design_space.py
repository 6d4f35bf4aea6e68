"""The pivot's design space, and how many designs a second are solved."""

from typing import Any

import pandas as pd

from report.facts import Cell, Derived, Fact, Holds, Listing, fact
from report.forms import count, percent, seconds, significant, times, unit
from report.pick import at, largest, least
from report.results import Results

SPACE, THROUGHPUT = "sweep/design_space", "sweep/throughput"
GAIN = "Two workers solve at least"


def _checked(results: Results) -> float:
    """Return the largest relative difference of splines and elements over all chosen designs."""
    return float(results.table(SPACE, "comparison")["error"].abs().max())


def _chosen(results: Results) -> tuple[list[str], list[list[Cell]]]:
    rows: list[list[Cell]] = []
    for row in results.table(SPACE, "checks").to_dict("records"):
        rows.append(
            [
                str(row["design"]),
                significant(row["crossing_ratio"], 3),
                f"{significant(row['inclination_deg'], 2)}°",
                significant(row["slenderness"], 3),
                unit("N m/rad", 3)(row["stiffness_rest_Nm_per_rad"]),
                percent(row["stiffness_variation"]),
                unit("mm", 2, 1e3)(row["centre_shift_max_m"]),
                unit("GPa", 2, 1e-9)(row["stress_max_Pa"]),
            ]
        )
    head = ["design", "crossing", "inclination", "slenderness", "stiffness", "variation", "shift", "stress"]
    return head, rows


def _unmet(results: Results) -> tuple[list[str], list[list[Cell]]]:
    rows: list[list[Cell]] = []
    for study, name in ((SPACE, "findings"), (THROUGHPUT, "findings_of_time")):
        for row in results.table(study, name).query("holds == 'no'").to_dict("records"):
            rows.append([str(row["claim"]), str(row["formulation"]), significant(float(str(row["value"])))])
    return ["claim that does not hold", "for", "measured"], rows or [["none", "–", "–"]]


def _gains(results: Results) -> "pd.Series[Any]":
    table = results.table(THROUGHPUT, "findings_of_time")
    found: pd.Series[Any] = table.loc[table["claim"].str.startswith(GAIN), "value"]
    return found


def _front(table: pd.DataFrame) -> int:
    return int((table["front"] == "yes").sum())


def _best(column: str) -> Any:
    """Return a pick of the least of `column` among the designs that no other betters."""
    return least(column, front="yes")


FACTS: dict[str, Fact | Derived] = {
    "space.designs": fact(SPACE, "designs", len, count),
    "space.front": fact(SPACE, "designs", _front, count),
    "space.shift": fact(SPACE, "designs", _best("centre_shift_max_m"), unit("mm", 2, 1e3)),
    "space.shift.table-1": fact(
        SPACE, "checks", at("centre_shift_max_m", design="Table 1"), unit("mm", 2, 1e3)
    ),
    "space.variation": fact(SPACE, "designs", _best("stiffness_variation"), percent),
    "space.variation.table-1": fact(SPACE, "checks", at("stiffness_variation", design="Table 1"), percent),
    "space.checked": Derived(made=_checked, form=percent),
    "throughput.designs": fact(THROUGHPUT, "timings", largest("designs"), count),
    "throughput.time": fact(
        THROUGHPUT, "timings", lambda t: t.loc[t["designs"] == t["designs"].max(), "wall_s"].min(), seconds
    ),
    "throughput.rate": fact(THROUGHPUT, "timings", lambda t: (t["designs"] / t["wall_s"]).max(), significant),
    "throughput.gain.least": Derived(made=lambda r: float(_gains(r).min()), form=times),
    "throughput.gain.most": Derived(made=lambda r: float(_gains(r).max()), form=times),
    "throughput.chunk": fact(
        THROUGHPUT,
        "findings_of_time",
        lambda t: 0.01 * t.loc[t["claim"].str.startswith("A chunk costs"), "value"].max(),
        seconds,
    ),
}

HOLDS = {
    "space.front-ends": Holds(
        words="the least centre shift and the least variation of the front are a tenth of Table 1's at most",
        test=lambda r: (
            _best("centre_shift_max_m")(r.table(SPACE, "designs"))
            < 0.1 * at("centre_shift_max_m", design="Table 1")(r.table(SPACE, "checks"))
            and _best("stiffness_variation")(r.table(SPACE, "designs"))
            < 0.1 * at("stiffness_variation", design="Table 1")(r.table(SPACE, "checks"))
        ),
    ),
    "space.table-1-not-bettered": Holds(
        words="no design betters Table 1 in stiffness, variation, shift and stress at once",
        test=lambda r: bool(
            (
                r.table(SPACE, "findings").query("claim.str.startswith('Table 1 is not bettered')")["holds"]
                == "yes"
            ).all()
        ),
    ),
    "space.checked": Holds(
        words="finite elements agree with every chosen design within 1 %",
        test=lambda r: _checked(r) < 0.01,
    ),
    "throughput.cores": Holds(
        words="two workers gain as much as was wanted, by every way of working",
        test=lambda r: bool(
            (
                r.table(THROUGHPUT, "findings_of_time").query(
                    "claim.str.startswith(@GAIN)", local_dict={"GAIN": GAIN}
                )["holds"]
                == "yes"
            ).all()
        ),
        timed=True,
    ),
}
LISTINGS = {"chosen": Listing(made=_chosen), "space-unmet": Listing(made=_unmet)}
