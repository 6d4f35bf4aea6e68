"""What accuracy costs: the tables of docs/findings.md."""

import math
from types import SimpleNamespace
from typing import Any

import pandas as pd
import pytest

from studies.commands import readme
from studies.commands.readme import DYNAMICS, STATICS, digits
from studies.errors import BadInput
from studies.work_precision import series


def found(rows):
    """A table of cheapest settings; rows of target, series, setting, seconds and ratio."""
    return pd.DataFrame(rows, columns=["target", "series", "setting", "solve_s", "ratio"])


def test_tables_of_digits():
    """A row an error, a column a model that was solved, each with its setting, its time and the ratio."""
    statics = found(
        [
            (1e-4, "spline", "n = 6", 2e-4, 1.0),
            (1e-4, "finite elements", "80 elements", 0.2, 1000.0),
            (1e-2, "spline", "n = 5", 1e-4, 1.0),
            (1e-2, "finite elements", "10 elements", 0.05, 500.0),
        ]
    )
    dynamics = found([(0.1, "exudyn ancf", "4 elements", math.nan, math.nan)])
    tables = {"work_precision/statics": statics, "work_precision/dynamics": dynamics}
    store: Any = SimpleNamespace(load_tables=lambda study: {"digits_of_time": tables[study]})
    lines = "\n".join(digits(store)).splitlines()
    assert lines == [
        "| error of path and torque, 0 to 90° | spline | finite elements |",
        "|---|---|---|",
        "| 1e-02 | n = 5: 0.1 ms | 10 elements: 50 ms (× 500) |",
        "| 1e-04 | n = 6: 0.2 ms | 80 elements: 0.2 s (× 1000) |",
        "",
        "| error of the rotation, 0.05 s of swing | Exudyn, ANCF cable |",
        "|---|---|",
        "| 0.1 rad | – |",
    ]


def test_blocks_are_put_between_their_marks():
    """Only what stands between the marks of a block is replaced; a page without them is refused."""
    first, second = readme.marks("digits"), readme.marks("hard cases")
    text = f"head\n{first[0]}\nold\n{first[1]}\nbody\n{second[0]}\nold\n{second[1]}\ntail"
    for name, made in (("digits", ["new"]), ("hard cases", iter(["newer", "newest"]))):
        text = readme.between(text, name, made, "PAGE.md")
    assert text == (
        f"head\n{first[0]}\n\nnew\n\n{first[1]}\nbody\n{second[0]}\n\nnewer\nnewest\n\n{second[1]}\ntail"
    )
    with pytest.raises(BadInput, match=r"PAGE\.md: got no marks, expected <!-- other: written by"):
        readme.between(text, "other", [], "PAGE.md")


def test_columns_are_series_of_the_studies():
    """Every column is a series that the studies know by that name."""
    assert set(STATICS) <= set(series.looks(series.own_series()))
    assert set(DYNAMICS) <= set(series.looks(series.moving_series()))
