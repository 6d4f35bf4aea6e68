"""What is exported reads back as it was solved, in full or not at all; docs/data.md describes it."""

import io
import json
import re
from dataclasses import replace
from functools import cache
from pathlib import Path
from xml.etree import ElementTree

import meshio
import numpy as np
import pandas as pd
import pytest

from studies.__main__ import main
from studies.answers.adapters import answer_modes, answer_release, answer_static
from studies.answers.answer import Answer
from studies.answers.named import named
from studies.answers.quantities import QUANTITIES
from studies.answers.settings import FeSettings, SplineSettings
from studies.cases.design import named_design, read_design
from studies.cases.problem import FOLDER
from studies.exchange import BODY_ARM, BODY_CENTRE, CLAMP, STRIP, files, meshes, tables
from studies.record.source import ROOT
from studies.record.store import RESULTS


@cache
def solved(kind: str) -> Answer:
    """The answer of each analysis, of a pivot and of mechanisms with and without bodies that are driven."""
    spline, elements = SplineSettings(control_points=5), FeSettings(elements=5)
    pivot, linkage = (replace(named_design(name), increments=3) for name in
                      ("cross_axis_pivot", "four_bar_of_flexures"))  # fmt: skip
    if kind == "static":
        return answer_static(pivot, spline)
    if kind == "mechanism":
        return answer_static(linkage, elements)
    if kind == "modes":
        return answer_modes(linkage, spline, rotation=linkage.rotation, count=3)
    if kind == "loads":
        guide = replace(named_design("parallel_strip_guide"), increments=2)
        return answer_static(guide, spline)
    step = {"step": 1e-4, "integrator": "generalised-alpha"}
    return answer_release(pivot, elements, duration=5e-4, records=5, **step)


KINDS = pytest.mark.parametrize("kind", ["static", "mechanism", "loads", "modes", "release"])


@KINDS
def test_vtk_reads_back(kind, tmp_path):
    """Every .vtu holds its state, and the .pvd names them in order with their times."""
    found = solved(kind)
    written = {name: content for name, content in files(found).items() if not name.endswith(".csv")}
    for name, content in written.items():
        (tmp_path / name).write_bytes(content)
    series = ElementTree.parse(tmp_path / f"{found.analysis}.pvd").getroot().findall("Collection/DataSet")
    assert [float(each.attrib["timestep"]) for each in series] == pytest.approx(found.values)
    for made, each in zip(meshes(found), series, strict=True):
        read = meshio.read(tmp_path / each.attrib["file"])
        assert np.array_equal(read.points, made.points)
        assert read.point_data.keys() == made.point_data.keys()
        for name, values in made.point_data.items():
            assert np.array_equal(read.point_data[name], values, equal_nan=True), name
        for name, values in made.cell_data.items():
            assert np.array_equal(np.concatenate(read.cell_data[name]), np.concatenate(values)), name
    assert len(series) == len(written) - 1 == len(found.values)


@KINDS
def test_mesh_holds_what_was_solved(kind):
    """Points, displacements, forces and parts of the mesh are those of the answer."""
    found = solved(kind)
    last, made = len(found.values) - 1, list(meshes(found))[-1]
    along, moves = found.along, found.analysis == "modes"
    strips, stations = along.rotation.shape[1:]
    count = strips * stations
    mode = found.scale_of(last) * found.mode_shape[last] if moves else 0.0
    assert made.points[:count, :2] == pytest.approx((along.shape[last] + mode).reshape(-1, 2))
    assert not made.points[:, 2].any()
    rest = made.points[:count, :2] - made.point_data["displacement_m"][:count, :2]
    if not moves:
        assert rest == pytest.approx(along.rest_shape.reshape(-1, 2), abs=1e-15)
    for name, array in (("axial_force_N", along.axial_force), ("bending_moment_Nm", along.bending_moment)):
        assert made.point_data[name][:count] == pytest.approx(array[last].ravel())
        assert np.isnan(made.point_data[name][count:]).all()
    kinds = np.concatenate(made.cell_data["part_kind"])
    carried = [
        end for part in found.design.strips for end in (part.root, part.tip) if end not in ("ground", None)
    ]
    clamped = [end for part in found.design.strips for end in (part.root, part.tip) if end == "ground"]
    assert (kinds == STRIP).sum() == count - strips
    assert (kinds == BODY_CENTRE).sum() == len(found.design.bodies)
    assert (kinds == BODY_ARM).sum() == len(carried)
    assert (kinds == CLAMP).sum() == len(clamped)
    total = made.point_data["reaction_force_N"].sum(axis=0)[:2]
    assert total == pytest.approx(along.reactions[last, ..., :2].sum(axis=(0, 1)))


@KINDS
def test_tables_read_back(kind):
    """CSV holds the tables as they are."""
    found = solved(kind)
    written = files(found)
    for table, frame in tables(found).items():
        read = pd.read_csv(io.BytesIO(written[f"{found.analysis}_{table}.csv"]))
        pd.testing.assert_frame_equal(read, frame)
    rows = tables(found)["strips"]
    assert len(rows) == found.along.axial_force.size
    assert rows["axial_force_N"].to_numpy() == pytest.approx(found.along.axial_force.ravel())


def solve(folder: Path, *options: str) -> int:
    return main(["solve", "cross_axis_pivot", "--increments", "2", "--export", str(folder), *options])


def test_command_writes_series_and_tables(tmp_path, capsys):
    """The command writes a series and tables, and names the folder; a folder with anything in it is refused
    untouched."""
    assert solve(tmp_path / "new") == 0
    written = {path.name: path.read_bytes() for path in (tmp_path / "new").iterdir()}
    expected = {"static.pvd", "static_0000.vtu", "static_0001.vtu", "static_0002.vtu"}
    assert written.keys() == expected | {
        f"static_{table}.csv" for table in ("states", "strips", "bodies", "reactions")
    }
    assert "3 states" in capsys.readouterr().out
    assert solve(tmp_path / "new", "--model", "fe") == 2
    assert {path.name: path.read_bytes() for path in (tmp_path / "new").iterdir()} == written


def test_a_path_that_stops_is_exported_as_far_as_it_goes(tmp_path, capsys):
    """The part that a finer mesh has too of a path that stops is written, with exit code 3 and why."""
    options = ["--model", "fe", "--elements", "2", "--rotation-deg", "350"]
    assert solve(tmp_path / "out", *options) == 3
    assert "not converged" in capsys.readouterr().err
    assert pd.read_csv(tmp_path / "out" / "static_states.csv")["load_factor"].tolist() == [0.0]


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
