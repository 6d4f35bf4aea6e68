"""The API reference is complete and built without a warning; docstrings have their sections, examples run."""

import ast
import doctest
import inspect
import re
import subprocess
import sys
import zlib
from collections.abc import Iterator

import pytest

import fe_reference
import spline_model
import studies
from studies.record.source import ROOT

MODELS = ("spline_model", "fe_reference")
LISTED = re.compile(r"^\.\. automodule:: (\S+)$", re.MULTILINE)


def modules(package):
    """The public modules of a package by name, with their files."""
    found = {}
    for path in sorted((ROOT / package).rglob("*.py")):
        parts = path.relative_to(ROOT).with_suffix("").parts
        name = ".".join(parts[:-1] if parts[-1] == "__init__" else parts)
        if not any(part.startswith("_") for part in name.split(".")):
            found[name] = path
    return found


def listed(package):
    """The modules that the pages of a package show."""
    pages = (ROOT / "docs" / "api" / package).glob("*.rst")
    return [name for page in pages for name in LISTED.findall(page.read_text(encoding="utf-8"))]


def public(node, prefix) -> Iterator[tuple[str, ast.AST]]:
    """Public classes, functions and methods in a syntax tree, with their full names."""
    for child in node.body:
        if isinstance(child, ast.ClassDef | ast.FunctionDef) and not child.name.startswith("_"):
            yield f"{prefix}.{child.name}", child
            if isinstance(child, ast.ClassDef):
                yield from public(child, f"{prefix}.{child.name}")


@pytest.mark.parametrize("package", MODELS)
def test_every_module_of_a_model_is_on_one_page(package):
    """The pages show the public modules, each once, and none that is not there."""
    names = listed(package)
    assert len(set(names)) == len(names)
    assert set(names) == set(modules(package))


@pytest.mark.parametrize("package", MODELS)
def test_everything_public_of_a_model_has_a_docstring(package):
    """Every public module, class, function and method says what it is."""
    trees = {name: ast.parse(path.read_text(encoding="utf-8")) for name, path in modules(package).items()}
    named = [*trees.items(), *(each for module, tree in trees.items() for each in public(tree, module))]
    assert [name for name, node in named if not ast.get_docstring(node)] == []


@pytest.mark.slow
def test_reference_is_built_without_a_warning(tmp_path):
    """`make docs` succeeds, warnings being errors, and shows everything public of the models."""
    words = ["-m", "sphinx", "-W", "--keep-going", "-n", "-q", "docs", str(tmp_path / "html")]
    done = subprocess.run([sys.executable, *words], cwd=ROOT, capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")
    packed = (tmp_path / "html" / "objects.inv").read_bytes().split(b"\n", 4)[4]
    shown = {
        line.split(" py:")[0] for line in zlib.decompress(packed).decode().splitlines() if " py:" in line
    }
    for package in MODELS:
        for module, path in modules(package).items():
            tree = ast.parse(path.read_text(encoding="utf-8"))
            assert {name for name, _ in public(tree, module)} - shown == set()


FACADES = (spline_model, fe_reference, studies)
#: Classes that a user makes, beside those that functions return.
INPUTS = ("BodyDesign", "DrivenDisplacement", "DrivenRotation", "HeldPivot", "SolidStrip", "StripDesign")
FUNCTIONS = {
    f"{package.__name__}.{name}": getattr(package, name)
    for package in FACADES
    for name in sorted(package.__all__, key=lambda name: (name not in ("cross_axis_pivot", "plot"), name))
    if inspect.isfunction(getattr(package, name)) or name in INPUTS
}
#: Sections that each of them has.
SECTIONS = ("Parameters", "Examples")
#: Those without a refusal of their own, and those that rest on no publication.
NO_RAISES = ("spline_model.plate_factors", "spline_model.motion_penalty_stiffness")
NO_SOURCE = ("plot", "overlay", "BodyDesign", "StripDesign")


@pytest.mark.parametrize("name", FUNCTIONS)
def test_docstring_has_every_section_and_parameter(name):
    """Requirement: parameters, all of them, return value, errors, source and an example."""
    function = FUNCTIONS[name]
    text = inspect.getdoc(function)
    wanted = {*SECTIONS, *(["Raises"] if name not in NO_RAISES else [])}
    wanted |= {"References"} if name.partition(".")[2] not in NO_SOURCE else set()
    wanted |= {"Returns"} if inspect.isfunction(function) else set()
    assert wanted - set(re.findall(r"^(\w+)\n-+$", text, re.MULTILINE)) == set()
    listed = re.split(r"\n(?:Returns|Raises)\n", text.partition("Parameters\n----------\n")[2])[0]
    entries = ", ".join(re.findall(r"^([\w, ]+?)(?: : .*)?$", listed, re.MULTILINE)).split(", ")
    assert set(inspect.signature(function).parameters) - set(entries) == set()


@pytest.mark.parametrize("package", FACADES, ids=lambda package: package.__name__)
def test_examples_run(package):
    """Requirement: the examples of a package run in one session, that of the pivot first."""
    names = {name: getattr(package, name) for name in package.__all__}
    finder, runner = doctest.DocTestFinder(recurse=False), doctest.DocTestRunner()
    for name in sorted(names, key=lambda name: (name not in ("cross_axis_pivot", "plot"), name)):
        if inspect.isfunction(names[name]) or inspect.isclass(names[name]):
            (example,) = finder.find(names[name], name, globs=names)
            assert example.examples or inspect.isclass(names[name]), name
            example.globs = names
            assert runner.run(example, clear_globs=False).failed == 0, name
    assert runner.summarize(verbose=False).attempted >= 3
