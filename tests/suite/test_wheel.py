"""The wheel works outside the repository: commands, cases, page, pictures and Python names."""

import json
import os
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

import pytest

from studies.record.source import ROOT

#: Endings of the files that the packages read.
DATA = {".toml", ".js", ".css", ".html"}
EXAMPLE = """
import studies
from spline_model import cross_axis_pivot, solve_statics
from tests_of_wheel import TABLE_ONE

pivot = cross_axis_pivot(**TABLE_ONE, control_points=6)
path = solve_statics(pivot, rotation=0.2, increments=2)
studies.plot(path, pivot).save("python.png")
assert path.rotation[-1] == 0.2
"""


def run(words: list[str], folder: Path) -> str:
    """Return what a program prints; kernels run as Python code, which spares their compilation."""
    env = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    env |= {"NUMBA_DISABLE_JIT": "1", "MPLBACKEND": "Agg"}
    done = subprocess.run(words, cwd=folder, env=env, capture_output=True, text=True)
    assert done.returncode == 0, f"{words}: {done.stderr}"
    return done.stdout


@pytest.fixture(scope="module")
def scripts(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Build and install the wheel in a new environment; return the folder of its programs.

    Dependencies come from the environment of the tests, so that no network is needed.
    """
    place = tmp_path_factory.mktemp("wheel")
    pip = [sys.executable, "-m", "pip", "--quiet", "--disable-pip-version-check"]
    options = ["--no-deps", "--no-build-isolation", "--no-cache-dir"]
    source = place / "source"  # a copy: the build leaves files in its folder
    for name in ("fe_reference", "spline_model", "studies"):
        shutil.copytree(ROOT / name, source / name, ignore=shutil.ignore_patterns("__pycache__"))
    for name in ("pyproject.toml", "README.md", "LICENSE"):
        shutil.copy(ROOT / name, source)
    run([*pip, "wheel", *options, "--wheel-dir", str(place), str(source)], place)
    run([sys.executable, "-m", "venv", "--without-pip", "fresh"], place)
    fresh = place / "fresh"
    names = {"base": str(fresh), "platbase": str(fresh)}
    installed = Path(sysconfig.get_path("purelib", "venv", vars=names))
    (installed / "dependencies.pth").write_text(sysconfig.get_path("purelib"), encoding="utf-8")
    programs = Path(sysconfig.get_path("scripts", "venv", vars=names))
    (wheel,) = place.glob("*.whl")
    python = str(programs / "python")
    run([*pip, "--python", python, "install", "--no-deps", "--no-index", str(wheel)], place)
    return programs


@pytest.mark.slow
def test_wheel_works_outside_the_repository(scripts, tmp_path):
    """Requirement: the commands run, and their files go to the current folder."""
    program = str(scripts / "crosspivot")
    answer = json.loads(run([program, "solve", "titanium_pivot", "--json", "-"], tmp_path))
    assert answer["status"] == "converged"
    run([program, "case", "--out", "my_pivot.toml"], tmp_path)
    run([program, "solve", "my_pivot.toml", "--increments", "2", "--plot", "my_pivot.svg"], tmp_path)
    words = ["converge", "my_pivot.toml", "--control-points", "4:5", "--elements", "2:8"]
    run([program, *words], tmp_path)
    assert (tmp_path / "results" / "designs" / "my_pivot" / "elements.csv").is_file()
    assert (tmp_path / "my_pivot.svg").is_file()


@pytest.mark.slow
def test_python_example_works_outside_the_repository(scripts, tmp_path):
    """Requirement: names, published cases, tables and the page of the wheel are those of the repository."""
    python = str(scripts / "python")
    table = (ROOT / "tests" / "table_one.py").read_text(encoding="utf-8")
    (tmp_path / "tests_of_wheel.py").write_text(table, encoding="utf-8")
    (tmp_path / "example.py").write_text(EXAMPLE, encoding="utf-8")
    run([python, "example.py"], tmp_path)
    assert (tmp_path / "python.png").is_file()
    script = "import studies; print(studies.__path__[0])"
    package = Path(run([python, "-c", script], tmp_path).strip())
    assert ROOT not in package.parents
    own, installed = (
        {path.relative_to(each) for path in each.rglob("*") if path.suffix in DATA}
        for each in (ROOT / "studies", package)
    )
    assert own == installed
