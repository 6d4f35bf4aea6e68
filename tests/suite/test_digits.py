"""What accuracy costs: the tables of docs/findings.md."""

import math
from types import SimpleNamespace
from typing import Any

import pandas as pd
import pytest

from studies.baselines import peers
from studies.commands import readme
from studies.errors import BadInput


def test_tables_of_costs():
    """A row an error, a column a model that was tried, each with its time and how many times the spline's."""
    columns = ["level", "group", "peer_s", "spline_s", "ratio"]
    statics = [
        (1e-4, "finite elements", 0.2, 2e-4, 1000.0),
        (1e-2, "finite elements", 0.05, 1e-4, 500.0),
        (1e-2, "OpenSees", 2e-3, 1e-4, 20.0),
    ]
    swings = [(0.1, "Exudyn", 6e-3, 3e-3, 2.0), (0.02, "Exudyn", math.nan, 4e-3, math.nan)]
    tables = {"statics_ratios": statics, "swings_ratios": swings}
    store: Any = SimpleNamespace(
        load_tables=lambda study: {name: pd.DataFrame(rows, columns=columns) for name, rows in tables.items()}
    )
    assert "\n".join(readme._costs(store)).splitlines() == [
        "| error of path and torque, 0 to 90° | spline | finite elements | OpenSees |",
        "|---|---|---|---|",
        "| 1e-02 | 0.1 ms | 50 ms (× 500) | 2 ms (× 20) |",
        "| 1e-04 | 0.2 ms | 0.2 s (× 1000) | – |",
        "",
        "| error of the rotation, 0.05 s of swing | spline | Exudyn |",
        "|---|---|---|",
        "| 0.1 rad | 3 ms | 6 ms (× 2) |",
        "| 0.02 rad | 4 ms | – |",
    ]


def test_blocks_are_put_between_their_marks():
    """Only what stands between the marks of a block is replaced; a page without them is refused."""
    first, second = readme._marks("costs"), readme._marks("hard cases")
    text = f"head\n{first[0]}\nold\n{first[1]}\nbody\n{second[0]}\nold\n{second[1]}\ntail"
    for name, made in (("costs", ["new"]), ("hard cases", iter(["newer", "newest"]))):
        text = readme._between(text, name, made, "PAGE.md")
    assert text == (
        f"head\n{first[0]}\n\nnew\n\n{first[1]}\nbody\n{second[0]}\n\nnewer\nnewest\n\n{second[1]}\ntail"
    )
    with pytest.raises(BadInput, match=r"PAGE\.md: got no marks, expected <!-- other: written by"):
        readme._between(text, "other", [], "PAGE.md")


def test_columns_are_groups_of_the_comparison():
    """Every column is a group that the study of other codes knows by that name."""
    assert set(readme.GROUPS) == set(peers.GROUPS)
