"""Family by family, how many hard cases were tried, right, refused and wrong, for each model."""

import pandas as pd

from studies.record.store import Store
from studies.registry import STUDIES
from studies.stability.family import DEFAULT, OUTCOMES

GROUP = "stability/"


def summary(store: Store) -> pd.DataFrame:
    """Return the stored counts of all families that were run: a row a family and model."""
    tables = []
    for study in STUDIES:
        if study.startswith(GROUP):
            try:
                counts = store.load_tables(study)["counts"]
            except FileNotFoundError:
                continue
            tables.append(counts.assign(family=study.removeprefix(GROUP)))
    if not tables:
        return pd.DataFrame(columns=["family", "model", "tried", *OUTCOMES])
    return pd.concat(tables)[["family", "model", "tried", *OUTCOMES]]


def lines(store: Store) -> list[str]:
    """Return the summary as the lines of a Markdown table: "right / refused / wrong / bad input" a cell."""
    rows = summary(store)
    models = list(dict.fromkeys((DEFAULT, *rows["model"])))
    found = ["| family | " + " | ".join(models) + " |", "|---" * (len(models) + 1) + "|"]
    for family, some in rows.groupby("family", sort=False):
        cells = {
            row["model"]: " / ".join(str(row[name]) for name in OUTCOMES) for row in some.to_dict("records")
        }
        found.append(f"| {family} | " + " | ".join(cells.get(model, "") for model in models) + " |")
    return found
