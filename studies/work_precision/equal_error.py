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
    found = []
    for target in targets:
        within = coarsest(rows[rows[cost].notna()], columns, rank, target)
        here = {}
        for name in rows["series"].unique():
            mine = within[within["series"] == name]
            here[name] = mine.loc[mine[cost].idxmin()] if len(mine) else None
        least = here.get(baseline)
        for name, row in here.items():
            found.append(
                {
                    "target": target,
                    "series": name,
                    "setting": "" if row is None else row["setting"],
                    "error": math.nan if row is None else row["error"],
                    cost: math.nan if row is None else row[cost],
                    "ratio": math.nan if row is None or least is None else row[cost] / least[cost],
                }
            )
    return pd.DataFrame(found)
