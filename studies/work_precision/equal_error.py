"""The cheapest setting of every model at equal error: the only error at which cost may be compared."""

import math
from collections.abc import Sequence

import pandas as pd


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


def cheapest(
    rows: pd.DataFrame,
    *,
    columns: Sequence[str],
    cost: str,
    rank: str,
    targets: Sequence[float],
    baseline: str,
) -> pd.DataFrame:
    """Return a row a target and series: its cheapest setting whose errors are all within the target.

    Columns: target, series, setting, error (the worst one that is kept), the cost, ratio (cost over that
    of the `baseline` series at the same target). Setting is empty and the rest NaN where no setting of a
    series reaches the target or its cost is not known.

    Args:
        rows: with series, setting, the error columns and the cost.
        columns: of the errors; cost: column of what is to be least; rank: see `kept`.
    """
    error = kept(rows, columns, rank)
    found = []
    for target in targets:
        here = {}
        for name in rows["series"].unique():
            within = rows[(rows["series"] == name) & (error <= target) & rows[cost].notna()]
            here[name] = within.loc[within[cost].idxmin()] if len(within) else None
        least = here.get(baseline)
        for name, row in here.items():
            found.append(
                {
                    "target": target,
                    "series": name,
                    "setting": "" if row is None else row["setting"],
                    "error": math.nan if row is None else error[row.name],
                    cost: math.nan if row is None else row[cost],
                    "ratio": math.nan if row is None or least is None else row[cost] / least[cost],
                }
            )
    return pd.DataFrame(found)
