"""The repository is complete and speaks of itself alone."""

import getpass
import platform
import re
import subprocess
import tomllib
from pathlib import Path

import pytest

from studies.record.source import ROOT
from tests.bench import conftest as bench

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))


def _committed() -> list[str]:
    """Return the paths of the files that are or would be committed."""
    words = ["git", "ls-files", "--cached", "--others", "--exclude-standard"]
    try:
        done = subprocess.run(words, cwd=ROOT, capture_output=True, text=True, check=True)
    except (OSError, subprocess.CalledProcessError):
        pytest.skip("not a git working tree")
    return [name for name in done.stdout.splitlines() if (ROOT / name).is_file()]


def _text(path: Path) -> str:
    """Return what a file says; nothing where it is no text, as a picture or a table in Parquet."""
    try:
        return path.read_bytes().decode("utf-8")
    except UnicodeDecodeError:
        return ""


def test_packages_are_all_named():
    """Every package of the wheel is named in pyproject.toml: setuptools cannot discover flat folders."""
    found = {
        ".".join(path.parent.relative_to(ROOT).parts)
        for top in ("fe_reference", "spline_model", "studies")
        for path in (ROOT / top).rglob("__init__.py")
    }
    assert found == set(PROJECT["tool"]["setuptools"]["packages"])


@pytest.mark.parametrize(("lock", "extra"), [("", "dev"), ("-interactive", "interactive")])
def test_lock_pins_everything_that_is_asked_for(lock, extra):
    """A lock pins each package with ==, has every dependency, and names no host or path."""
    lines = (ROOT / f"requirements{lock}.lock").read_text(encoding="utf-8").splitlines()
    pins = [line for line in lines if not line.startswith("#")]
    assert [line for line in pins if not re.fullmatch(r"[\w.-]+==[\w.]+", line)] == []
    locked = {re.sub(r"[-_.]+", "-", line.split("==")[0]).lower() for line in pins}
    asked = PROJECT["project"]["optional-dependencies"][extra]
    asked = asked if lock else asked + PROJECT["project"]["dependencies"]
    assert {re.split(r"[^\w-]", need)[0] for need in asked} - locked == set()


def test_no_machine_is_named():
    """No committed file holds an absolute path of a machine, a user or a host."""
    # the slash first: it is what a search can leap to
    pattern = re.compile(r"/(?<![\w.:/]/)(?:home|root|Users|work|tmp|mnt|opt)" + r"/\w")
    host = platform.node()
    faults = []
    for name in _committed():
        text = _text(ROOT / name)
        faults += [f"{name}: {match[0]}" for match in pattern.finditer(text)]
        faults += [
            f"{name}: {word}" for word in (str(ROOT), f"@{host}", f"{getpass.getuser()}@") if word in text
        ]
    assert faults == []


#: Tests that read a clock, and why; those of the browser (tests/interactive) live in its time.
CLOCKS = {
    "tests/bench/test_ratios.py": "`make bench` alone runs them",
    "tests/sweep/test_command.py": "they wait for another process, with an end that no machine reaches",
}


def test_no_test_judges_seconds():
    """Tests count work: what else the machine does must not make them red, so that none reads a clock."""
    clock = re.compile(r"\b(perf_counter|monotonic|process_time|time\.time|timeit)\b(?! *\")")
    found = [
        str(path.relative_to(ROOT))
        for path in sorted((ROOT / "tests").rglob("*.py"))
        if path.parent.name != "interactive" and clock.search(path.read_text(encoding="utf-8"))
    ]
    own = [str(path) for path in (Path("tests/bench/test_speed.py"), Path("tests/suite/test_repository.py"))]
    assert sorted({*found} - {*own}) == sorted(CLOCKS)


def test_what_compares_times_is_left_out_of_the_tests(pytestconfig):
    """Ratios of times are collected where benchmarks are asked for, which the tests' options never do."""
    assert "--benchmark-disable" in PROJECT["tool"]["pytest"]["ini_options"]["addopts"]
    assert bench.pytest_ignore_collect(ROOT / "tests" / "bench" / bench.TIMED, pytestconfig)
    assert bench.pytest_ignore_collect(ROOT / "tests" / "bench" / "test_speed.py", pytestconfig) is None


def test_figures_stay_small():
    """No committed figure is larger than 200 kB."""
    figures = [name for name in _committed() if name.startswith("results/figures/")]
    assert figures
    assert [name for name in figures if (ROOT / name).stat().st_size > 200_000] == []


def test_integration_runs_what_a_user_runs():
    """Continuous integration calls the Makefile's targets by one script, and has every version of Python."""
    script = (ROOT / ".ci" / "run").read_text(encoding="utf-8")
    assert "make lint" in script
    assert "make test" in script
    assert (ROOT / ".ci" / "run").stat().st_mode & 0o111
    workflow = (ROOT / ".github" / "workflows" / "ci.yml").read_text(encoding="utf-8")
    assert "run: .ci/run" in workflow
    prefix = "Programming Language :: Python :: "
    versions = [each.removeprefix(prefix) for each in PROJECT["project"]["classifiers"] if prefix in each]
    matrix = ", ".join(f'"{each}"' for each in versions)
    assert workflow.count(f"python: [{matrix}]") == 2


def test_version_and_requirements_are_the_same_in_all_files():
    """The recipe of conda and CITATION.cff have version and dependencies of pyproject.toml."""
    project = PROJECT["project"]
    recipe = (ROOT / "conda" / "meta.yaml").read_text(encoding="utf-8")
    run = recipe.partition("  run:\n")[2].partition("\n\n")[0]
    needs = {line.strip(" -").replace("matplotlib-base", "matplotlib") for line in run.splitlines()}
    wanted = [*project["dependencies"], f"python{project['requires-python']}"]
    assert needs == {re.sub(r"(?=>)", " ", each, count=1) for each in wanted}
    (script,) = (f"{name} = {place}" for name, place in project["scripts"].items())
    assert f"    - {script}\n" in recipe
    assert f'  version: "{project["version"]}"\n' in recipe
    assert f"\nversion: {project['version']}\n" in (ROOT / "CITATION.cff").read_text(encoding="utf-8")


def test_every_folder_says_what_lives_in_it():
    """Each top-level folder has a README of about ten lines, and CONTRIBUTING's layout names the folder, with
    the parts of studies and tests; the README of the pages names them all."""
    layout = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    for name in ("spline_model", "fe_reference", "studies", "results", "report", "docs", "tests"):
        text = (ROOT / name / "README.md").read_text(encoding="utf-8")
        assert 5 <= len(text.splitlines()) <= 16, name
        assert f"\n    {name}/" in layout
    parts = {Path(name).parts for name in _committed() if name.startswith(("studies/", "tests/"))}
    assert [part[1] for part in parts if len(part) > 2 and f" {part[1]}/" not in layout] == []
    pages = (ROOT / "docs" / "README.md").read_text(encoding="utf-8")
    named = {path.name for path in (ROOT / "docs").glob("*.md")} - {"README.md"}
    assert [name for name in named if f"`{name}`" not in pages] == []
