"""Times at equal error: the fastest of each group that reaches a level, over the fastest spline that does."""

from collections.abc import Iterable
from typing import Any

import numpy as np
import pandas as pd

from studies.baselines.comparison.variants import AS_DELIVERED, EXUDYN, OPENSEES, SPLINE

GROUPS = (EXUDYN, AS_DELIVERED, OPENSEES)

#: A limit must be this much more certain than the level that errors against it are compared at.
CERTAINTY = 2.0


def ratios(
    rows: pd.DataFrame,
    times: pd.DataFrame,
    error: str,
    levels: Iterable[float],
    unsure: str | None = None,
) -> pd.DataFrame:
    """Return a row a level and group: the fastest variants, their times [s] and the ratio.

    Where no variant of a group gets there, `tried_s` says how long the longest of them took.

    Args:
        rows: model, group, variant, status and the column `error`; times: model, variant, solve_s.
        error: column that must not be above the level.
        levels: errors asked for.
        unsure: column with the uncertainty of what errors are against; a level that is not `CERTAINTY` times
            as large leaves the row out.
    """
    joined = rows[rows["status"] == "converged"].merge(times, on=["model", "variant"])
    groups = [group for group in GROUPS if group in set(rows["group"])]
    found = []
    for level in levels:
        sure = joined if unsure is None else joined[CERTAINTY * joined[unsure] <= level]
        spline = fastest(sure, SPLINE, error, level)
        for group in groups:
            peer = fastest(sure, group, error, level)
            found.append(
                {
                    "level": level,
                    "group": group,
                    "peer": peer["name"],
                    "peer_s": peer["solve_s"],
                    "spline": spline["name"],
                    "spline_s": spline["solve_s"],
                    "ratio": peer["solve_s"] / spline["solve_s"],
                    "tried_s": sure.loc[sure["group"] == group, "solve_s"].max(),
                }
            )
    return pd.DataFrame(found)


def fastest(joined: pd.DataFrame, group: str, error: str, level: float) -> dict[str, Any]:
    """Return name and time of the fastest variant of a group within the level; NaN when none is."""
    within = joined[(joined["group"] == group) & (joined[error] <= level)]
    if within.empty:
        return {"name": "none", "solve_s": np.nan}
    best = within.sort_values("solve_s").iloc[0]
    return {"name": f"{best['model']}, {best['variant']}", "solve_s": float(best["solve_s"])}


def kept(rows: pd.DataFrame, error: str) -> pd.DataFrame:
    """Return the rows with their error replaced by the largest of their settings at this step and finer ones.

    An error that comes and goes as the step is refined is luck; this one only falls.
    """
    found = rows.copy()
    settings = rows["variant"].str.replace(r"step=\S+", "", regex=True)
    for _, same in rows.groupby([rows["model"], settings]):
        ordered = same.sort_values("step_s")
        found.loc[ordered.index, error] = np.maximum.accumulate(ordered[error].to_numpy(float))
    return found
