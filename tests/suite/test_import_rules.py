"""Who may import whom; the hash of a study follows its imports; kernels of another code are dropped."""

import ast
import shutil
import sys
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

from studies.record.files import forget_stale
from studies.record.source import PACKAGES, ROOT, imported, imports, reached, source_hash
from studies.registry import STUDIES

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
