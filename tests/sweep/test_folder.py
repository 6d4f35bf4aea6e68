"""The folder of a sweep: whole files only, one table whatever came in between, and nothing else's folder."""

import errno
import json
import resource

import pandas as pd
import pyarrow.parquet as pq
import pytest

from studies.record.files import OutputError
from studies.sweep import run
from studies.sweep.points import solve_chunk
from studies.sweep.run import SweepError, local_pool, sweep
from tests.sweep.sweeps import GRID, RANDOM, plan, within


def listed(folder):
    """Return the files of a folder and of those in it."""
    return sorted(str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file())


class Stopped(Exception):
    """An interruption."""


def stop_after(points):
    """Return a progress callable that interrupts the sweep once so many points are done."""

    def progress(done, total):
        if done >= points:
            raise Stopped

    return progress


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """The folder of the random pivots, solved without interruption, with CSV."""
    folder = tmp_path_factory.mktemp("sweep") / "whole"
    assert sweep(plan(RANDOM), folder, csv=True, pool=within()) == 104
    return folder


def test_table_has_a_row_a_point_in_order(whole):
    """Requirement: in the end there is one table of all points, row group by row group, and what made it."""
    assert listed(whole) == ["designs.csv", "designs.parquet", "sweep.json"]
    table = pd.read_parquet(whole / "designs.parquet")
    assert list(table["point"]) == list(range(104))
    assert (table["status"] == "converged").all()
    assert pq.ParquetFile(whole / "designs.parquet").num_row_groups == 4
    manifest = json.loads((whole / "sweep.json").read_text())
    assert list(manifest["columns"]) == list(table.columns)
    assert manifest["inputs"]["sample"] == {"method": "sobol", "points": 104, "chunk": 32}
    csv = pd.read_csv(whole / "designs.csv")
    assert csv["torque_Nm"].equals(table["torque_Nm"])


@pytest.mark.parametrize("points", [50, *(pytest.param(n, marks=pytest.mark.slow) for n in (0, 104))])
def test_interrupted_sweep_goes_on_to_the_same_bytes(points, whole, tmp_path, monkeypatch):
    """Requirement: after an interruption at any time only what is missing is solved, to the same table."""
    out = tmp_path / "out"
    with pytest.raises(Stopped):
        sweep(plan(RANDOM), out, progress=stop_after(points), pool=within())
    kept = sum(pq.read_metadata(part).num_rows for part in (out / "parts").glob("part-*"))
    assert kept >= points
    solved = []

    def counted(task, start, columns):
        solved.append(start)
        return solve_chunk(task, start, columns)

    monkeypatch.setattr(run, "solve_chunk", counted)
    assert sweep(plan(RANDOM), out, csv=True, pool=within()) == 104 - kept
    assert len(solved) == len(set(solved)) == -(-(104 - kept) // 32)
    for name in ("designs.parquet", "designs.csv", "sweep.json"):
        assert (out / name).read_bytes() == (whole / name).read_bytes()


PAIRS = ("[[0, 0], [0.01, -0.01]]", [[0.0, 0.0], [0.01, -0.01]], ["[0.0, 0.0]", "[0.01, -0.01]"])
HISTORIES = ("[[[0, 0], [1, 1]], [[0, 1]]]", ["[[0, 0], [1, 1]]", "[[0, 1]]"])


@pytest.mark.parametrize(
    ("key", "values", "stored", "written"),
    [("body.centre_offset_m", *PAIRS), ("drive.history", *HISTORIES, HISTORIES[1])],
)
def test_lists_are_values_too(key, values, stored, written, tmp_path):
    """Requirement: pairs and lists of pairs vary as numbers do, whole ones beside others, in chunks, and
    stand in either table."""
    text = f'case = "cross_axis_pivot"\nsample.chunk = 1\nvary.{key} = {values}\n'
    asked = plan(text + "set.drive = { rotation_deg = 5, increments = 1 }\nsettings.control_points = 5")
    assert sweep(asked, tmp_path, csv=True, pool=within()) == 2
    table = pd.read_parquet(tmp_path / "designs.parquet")
    assert [list(each) if isinstance(stored[0], list) else each for each in table[key]] == stored
    assert list(pd.read_csv(tmp_path / "designs.csv")[key]) == written


def test_a_finished_sweep_is_not_solved_again(whole, monkeypatch):
    """Requirement: the same call on a finished folder does nothing."""
    monkeypatch.setattr(run, "solve_chunk", None)
    before = (whole / "designs.parquet").stat().st_mtime_ns
    assert sweep(plan(RANDOM), whole, pool=within()) == 0
    assert (whole / "designs.parquet").stat().st_mtime_ns == before


def test_table_does_not_depend_on_the_workers(whole, tmp_path):
    """Requirement: two processes give the same bytes as one thread."""
    sweep(plan(RANDOM), tmp_path / "out", pool=local_pool(2))
    assert (tmp_path / "out" / "designs.parquet").read_bytes() == (whole / "designs.parquet").read_bytes()


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (("points = 104", "points = 105"), "another sample.points"),
        (("rotation_deg = 45", "rotation_deg = 46"), "another case.drive.rotation_deg"),
        (("0.9", "0.8"), "another vary.strip.crossing_ratio.to"),
        (("[vary]", "[settings]\ncontrol_points = 8\n[vary]"), "another settings"),
        (("[vary]", '[store]\nquantities = ["torque_Nm"]\n[vary]'), "another store"),
    ],
)
def test_another_sweep_asks_for_another_folder(change, words, whole):
    """Requirement: a used folder takes the same sweep only; what is different is named."""
    before = listed(whole)
    with pytest.raises(OutputError, match=words):
        sweep(plan(RANDOM.replace(*change)), whole, pool=within())
    assert listed(whole) == before


def test_other_code_or_libraries_ask_for_another_folder(whole, monkeypatch):
    """Requirement: points of different versions never stand in one table."""
    real = run.version
    monkeypatch.setattr(run, "version", lambda name: "0.0" if name == "numba" else real(name))
    with pytest.raises(OutputError, match=r"versions that differ \(numba\)"):
        sweep(plan(RANDOM), whole, pool=within())
    monkeypatch.setattr(run, "version", real)
    monkeypatch.setattr(run, "source_hash", lambda module: "other")
    with pytest.raises(OutputError, match=r"suite that differ \(source_sha256\)"):
        sweep(plan(RANDOM), whole, pool=within())


def test_a_folder_of_something_else_is_refused(tmp_path):
    """Requirement: nothing is mixed into a folder that holds other files, or put in the place of a file."""
    (tmp_path / "thesis.txt").write_text("years of work")
    with pytest.raises(OutputError, match="got a folder with other files"):
        sweep(plan(GRID), tmp_path, pool=within())
    with pytest.raises(OutputError, match="got a file, expected a folder"):
        sweep(plan(GRID), tmp_path / "thesis.txt", pool=within())
    assert listed(tmp_path) == ["thesis.txt"]


def test_two_runs_in_one_folder_are_refused(tmp_path):
    """Requirement: a second run in a folder at work is one line, and the first goes on."""
    seen = []

    def second(done, total):
        if not seen:
            seen.append(done)
            with pytest.raises(OutputError, match="another run is at work"):
                sweep(plan(GRID), tmp_path / "out", pool=within())

    assert sweep(plan(GRID), tmp_path / "out", progress=second, pool=within()) == 12


def test_what_a_killed_run_left_is_removed(whole, tmp_path):
    """Requirement: half-written files of a run that was killed are not taken for results."""
    out = tmp_path / "out"
    with pytest.raises(Stopped):
        sweep(plan(RANDOM), out, progress=stop_after(60), pool=within())
    (out / "parts" / ".part-00000003.parquet.x7").write_bytes(b"half")
    (out / ".designs.parquet.q3").write_bytes(b"half")
    sweep(plan(RANDOM), out, pool=within())
    assert listed(out) == ["designs.parquet", "sweep.json"]
    assert (out / "designs.parquet").read_bytes() == (whole / "designs.parquet").read_bytes()


@pytest.mark.parametrize("room", [5000, *(pytest.param(n, marks=pytest.mark.slow) for n in (1000, 20000))])
def test_a_full_disk_is_one_line_and_leaves_whole_files(room, whole, tmp_path):
    """Requirement: if the disk is full, the message is one line, no file is half-written, and with
    room the sweep goes on to the same table: full at the manifest, at a part, at the table."""
    out = tmp_path / "out"
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (room, limits[1]))
    try:
        with pytest.raises(OutputError, match="cannot be written") as full:
            sweep(plan(RANDOM), out, pool=within())
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert "\n" not in str(full.value)
    assert full.value.__context__.errno == errno.EFBIG
    for path in out.rglob("*.parquet"):
        assert pq.read_table(path).num_rows in (32, 8)
    assert [name for name in listed(out) if "/." in name or name.startswith(".")] == []
    expected = {1000: 0, 5000: 0, 20000: 4}[room]
    assert len(list(out.rglob("part-*.parquet"))) == expected
    sweep(plan(RANDOM), out, pool=within())
    assert (out / "designs.parquet").read_bytes() == (whole / "designs.parquet").read_bytes()


def test_chunks_that_no_worker_can_solve_are_named(tmp_path, monkeypatch):
    """Requirement: a fault of the workers themselves names the points, and what was solved is kept."""

    def faulty(task, start, columns):
        if start == 64:
            raise MemoryError("no room")
        return solve_chunk(task, start, columns)

    monkeypatch.setattr(run, "solve_chunk", faulty)
    with pytest.raises(SweepError, match=r"points 64 to 95: .* \(MemoryError: no room"):
        sweep(plan(RANDOM), tmp_path / "out", pool=within())
    assert len(list((tmp_path / "out" / "parts").iterdir())) >= 2
