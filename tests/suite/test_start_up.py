"""Commands start fast, as nothing heavy is imported before it is needed, and end with their reader."""

import os
import subprocess
import sys

import pytest

from studies.record.source import ROOT
from studies.registry import STUDIES, selected

HEAVY = (
    *("numpy", "scipy", "numba", "skfem", "pandas", "matplotlib", "tqdm"),
    *("spline_model", "spline_model.compile", "fe_reference"),
)


def _loaded_by(words: list[str]) -> set[str]:
    """Return the heavy packages loaded after `python -m studies` with `words` has run."""
    script = (
        "import sys\n"
        "from studies.__main__ import main\n"
        "try:\n"
        f"    main({words!r})\n"
        "except SystemExit:\n"
        "    pass\n"
        f"print('loaded', *[name for name in {HEAVY!r} if name in sys.modules])"
    )
    done = subprocess.run(
        [sys.executable, "-c", script], cwd=ROOT, capture_output=True, text=True, check=True
    )
    return set(done.stdout.splitlines()[-1].split()[1:])


@pytest.mark.parametrize("words", [["--help"], [], ["case"], ["sweep", "--help"]])
def test_overview_imports_nothing_heavy(words):
    """Help and lists load no numerical package."""
    assert _loaded_by(words) == set()


def test_solve_loads_one_model_and_no_plotting():
    """Solving with one model loads neither the other one's solver nor what only studies need."""
    case = "studies/cases/cross_axis_pivot.toml"
    words = ["solve", case, "--model", "fe", "--rotation-deg", "1", "--increments", "1"]
    assert _loaded_by(words) & {"spline_model.compile", "pandas", "matplotlib"} == set()


def test_names_of_studies():
    """A study is called by its name, its last part, its group or "all"."""
    assert (
        selected(["fig04_trajectory"]) == selected(["paper/fig04_trajectory"]) == ["paper/fig04_trajectory"]
    )
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
    try:
        done = subprocess.run(
            [sys.executable, "-m", "studies", *words],
            cwd=ROOT,
            stdout=write,
            stderr=errors,
            text=True,
            check=False,
        )
    finally:
        os.close(write)
    return done.returncode, done.stderr or ""


@pytest.mark.parametrize("words", [["case"], TABLE], ids=["case", "table"])
def test_a_reader_that_leaves_ends_the_command_quietly(words):
    """No traceback, nothing on the error stream, and the code that a shell gives for SIGPIPE."""
    assert code_without_a_reader(*words) == (141, "")


def test_an_error_that_nobody_reads_is_quiet_too():
    """With both streams gone, as in `2>&1 | true`, bad input ends without a traceback."""
    code, _ = code_without_a_reader("solve", "no.toml", "--model", "fe", errors=subprocess.STDOUT)
    assert code == 141
