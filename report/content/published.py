"""Published values of other designs, and pivots as solids."""

from typing import Any

from report.facts import Results, Stored, Table, listing
from report.forms import percent, signed_percent

VALUES = Stored("published/problems", "values")
DEVIATIONS = Stored("model_form/solid_pivot", "deviations")


@listing("published")
def _published(results: Results) -> Table:
    """Return of each problem and each kind of answer the value that is met worst, by the splines where they
    answer."""
    yield ["published problem", "quantity", "published", "ours", "difference", "limit"]
    for _, every in VALUES.rows(results).groupby(["problem", "answer"], sort=False):
        rows = every[every["model"] == "spline"] if (every["model"] == "spline").any() else every
        row = rows.iloc[int(rows["error"].abs().argmax())]
        name = row["problem"] if row["answer"] == "beam" else f"{row['problem']}, {row['answer']}"
        bound = "" if row["bound"] == "equal" else f"{row['bound']} "
        unit = "" if row["unit"] == "1" else f" {row['unit']}"
        printed = f"{bound}{row['published']:.6g} ± {row['uncertainty']:.1g}{unit}"
        said = row["quantity"].replace("_", " ")
        ours, apart = f"{row['found']:.6g}{unit}", signed_percent(row["error"])
        yield [name, said, printed, ours, apart, percent(row["limit"])]


@listing("solids")
def _solids(results: Results) -> Table:
    """Return the deviations of the torque of beam models from that of solids, at the first and the last
    compared rotation of each design."""
    rows: Any = DEVIATIONS.rows(results)
    designs = list(rows["design"].unique())
    ends = rows.groupby(["model", "design"], sort=False)["error_torque"].agg(
        lambda own: f"{signed_percent(own.iloc[0])} to {signed_percent(own.iloc[-1])}"
    )
    yield ["model, torque", *designs]
    for name in rows["model"].unique():
        yield [name, *ends[name].reindex(designs).fillna("–")]
    yield ["uncertainty of the solids", *rows.groupby("design")["uncertainty"].max()[designs].map(percent)]
