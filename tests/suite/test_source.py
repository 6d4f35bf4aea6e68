"""The hash of a study follows the code of all that it imports; kernels of another code are dropped."""

import shutil
from graphlib import TopologicalSorter

import pytest

from studies.record.files import forget_stale
from studies.record.source import PACKAGES, ROOT, imported, reached, source_hash
from studies.record.store import inputs
from studies.registry import STUDIES

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


def test_modules_are_reached_by_imports(tmp_path):
    """Imports inside functions count; a package around a module counts, but what only it imports does not."""
    hash_of(tmp_path)
    expected = {"spline_model", "spline_model.deep", "spline_model.numbers"}
    expected |= {"studies", "studies.other", "studies.part", "studies.study"}
    assert set(reached("studies.study", root=tmp_path)) == expected
    assert "studies.apart" in reached("spline_model", root=tmp_path)


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


def test_inputs_name_source_and_cases():
    """A result is made from a hash of its source and one of every case."""
    found = inputs(STUDIES["paper/fig04_trajectory"], ("cross_axis_pivot",))
    assert len(found["source_sha256"]) == 64
    assert list(found["cases"]) == ["cross_axis_pivot"]


def test_unknown_module_is_refused(tmp_path):
    """A module that does not exist is named."""
    with pytest.raises(FileNotFoundError, match=r"studies\.absent"):
        source_hash("studies.absent", root=tmp_path)


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
