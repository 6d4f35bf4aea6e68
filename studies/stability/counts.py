"""How many cases of a family were tried, and how they ended, for each model."""

import pandas as pd

from studies.stability.columns import ORDER
from studies.stability.outcome import OUTCOMES


def counted(outcomes: pd.DataFrame) -> pd.DataFrame:
    """Return a row a model of `outcomes`: cases tried, one column an outcome, largest right error."""
    rows = []
    for model in ORDER:
        mine = outcomes[outcomes["model"] == model]
        if mine.empty:
            continue
        found = {outcome: int((mine["outcome"] == outcome).sum()) for outcome in OUTCOMES}
        largest = mine.loc[mine["outcome"] == "right", "error"].max()
        rows.append({"model": model, "tried": len(mine), **found, "largest_right_error": largest})
    return pd.DataFrame(rows)
