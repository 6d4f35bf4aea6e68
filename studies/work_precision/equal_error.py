"""The cheapest setting of every model at equal error, and what may be claimed of cost and of references."""

import math
from collections.abc import Callable, Sequence

import pandas as pd

from studies.engine import Claim, Tables, records
from studies.work_precision.series import SPLINE


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
    rows: pd.DataFrame, *, columns: Sequence[str], rank: str, targets: Sequence[float]
) -> pd.DataFrame:
    """Return a row a target and series: its fastest setting whose errors are all within the target.

    Columns: target, series, setting, error (the worst one that is kept), solve_s, ratio (time over that of
    the spline at the same target). Setting is empty and the rest NaN where no setting of a series reaches the
    target or its time is not known.

    Args:
        rows: with series, setting, the error columns and solve_s.
        columns: of the errors; rank: see `kept`.
    """
    names, tables = rows["series"].unique(), []
    for target in targets:
        within = coarsest(rows[rows["solve_s"].notna()], columns, rank, target)
        best = within.loc[within.groupby("series")["solve_s"].idxmin()].set_index("series").reindex(names)
        found = best.assign(target=target, setting=best["setting"].fillna(""))
        found["ratio"] = found["solve_s"] / found["solve_s"].get(SPLINE, math.nan)
        tables.append(found.reset_index()[["target", "series", "setting", "error", "solve_s", "ratio"]])
    return pd.concat(tables, ignore_index=True)


def digits(
    columns: Sequence[str], rank: str, targets: Sequence[float]
) -> dict[str, Callable[[Tables], pd.DataFrame]]:
    """Return what makes the table of the cheapest settings at equal error from errors and timings."""

    def made(tables: Tables) -> pd.DataFrame:
        rows = tables["errors"].merge(tables["timings"], on=["series", "setting"])
        return cheapest(rows, columns=columns, rank=rank, targets=targets)

    return {"digits_of_time": made}


def less_time(claim: str, targets: Sequence[float]) -> Claim:
    """Return the claim that the spline takes less time than each other model at equal error.

    Args:
        claim: with its target in braces; targets: that are judged.
    """

    def rows(tables: Tables) -> pd.DataFrame:
        found = tables["digits_of_time"]
        judged = (found["series"] != SPLINE) & found["target"].isin(targets) & found["ratio"].notna()
        return found[judged]

    return Claim(
        claim=f"{claim} the spline takes less time",
        formulation="{series}, {setting}",
        quantity="its time over that of the spline",
        rows=rows,
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
