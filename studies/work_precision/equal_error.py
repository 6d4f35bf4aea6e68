"""What settings are compared at: errors that all finer ones keep."""

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
