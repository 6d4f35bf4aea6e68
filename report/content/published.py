"""Published values of other designs, and solids of the benchmark pivot and of other pivots."""

from typing import Any

import numpy as np

from report.facts import Results, Stored, Table, listing
from report.forms import percent, signed_percent

VALUES = Stored("published/problems", "values")
PIVOT = Stored("model_form/solid_pivot", "deviations")
DESIGNS = Stored("model_form/solid_designs", "states")
#: Rotations of the table of solids [deg], and a row below the models of both tables.
ROTATIONS, UNSURE = (9.0, 45.0, 90.0), "uncertainty of the solids"


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
    """Return the deviations of beam models from solids of the benchmark pivot."""
    rows: Any = PIVOT.rows(results)
    rows = rows.assign(degrees=np.degrees(rows["rotation_rad"]).round(3)).set_index(["model", "degrees"])
    yield ["model", *(f"torque at {angle:g}°" for angle in ROTATIONS), "trajectory at 90°"]
    for name in rows.index.unique("model"):
        own = rows.loc[name]
        torques = (signed_percent(own["error_torque"][angle]) for angle in ROTATIONS)
        yield [name, *torques, percent(own["error_trajectory"][ROTATIONS[-1]])]
    yield [UNSURE, *(percent(own["uncertainty"][angle]) for angle in ROTATIONS), ""]


@listing("solid designs")
def _solid_designs(results: Results) -> Table:
    """Return the deviations of beam models from solids of other designs at the first and last rotation."""
    rows: Any = DESIGNS.rows(results)
    errors = rows[rows["model"] != "solid"].groupby(["model", "design"])["error_torque"]
    ends = errors.agg(lambda own: f"{signed_percent(own.iloc[0])} to {signed_percent(own.iloc[-1])}")
    designs = list(rows["design"].unique())
    yield ["model, torque", *designs]
    for name, own in ends.unstack().fillna("–")[designs].iterrows():
        yield [str(name), *own]
    yield [UNSURE, *rows.groupby("design")["uncertainty"].max()[designs].map(percent)]
