"""docs/data.md describes every table, column, key and array that there is, and nothing else."""

import json
import re
from functools import cache

import pandas as pd
import pytest

from studies.__main__ import main
from studies.answers.named import named
from studies.answers.quantities import QUANTITIES
from studies.cases.design import named_design, read_design
from studies.cases.problem import FOLDER
from studies.exchange import meshes, tables
from studies.record.source import ROOT
from studies.record.store import RESULTS
from tests.exchange.test_files import solved

PAGE = (ROOT / "docs" / "data.md").read_text(encoding="utf-8")
#: What every state has as a whole, which has a table of its own.
KEYS = {each.key for each in QUANTITIES}
#: A case with every kind of named part.
LISTS = ROOT / "tests" / "exchange" / "lists.toml"
#: Tables that are the same in all studies.
COMMON = ("findings", "counts")
#: What a name that ends so says of its unit.
UNITS = {
    "Nm_per_rad": "N m/rad", "per_s": "1/s", "rad": "rad", "deg": "deg", "Nm": "N m", "Pa": "Pa", "Hz": "Hz",
    "mm": "mm", "ms": "ms", "us": "us", "MB": "MB", "J": "J", "m": "m", "s": "s",
}  # fmt: skip


def described(heading: str) -> dict[str, list[str]]:
    """Return the rows of the tables below a heading by the names in their first cell, each once."""
    text = re.split(r"^#+ |^\*\*(?=[A-Z])", PAGE.split(heading, 1)[1], flags=re.MULTILINE)[0]
    found: dict[str, list[str]] = {}
    for line in text.splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        for name in re.findall(r"`([^`]+)`", cells[0]) if line.startswith("| `") else ():
            assert name not in found, f"{name} is described twice"
            assert all(cells[1:]), f"{name}: an empty cell"
            found[name] = cells[1:]
    return found


@cache
def stored() -> dict[str, list[str]]:
    """Columns of every stored table by its name."""
    return {
        path.relative_to(RESULTS / "data").with_suffix("").as_posix(): pd.read_csv(
            path, nrows=0
        ).columns.tolist()
        for path in sorted((RESULTS / "data").rglob("*.csv"))
    }


def test_every_table_is_described():
    """A table of results that is not described fails, and so does a description without a table."""
    tables = {name for name in stored() if name.rsplit("/", 1)[1] not in COMMON}
    assert set(described("## Tables of results")) == tables


def test_every_column_is_described():
    """A column of results that is not described fails, and so does a description without a column."""
    assert set(described("## Columns of results")) == {name for table in stored().values() for name in table}


def test_units_are_those_in_the_names():
    """The unit of a column is the one that its name ends in; a name without one has no unit of its own."""
    plain = {"1", "–", "EI/L^2"}
    for name, (unit, _) in described("## Columns of results").items():
        ends = [short for short in UNITS if name.endswith(f"_{short}")]
        assert unit in ({UNITS[max(ends, key=len)]} if ends else plain), name


@pytest.mark.parametrize(
    "words",
    [
        ["solve", "cross_axis_pivot", "--increments", "1"],
        ["solve", "cross_axis_pivot", "--increments", "2", "--rotation-deg", "5", "--accuracy", "0.1"],
        ["solve", "four_bar_of_flexures", "--increments", "1"],
        ["release", "cross_axis_pivot", "--duration", "1e-4", "--rotation-deg", "5"],
        ["release", "cantilever_with_body", "--duration", "1e-4"],
        ["modes", "cross_axis_pivot", "--count", "1"],
    ],
    ids=lambda words: " ".join(words[:2]),
)
def test_keys_of_json_are_described(words, capsys):
    """Every key of the commands' JSON is described, and the commands that have it are named."""
    command, case, *options = words
    path = str(FOLDER / f"{case}.toml")
    assert main([command, path, "--model", "spline", "--control-points", "4", "--json", "-", *options]) == 0
    document = json.loads(capsys.readouterr().out)
    known = described("## JSON of the commands")
    quantities = described("## Quantities of a state") | {each.key: [] for each in named(named_design(case))}
    assert set(document) <= set(known) | set(quantities)
    for key in set(document) - (set(quantities) if command == "solve" else set()):
        places = known[key][2]
        kinds = (command, "all", "pivots" if case == "cross_axis_pivot" else "mechanisms")
        assert any(kind in places for kind in kinds), f"{key} in {command}"


def test_arrays_of_vtk_are_described():
    """Every array of a .vtu is described with whether it is of points or cells."""
    known = described("**VTK.**")
    points, cells = set(), set()
    for kind in ("static", "modes", "release"):
        made = next(meshes(solved(kind)))
        points |= set(made.point_data)
        cells |= set(made.cell_data)
    assert {name for name, row in known.items() if row[1] == "points"} == points
    quantities = {
        *described("## Quantities of a state"),
        *(each.key for each in named(solved("static").design)),
    }
    assert {name for name, row in known.items() if row[1] == "cells"} == cells - quantities


def test_quantities_of_named_parts_are_described():
    """Every number of a support, drive, spring, point or free end is described, with its unit."""
    kinds, found = {"stage": "BODY", "post": "BODY", "beam": "STRIP", "nose": "POINT"}, {}
    for each in named(read_design(LISTS)):
        first, _, rest = each.key.partition("_")
        found[f"{kinds[first]}_{rest}" if first in kinds else each.key] = each.unit
    assert found == {name: row[0] for name, row in described("## Quantities of named parts").items()}


def test_columns_of_exports_are_described():
    """Every column of the exported tables is described, those of quantities and named parts elsewhere."""
    answers = [solved(kind) for kind in ("static", "mechanism", "loads", "modes", "release")]
    found = {column for answer in answers for table in tables(answer).values() for column in table}
    parts = {each.key for answer in answers for each in named(answer.design)}
    assert set(described("**Tables.**")) == found - KEYS - parts
    assert set(described("## Quantities of a state")) == KEYS
