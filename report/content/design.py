"""What accuracy costs, charts and where beam theory ends, effects, pivots sized by gradients."""

from collections.abc import Callable
from typing import Any

import pandas as pd

from report import forms
from report.facts import FACTS, HOLDS, LISTINGS, Fact, Results, Stored, Table, listing
from report.forms import angle, dash, degrees, digits, percent, seconds, significant, times, unit

CODES = "cost/codes"
#: Groups of the comparison in addition to the spline, in the order of the table.
GROUPS = ("spline, by itself", "finite elements", "Exudyn", "OpenSees", "surrogates")

#: Task -> its stored table, and how an error is written.
TASKS = {
    "path": (Stored(CODES, "path_ratios"), forms.decade),
    "swing": (Stored(CODES, "swing_ratios"), unit("rad", 1)),
}
#: Task -> its name in the table.
NAMES = {"path": "path", "swing": "vibration"}
SIMPLE = ("linear pivot", "pin joint", "four-bar", "beam constraint model")
SPLINES = ("n = 4, as the paper", "n = 4, locking-free", "n = 6")
QUANTITIES = ("trajectory", "torque", "stiffness")
SURROGATES = Stored("cost/surrogates", "findings")
#: Error that models are to keep [1].
KEPT = 0.01


@listing("cost")
def _cost(results: Results) -> Table:
    """Return all models at equal error: median of whole calls, and ratio to the spline."""
    yield ["task, error", "spline (increments alone)", *GROUPS]
    for task, (stored, form) in TASKS.items():
        for level, rows in sorted(stored.rows(results).groupby("level"), reverse=True):
            groups: Any = rows.set_index("group")
            spline = rows.iloc[0]
            own = f"{seconds(spline['spline_s'])} ({seconds(spline['spline_solve_s'])})"
            yield [f"{NAMES[task]}, {form(level)}", own, *(_peer(groups, group) for group in GROUPS)]


def _peer(groups: Any, group: str) -> str:
    """Return time and ratio of a group; a dash where none of its settings keeps the error."""
    if group not in groups.index or pd.isna(groups.loc[group, "ratio"]):
        return "–"
    return f"{seconds(groups.loc[group, 'whole_s'])}, {times(groups.loc[group, 'ratio'])}"


@listing("surrogates")
def _surrogates(results: Results) -> Table:
    """Return the last whole degree up to which each simple model, and each spline beside them, keeps one
    percent."""
    rows = Stored("cost/surrogates", "errors").rows(results).sort_values("rotation_rad")
    kept = rows[list(QUANTITIES)].abs().groupby(rows["model"]).cummax() <= KEPT
    ends: Any = kept.mul(rows["rotation_rad"], axis=0).groupby(rows["model"]).max()
    yield ["error below 1 % up to", *QUANTITIES]
    for model in (*SIMPLE, *SPLINES):
        yield [model, *(degrees(end) for end in ends.loc[model])]


def _extreme(task: str, group: str, pick: Callable[[Any], Any]) -> Fact:
    """Return the least or largest ratio of a group over all errors."""
    return Fact(made=lambda r: pick(TASKS[task][0].rows(r, group=group)["ratio"].dropna()), form=times)


WAITS = Stored(CODES, "waits_of_time")
FACTS |= {
    f"cost.{task}.{short}.{name}": _extreme(task, group, pick)
    for task in TASKS
    for short, group in (("exudyn", "Exudyn"), ("fe", "finite elements"))
    for name, pick in (("least", min), ("most", max))
}
FACTS |= {
    "cost.surrogates": _extreme("path", "surrogates", min),
    "cost.path.spline": TASKS["path"][0].at("spline_solve_s", seconds, group="Exudyn", level=2e-4),
    "cost.path.whole": TASKS["path"][0].at("spline_s", seconds, group="Exudyn", level=2e-4),
    "cost.command.spline": WAITS.at("whole_s", seconds, model="spline, n = 6"),
    "cost.command.fe": WAITS.at("whole_s", seconds, model="80 elements"),
    "surrogates.torque": SURROGATES.at(
        "value",
        times,
        quantity="the largest error of the torque over the best such model's",
        formulation=SPLINES[0],
    ),
}
HOLDS |= {"surrogates.free": SURROGATES.found("Dynamic splines are more accurate", *SPLINES[1:])}


CHARTS = Stored("charts/pivot", "findings")
VALIDITY = Stored("charts/pivot", "validity")
WORTH = Stored("effects/worth", "worth", status="converged")


@listing("effects")
def _effects(results: Results) -> Table:
    """Return the largest change by leaving out each effect and the ratio of the times, a column a design."""
    times_of = Stored("effects/worth", "timings").rows(results)[["design", "scene", "time_ratio"]]
    rows = WORTH.rows(results).merge(times_of, on=["design", "scene"])
    designs = list(rows["design"].unique())
    yield ["neglected effect", *designs]
    for scene, own in rows.set_index("design").groupby("scene"):
        pairs: Any = own.reindex(designs)[["largest", "time_ratio"]].to_numpy()
        yield [str(scene), *(f"{dash(percent)(change)}, {dash(times)(ratio)}" for change, ratio in pairs)]


LISTINGS["validity"] = VALIDITY.table(
    {
        "pivot": ("pivot", lambda name: name.replace("cross_axis", "benchmark").replace("_", " ")),
        "rotation": ("rotation_deg", angle),
        "t/L": ("thickness_ratio", significant),
        "b/L": ("width_ratio", significant),
        "clamping, from": ("clamped_least", percent),
        "to": ("clamped_most", percent),
        "anticlastic": ("flattened", percent),
        "supports": ("roots", percent),
        "shear": ("shear", percent),
    },
    by="thickness_ratio",
)


DESIGNS = Stored("design/sizing", "designs")
BEAMS, EFFECTS, AGAIN, TOLERANCES = "as beams", "with effects", "sized again", "at tolerances"


def _aim(question: str) -> str:
    return "centre_shift_m" if "shift" in question else "variation"


@listing("sizing")
def _sizing(results: Results) -> Table:
    """Return both pivots and the optimum of every question, with plate effects and supports."""
    rows = DESIGNS.rows(results)
    begun = rows[(rows["basis"] == EFFECTS) & (rows["design"] == rows["baseline"])].set_index(
        "design", drop=False
    )
    again = rows[rows["basis"] == AGAIN]
    yield ["design", "L, t, b [mm]", "inclination", "crossing", "shift", "variation", "improvement"]
    for row in [*begun.to_dict("records"), *again.to_dict("records")]:
        aim = _aim(row["design"])
        better = begun.loc[row["baseline"], aim] / row[aim]
        yield [
            row["design"],
            ", ".join(digits(3)(1e3 * row[f"{name}_m"]) for name in ("length", "thickness", "width")),
            degrees(row["inclination_rad"]),
            digits(3)(row["crossing_ratio"]),
            unit("mm", 2, 1e3)(row["centre_shift_m"]),
            percent(row["variation"]),
            times(better) if row["basis"] == AGAIN else "–",
        ]


def _promised(results: Results) -> pd.DataFrame:
    """Return the aim of every question over that as beams, by what is taken into account."""
    rows = DESIGNS.rows(results)
    own: Any = [row[_aim(row["design"])] for row in rows.to_dict("records")]
    aims = rows.assign(aim=own).pivot(index="design", columns="basis", values="aim")
    return aims.loc[aims[AGAIN].notna()].pipe(lambda each: each.div(each[BEAMS], axis=0))


FACTS |= {
    "charts.shift": CHARTS.at("value", percent, formulation="shift"),
    "sizing.effects": Fact(made=lambda r: float(_promised(r)[EFFECTS].max()), form=times),
    "sizing.tolerances": Fact(made=lambda r: float(_promised(r)[TOLERANCES].max()), form=times),
    "sizing.elements": DESIGNS.largest("error", percent),
    "sizing.steel.begins": DESIGNS.at(
        "largest_stress_Pa", unit("MPa", 3, 1e-6), design="spring steel", basis=BEAMS
    ),
    "sizing.steel.stress": DESIGNS.largest(
        "largest_stress_Pa", unit("MPa", 3, 1e-6), baseline="spring steel", basis=AGAIN
    ),
}
HOLDS |= {
    "charts.collapse": CHARTS.found("From a slenderness", "stiffness", "stress", "variation"),
}
