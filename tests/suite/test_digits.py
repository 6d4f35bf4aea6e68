"""What a digit costs: the tables of README.md."""

import math

import pandas as pd
import pytest

from studies.commands import readme
from studies.commands.digits import DYNAMICS, STATICS, digits
from studies.errors import BadInput
from studies.record.store import Store
from studies.work_precision import moving_series, series


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
    lines = "\n".join(digits(statics, dynamics)).splitlines()
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


def test_every_block_is_asked_for(monkeypatch):
    """A README without the marks of a block is refused with what is expected."""
    monkeypatch.setattr(readme, "_block", lambda store: ["agreement"])
    monkeypatch.setattr(readme, "_table", lambda store, study, name: found([]))
    first = f"head\n{readme.BEGIN}\nold\n{readme.END}\n"
    with pytest.raises(BadInput, match="digits: written by"):
        readme.rewritten(first, Store())
    monkeypatch.setattr(readme, "digits", lambda statics, dynamics: ["digits"])
    monkeypatch.setattr(readme, "lines", lambda store: ["hard"])
    second = f"{readme.BEGIN_DIGITS}\nold\n{readme.END_DIGITS}\n"
    with pytest.raises(BadInput, match="hard cases: written by"):
        readme.rewritten(first + second, Store())
    third = f"{readme.BEGIN_HARD}\nold\n{readme.END_HARD}\ntail"
    text = readme.rewritten(first + second + third, Store())
    assert "old" not in text
    assert text.startswith("head\n") and text.endswith("tail")
    places = [text.index(part) for part in ("agreement", readme.END, "\ndigits\n", "\nhard\n")]
    assert places == sorted(places)


def test_columns_are_series_of_the_studies():
    """Every column is a series that the studies know by that name."""
    assert set(STATICS) <= set(series.looks())
    assert set(DYNAMICS) <= set(moving_series.looks())
