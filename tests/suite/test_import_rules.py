"""The models see nothing of this repository but themselves, and of the studies one file sees both."""

import ast
import sys
from pathlib import Path

import pytest

from studies.record.source import ROOT, imports

MODELS = {
    "spline_model": {"numpy", "scipy", "numba"},
    "fe_reference": {"numpy", "scipy", "numba", "skfem"},
}
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
