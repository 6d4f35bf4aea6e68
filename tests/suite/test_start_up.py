"""Commands start fast, end with their reader, and work from the wheel outside the repository."""

import json
import os
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

import pytest

from studies.record.source import ROOT
from studies.registry import STUDIES, selected

HEAVY = (
    *("numpy", "scipy", "numba", "skfem", "pandas", "matplotlib"),
    *("spline_model", "spline_model.compile", "fe_reference"),
)


def _loaded_by(*commands: list[str]) -> set[str]:
    """Return the heavy packages loaded after `python -m studies` has run with these words, in one process."""
    script = (
        "import contextlib, sys\n"
        "from studies.__main__ import main\n"
        f"for words in {commands!r}:\n"
        "    with contextlib.suppress(SystemExit):\n"
        "        main(words)\n"
        f"print('loaded', *[name for name in {HEAVY!r} if name in sys.modules])"
    )
    done = subprocess.run(
        [sys.executable, "-c", script], cwd=ROOT, capture_output=True, text=True, check=True
    )
    return set(done.stdout.splitlines()[-1].split()[1:])


def test_overview_imports_nothing_heavy():
    """Help and lists load no numerical package."""
    assert _loaded_by(["--help"], [], ["case"], ["sweep", "--help"]) == set()


def test_solve_loads_one_model_and_no_plotting():
    """Solving with one model loads neither the other one's solver nor what only studies need."""
    case = "studies/cases/cross_axis_pivot.toml"
    words = ["solve", case, "--model", "fe", "--rotation-deg", "1", "--increments", "1"]
    assert _loaded_by(words) & {"spline_model.compile", "pandas", "matplotlib"} == set()


def test_names_of_studies():
    """A study is called by its name, its last part, its group or "all"."""
    for name in ("fig04_trajectory", "paper/fig04_trajectory"):
        assert selected([name]) == ["paper/fig04_trajectory"]
    assert selected(["paper"]) == [name for name in STUDIES if name.startswith("paper/")]
    assert selected(["all", "paper"]) == list(STUDIES)


@pytest.mark.parametrize("package, part", [("spline_model", "strip.laws"), ("fe_reference", "law")])
def test_kernels_without_a_writable_place_are_said_in_one_line(package, part):
    """On a read-only tree without a home nothing ends in a traceback: one line says what is slow, and why."""
    script = (
        "from numba.core import caching\n"
        "def refuse(locator): raise OSError('read-only')\n"
        "for locator in caching.CacheImpl._locator_classes: locator.ensure_cache_path = refuse\n"
        f"import {package}.{part}"
    )
    done = subprocess.run([sys.executable, "-c", script], cwd=ROOT, capture_output=True, text=True)
    (line,) = done.stderr.splitlines()
    assert done.returncode == 0
    assert line.startswith(f"{package}: got no writable place for compiled kernels, expected one ")


TABLE = ["solve", "studies/cases/cross_axis_pivot.toml", "--model", "fe", "--increments", "1"]


def code_without_a_reader(*words: str, errors: int | None = subprocess.PIPE) -> tuple[int, str]:
    """Return exit code and error stream of `python -m studies` whose output nobody reads."""
    read, write = os.pipe()
    os.close(read)
    command = [sys.executable, "-m", "studies", *words]
    with os.fdopen(write, "w") as output:
        done = subprocess.run(command, cwd=ROOT, stdout=output, stderr=errors, text=True, check=False)
    return done.returncode, done.stderr or ""


@pytest.mark.parametrize("words", [["case"], TABLE], ids=["case", "table"])
def test_a_reader_that_leaves_ends_the_command_quietly(words):
    """No traceback, nothing on the error stream, and the code that a shell gives for SIGPIPE."""
    assert code_without_a_reader(*words) == (141, "")


def test_an_error_that_nobody_reads_is_quiet_too():
    """With both streams gone, as in `2>&1 | true`, bad input ends without a traceback."""
    code, _ = code_without_a_reader("solve", "no.toml", "--model", "fe", errors=subprocess.STDOUT)
    assert code == 141


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


def printed(words: list[str], folder: Path) -> str:
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
    printed([*pip, "wheel", *options, "--wheel-dir", str(place), str(source)], place)
    printed([sys.executable, "-m", "venv", "--without-pip", "fresh"], place)
    fresh = place / "fresh"
    names = {"base": str(fresh), "platbase": str(fresh)}
    installed = Path(sysconfig.get_path("purelib", "venv", vars=names))
    (installed / "dependencies.pth").write_text(sysconfig.get_path("purelib"), encoding="utf-8")
    programs = Path(sysconfig.get_path("scripts", "venv", vars=names))
    (wheel,) = place.glob("*.whl")
    python = str(programs / "python")
    printed([*pip, "--python", python, "install", "--no-deps", "--no-index", str(wheel)], place)
    return programs


@pytest.mark.slow
def test_wheel_works_outside_the_repository(scripts, tmp_path):
    """Requirement: the commands run, and their files go to the current folder."""
    program = str(scripts / "crosspivot")
    answer = json.loads(printed([program, "solve", "titanium_pivot", "--json", "-"], tmp_path))
    assert answer["status"] == "converged"
    printed([program, "case", "--out", "my_pivot.toml"], tmp_path)
    printed([program, "solve", "my_pivot.toml", "--increments", "2", "--plot", "my_pivot.svg"], tmp_path)
    words = ["converge", "my_pivot.toml", "--control-points", "4:5", "--elements", "2:8"]
    printed([program, *words], tmp_path)
    assert (tmp_path / "results" / "designs" / "my_pivot" / "elements.csv").is_file()
    assert (tmp_path / "my_pivot.svg").is_file()


@pytest.mark.slow
def test_python_example_works_outside_the_repository(scripts, tmp_path):
    """Requirement: names, published cases, tables and the page of the wheel are those of the repository."""
    python = str(scripts / "python")
    table = (ROOT / "tests" / "table_one.py").read_text(encoding="utf-8")
    (tmp_path / "tests_of_wheel.py").write_text(table, encoding="utf-8")
    (tmp_path / "example.py").write_text(EXAMPLE, encoding="utf-8")
    printed([python, "example.py"], tmp_path)
    assert (tmp_path / "python.png").is_file()
    script = "import studies; print(studies.__path__[0])"
    package = Path(printed([python, "-c", script], tmp_path).strip())
    assert ROOT not in package.parents
    own, installed = (
        {path.relative_to(each) for path in each.rglob("*") if path.suffix in DATA}
        for each in (ROOT / "studies", package)
    )
    assert own == installed
