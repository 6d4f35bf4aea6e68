"""The repository is complete and speaks of itself alone; who imports whom, and what a hash follows."""

import ast
import getpass
import json
import os
import platform
import re
import shutil
import subprocess
import sys
import tomllib
from graphlib import TopologicalSorter
from pathlib import Path

import pandas as pd
import pytest

from studies.record.files import forget_stale
from studies.record.source import PACKAGES, ROOT, imported, imports, reached, source_hash
from studies.registry import STUDIES
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


MODELS = {"spline_model": {"numpy", "scipy", "numba"}, "fe_reference": {"numpy", "scipy", "numba", "skfem"}}
#: Files of a model in which an answer becomes a table of pandas, loaded when it is asked for.
FRAMES = {"solution.py", "trajectory.py"}


def _top_level_imports(path: Path, source: str) -> set[str]:
    """Return the top-level names that `source`, standing at `path`, imports in any way."""
    module = ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")
    tree = ast.parse(source)
    names = set(imports(tree, module, package=path.name == "__init__.py"))
    for node in ast.walk(tree):
        if isinstance(node, ast.Call) and getattr(node.func, "id", getattr(node.func, "attr", "")) in (
            "import_module",
            "__import__",
        ):
            names |= {word.value for word in node.args if isinstance(word, ast.Constant)}
    return {str(name).split(".")[0] for name in names}


def _breaches(path: Path, source: str) -> set[str]:
    """Return what `source` at `path` imports against the rules."""
    package = path.relative_to(ROOT).parts[0]
    found = _top_level_imports(path, source)
    if package in MODELS:
        frames = {"pandas"} if path.name in FRAMES else set()
        return found - MODELS[package] - {package} - frames - set(sys.stdlib_module_names)
    if package == "studies" and path != ROOT / "studies" / "answers" / "models.py":
        return found & set(MODELS) if set(MODELS) <= found else found & {"tests"}
    return found & {"tests"} if package == "studies" else set()


def _files(*packages: str) -> list[Path]:
    return [path for package in packages for path in sorted((ROOT / package).rglob("*.py"))]


@pytest.mark.parametrize("path", _files(*MODELS, "studies"), ids=lambda path: str(path.relative_to(ROOT)))
def test_file_keeps_the_import_rules(path):
    """A model imports itself and its libraries; of the studies one file alone imports both."""
    assert _breaches(path, path.read_text(encoding="utf-8")) == set()


@pytest.mark.parametrize(
    ("place", "source", "breach"),
    [
        ("spline_model/effects/x.py", "from ..basis import a\nimport_module('studies')", {"studies"}),
        ("fe_reference/x.py", "from spline_model.basis import bernstein", {"spline_model"}),
        ("studies/x.py", "import spline_model\nimport fe_reference", {"spline_model", "fe_reference"}),
    ],
)
def test_breach_is_seen(place, source, breach):
    """The check has teeth: each kind of forbidden import is found, and a relative one stays inside."""
    assert _breaches(ROOT / place, source) == breach


FILES = {
    "studies/__init__.py": "",
    "studies/study.py": '"""What it shows."""\nfrom . import part\n\ndef ask():\n    return part.VALUE\n',
    "studies/part.py": "import spline_model.deep\nVALUE = spline_model.deep.f()\n",
    "studies/other.py": "VALUE = 2\n",
    "studies/apart.py": "VALUE = 3\n",
    "studies/commands/__init__.py": "",
    "studies/commands/solve.py": "import studies.apart\n",
    "spline_model/__init__.py": "from studies import apart\n",
    "spline_model/deep.py": "from spline_model.numbers import HALF\ndef f():\n    from studies import other\n"
    "    return other.VALUE * 1.0\n",
    "spline_model/numbers.py": "HALF = 0.5\n",
    "fe_reference/__init__.py": "",
}


def written(root, changed=None):
    """Write a small repository of its own, with other texts of some files, and return its place."""
    for name, text in {**FILES, **(changed or {})}.items():
        path = root / name
        path.parent.mkdir(exist_ok=True, parents=True)
        path.write_text(text, encoding="utf-8")
    return root


def hash_of(root, changed=None):
    """Return the hash of the study in the small repository."""
    return source_hash("studies.study", root=written(root, changed))


@pytest.mark.parametrize(
    ("name", "old", "new", "counts"),
    [
        ("studies/study.py", "What it shows", "Something else", False),
        ("studies/part.py", "VALUE = spline", "# a remark\n\n\nVALUE = spline", False),
        ("studies/part.py", "f()\n", 'f()\n"""What it is."""\n', False),
        ("spline_model/deep.py", "():\n", '():\n    """Say."""\n', False),
        ("studies/apart.py", "3", "4", False),
        ("studies/study.py", "part.VALUE", "-part.VALUE", True),
        ("studies/part.py", "deep.f()", "deep.f() + 1", True),
        ("spline_model/deep.py", "1.0", "1.5", True),
        ("studies/other.py", "2", "3", True),
        ("spline_model/__init__.py", "apart\n", "apart\nX = 1\n", True),
    ],
)
def test_code_counts_however_far_and_nothing_else(tmp_path, name, old, new, counts):
    """Code of any imported module, or of a package around one, makes a result stale; a docstring, a comment,
    layout, or code that is not imported leaves it fresh."""
    assert old in FILES[name]
    changed = {name: FILES[name].replace(old, new)}
    assert (hash_of(tmp_path / "now", changed) != hash_of(tmp_path / "before")) == counts


@pytest.mark.parametrize("study", sorted(STUDIES))
def test_studies_reach_models_but_neither_commands_nor_the_registry(study):
    """A result depends on a model, and stays fresh when a command or a study is added."""
    modules = reached(STUDIES[study].partition(":")[0])
    assert any(name.startswith(("spline_model.", "fe_reference.")) for name in modules)
    assert not [name for name in modules if name.startswith(("studies.commands", "studies.registry"))]


def test_imports_make_no_circle():
    """No file imports one that imports it, directly or through others, for type checking included."""
    files = [
        path.relative_to(ROOT).with_suffix("") for name in PACKAGES for path in (ROOT / name).rglob("*.py")
    ]
    modules = {".".join(file.parts).removesuffix(".__init__") for file in files}
    TopologicalSorter({name: imported(name, ROOT) for name in modules}).prepare()  # an error names the circle


@pytest.mark.parametrize(
    ("name", "text", "dropped"),
    [
        ("numbers", "HALF = 0.25\n", True),
        ("numbers", '"""A number."""\n\nHALF = 0.5\n', False),
        ("apart", "VALUE = 4.0\n", False),
    ],
)
def test_kernels_of_another_code_are_dropped_once(name, text, dropped, tmp_path):
    """What was compiled of an unknown or of another code is dropped, once; words and code that no kernel sees
    cost no compilation."""
    root, kernel = written(tmp_path / "before"), "spline_model/__pycache__/deep.f-6.py311.1.nbc"
    (root / "spline_model" / "__pycache__").mkdir()
    (root / kernel).write_bytes(b"of an unknown source")
    assert (forget_stale(root), (root / kernel).exists()) == (True, False)
    (root / kernel).write_bytes(b"machine code")
    assert not forget_stale(root)
    changed = tmp_path / "now"  # a process reads each file once
    shutil.copytree(root, changed)
    (changed / "spline_model" / f"{name}.py").write_text(text)
    assert (forget_stale(changed), (changed / kernel).exists()) == (dropped, not dropped)
    assert not forget_stale(changed)


#: The bending moment at the first clamp.
ENTRY = """QUANTITIES = (
    Quantity(
        key="clamp_moment_Nm",
        meaning="bending moment of the first strip at its root",
        of=lambda path: path.bending_moment[:, 0, 0],
    ),
"""
KEY = "clamp_moment_Nm"
SWEEP = """
case = "cross_axis_pivot"
settings.control_points = 6
[vary]
strip.area_m2 = [1e-4, 2e-4]
[store]
quantities = ["torque_Nm", "clamp_moment_Nm"]
"""


@pytest.mark.slow
def test_a_quantity_is_one_entry(tmp_path):
    """Table, JSON, CSV, export, comparison, sweep, picture and docs have a quantity that one entry adds."""
    copy = tmp_path / "copy"
    for name in ("spline_model", "fe_reference", "studies", "docs", "report"):
        shutil.copytree(ROOT / name, copy / name)
    for name in ("README.md", "pyproject.toml"):
        shutil.copy(ROOT / name, copy)
    (copy / "results" / "reference").mkdir(parents=True)
    for name in ("data", "figures"):
        (copy / "results" / name).symlink_to(ROOT / "results" / name)
    place = copy / "studies" / "answers" / "quantities.py"
    text = place.read_text(encoding="utf-8")
    place.write_text(text.replace("QUANTITIES = (\n", ENTRY, 1), encoding="utf-8")
    (tmp_path / "sweep.toml").write_text(SWEEP, encoding="utf-8")

    def run(*words):
        """Return what a command of the copy prints."""
        env = os.environ | {"PYTHONPATH": str(copy)}
        command = [sys.executable, "-m", "studies", *words]
        return subprocess.run(
            command, cwd=tmp_path, env=env, capture_output=True, text=True, check=True
        ).stdout

    case = "cross_axis_pivot"
    run("solve", case, "--csv", "path.csv")
    answer = json.loads(run("solve", case, "--json", "-"))
    assert "clamp moment" in run("solve", case, "--plot", "path.svg")
    assert pd.read_csv(tmp_path / "path.csv")[KEY].tolist() == pytest.approx(answer[KEY])
    assert "clamp moment" in (tmp_path / "path.svg").read_text(encoding="utf-8")
    run("solve", case, "--export", "out")
    assert pd.read_csv(tmp_path / "out" / "static_states.csv")[KEY].iloc[-1] == pytest.approx(answer[KEY][-1])
    assert KEY in next((tmp_path / "out").glob("*_0020.vtu")).read_text(errors="ignore")
    assert any(line.startswith("clamp moment, end") for line in run("compare", case, case).splitlines())
    run("sweep", "sweep.toml", "--out", "swept")
    rows = pd.read_parquet(tmp_path / "swept" / "designs.parquet")
    assert (rows["status"] == "converged").all() and rows[KEY].abs().min() > 0.0
    run("readme")
    assert f"`{KEY}`" in (copy / "docs" / "data.md").read_text(encoding="utf-8")
