"""The cheapest setting of every model at equal error, and what may be claimed of cost and of references."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from studies.engine import Claim, Tables, records
from studies.record.panels import Axis, Curves, Panel, sheet
from studies.record.style import Look
from studies.work_precision.series import SPLINE

#: Tables that follow from others.
Made = dict[str, Callable[[Tables], pd.DataFrame]]


#: An error is shown where it is this many times that of its reference.
MARGIN = 10.0


def worst(rows: pd.DataFrame, columns: Sequence[str]) -> pd.Series:
    """Return the largest of the error columns, row by row; infinite where one is missing."""
    return rows[list(columns)].max(axis=1, skipna=False).fillna(math.inf)


def kept(rows: pd.DataFrame, columns: Sequence[str], rank: str) -> pd.Series:
    """Return the largest worst error of each row and of all finer ones of its series and family.

    An error that a finer setting does not keep is luck: of a step and a mesh whose errors cancel, for one.

    Args:
        rows: with series, family, the errors and `rank`, which grows with fineness within a family.
    """
    finest_first = rows.assign(error=worst(rows, columns)).sort_values(rank, ascending=False)
    return finest_first.groupby(["series", "family"])["error"].cummax().reindex(rows.index)


def coarsest(rows: pd.DataFrame, columns: Sequence[str], rank: str, target: float) -> pd.DataFrame:
    """Return, of each series and family, the coarsest row whose errors are kept within the target.

    It is the cheapest one of its family but for the noise of timing. The column error is what is kept.
    """
    error = kept(rows, columns, rank)
    within = rows.assign(error=error)[error <= target].sort_values(rank)
    return within.groupby(["series", "family"], sort=False).head(1)


def cheapest(
    rows: pd.DataFrame,
    *,
    columns: Sequence[str],
    cost: str,
    rank: str,
    targets: Sequence[float],
    baseline: str = SPLINE,
) -> pd.DataFrame:
    """Return a row a target and series: its cheapest setting whose errors are all within the target.

    Columns: target, series, setting, error (the worst one that is kept), the cost, ratio (cost over that
    of the `baseline` series at the same target). Setting is empty and the rest NaN where no setting of a
    series reaches the target or its cost is not known.

    Args:
        rows: with series, setting, the error columns and the cost.
        columns: of the errors; cost: column of what is to be least; rank: see `kept`.
    """
    names, tables = rows["series"].unique(), []
    for target in targets:
        within = coarsest(rows[rows[cost].notna()], columns, rank, target)
        best = within.loc[within.groupby("series")[cost].idxmin()].set_index("series").reindex(names)
        found = best.assign(target=target, setting=best["setting"].fillna(""))
        found["ratio"] = found[cost] / found[cost].get(baseline, math.nan)
        tables.append(found.reset_index()[["target", "series", "setting", "error", cost, "ratio"]])
    return pd.concat(tables, ignore_index=True)


def joined(tables: Tables) -> pd.DataFrame:
    """Return errors, work and times of every setting in one table."""
    return tables["errors"].merge(tables["timings"], on=["series", "setting"])


def digits(columns: Sequence[str], rank: str, targets: Sequence[float]) -> Made:
    """Return what makes the tables of the cheapest settings at equal error: by counted work, and by time."""

    def by(cost: str) -> Callable[[Tables], pd.DataFrame]:
        return lambda tables: cheapest(joined(tables), columns=columns, cost=cost, rank=rank, targets=targets)

    return {"digits": by("flops"), "digits_of_time": by("solve_s")}


def less(cost: str, table: str, claim: str, targets: Sequence[float]) -> Claim:
    """Return the claim that the spline takes less of a cost than each other model at equal error.

    Args:
        cost: in words; table: of `cheapest`; claim: with its target in braces; targets: that are judged.
    """
    return Claim(
        claim=f"{claim} the spline takes less {cost}",
        formulation="{series}, {setting}",
        quantity=f"its {cost} over that of the spline",
        rows=lambda tables: tables[table][
            (tables[table]["series"] != SPLINE)
            & tables[table]["target"].isin(targets)
            & tables[table]["ratio"].notna()
        ],
        value="ratio",
        holds=lambda row: row["ratio"] > 1.0,
        ratio=True,
    )


def finer(claim: str, formulation: str, *, within: Sequence[str] = ()) -> Claim:
    """Return the claim that references are ten times finer than every error that is held against them.

    Args:
        claim, formulation: with columns of the table `reference` in braces; within: columns that errors
            share with their reference.
    """

    def rows(tables: Tables) -> list[dict[str, object]]:
        found = []
        for row in records(tables["reference"]):
            mine = tables["errors"]
            for name in within:
                mine = mine[mine[name] == row[name]]
            found.append(dict(row) | {"least": mine[f"error_{row['quantity']}"].min()})
        return found

    return Claim(
        claim=claim,
        formulation=formulation,
        quantity="the uncertainty of the reference over the smallest error",
        rows=rows,
        value=lambda row: row["uncertainty"] / row["least"],
        holds=lambda row: row["uncertainty"] <= 0.1 * row["least"],
    )


def diagram(
    tables: Tables,
    quantities: Mapping[str, str],
    *,
    rank: str,
    styles: Mapping[str, Look],
    part: str,
) -> Figure:
    """Draw the largest error over time (left) and work (right), one row a quantity.

    Args:
        tables: errors and timings; quantities: of the errors, with what they are called.
        rank: column by which the settings of a family are joined; styles: by series.
        part: what a path is made of: increments or steps.
    """
    rows = joined(tables)
    curves: dict[str, Any] = {"looks": styles, "by": "series", "family": "family", "along": rank}
    time = Axis("solve_s", f"time of the {part} [s]", log=True)
    work = Axis("flops", "counted operations [1]", log=True)
    lines = []
    for quantity, title in quantities.items():
        shown = rows[rows[f"error_{quantity}"] >= MARGIN * rows[f"reference_{quantity}"]]
        counted = shown[shown["flops"].notna()]
        y = Axis(f"error_{quantity}", title, log=True)
        timed = Panel(time, y, (Curves(shown[shown["solve_s"].notna()], **curves),))
        named = _Families(counted, rank, styles)
        lines.append((timed, Panel(work, y, (Curves(counted, **curves), named))))
    return sheet(9.5, 1.6 + 2.1 * len(quantities), lines, legend=3)


@dataclass(frozen=True)
class _Families:
    """The names of families at the coarsest setting of each, which stands first in the order of a column."""

    rows: pd.DataFrame
    rank: str
    styles: Mapping[str, Look]

    def draw(self, panel: Axes, x: Axis, y: Axis) -> None:
        """Write the names."""
        named = self.rows[self.rows["family"] != "all"].sort_values(self.rank)
        for (series, family), mine in named.groupby(["series", "family"], sort=False):
            panel.annotate(
                str(family).removeprefix("n = "), (mine[x.column].iloc[0], mine[y.column].iloc[0]), (6, 4),
                textcoords="offset points", ha="center", fontsize=7, color=self.styles[str(series)].colour,
            )  # fmt: skip
