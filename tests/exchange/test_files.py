"""What is exported reads back as it was solved, in full or not at all."""

import io
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
from studies.answers.settings import FeSettings, SplineSettings
from studies.cases.design import named_design
from studies.exchange import BODY_ARM, BODY_CENTRE, CLAMP, STRIP, files, meshes, tables


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
