"""Compiled kernels on the disk are dropped when their code has changed, and only then."""

import shutil

import pytest

from studies.record.files import forget_stale

SOURCES = {
    "spline_model/__init__.py": "",
    "spline_model/numbers.py": '"""Numbers."""\n\nHALF = 0.5\n',
    "spline_model/kernel.py": "from numba import njit\nfrom spline_model.numbers import HALF\n\n\n"
    "@njit(cache=True)\ndef halved(x):\n    return HALF * x\n",
    "spline_model/apart.py": "from numba import njit\n\n\n@njit\ndef same(x):\n    return x\n",
    "spline_model/plain.py": "THIRD = 1.0 / 3.0\n",
    "fe_reference/__init__.py": "",
}


@pytest.fixture
def root(tmp_path):
    """A checkout of six files whose kernel was compiled, and marked."""
    for name, text in SOURCES.items():
        path = tmp_path / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(text)
    forget_stale(tmp_path)
    compiled(tmp_path).write_bytes(b"machine code")
    return tmp_path


def compiled(root):
    """Return what stands for the compiled kernel."""
    return root / "spline_model" / "__pycache__" / "kernel.halved-6.py311.1.nbc"


def changed(root, name, old, new):
    """Return a copy of the checkout with one file changed: a process reads each file once."""
    copy = root.with_name(f"{root.name}_changed")
    shutil.copytree(root, copy)
    path = copy / "spline_model" / name
    path.write_text(path.read_text().replace(old, new))
    return copy


def test_kernels_of_the_present_source_stay(root):
    """Requirement: nothing is dropped while nothing has changed."""
    assert not forget_stale(root)
    assert compiled(root).exists()


@pytest.mark.parametrize(
    ("name", "old", "new", "dropped"),
    [
        ("numbers.py", "0.5", "0.25", True),
        ("kernel.py", "HALF * x", "HALF * x * x", True),
        ("numbers.py", "Numbers.", "A number.", False),
        ("plain.py", "3.0", "4.0", False),
        ("apart.py", "return x", "return -x", False),
    ],
    ids=["a constant of another module", "the kernel", "a docstring", "no kernel's module", "another kernel"],
)
def test_kernels_of_another_code_are_dropped_once(root, name, old, new, dropped):
    """Requirement: a change of the kernel's code, or of what it imports, drops it, and the next look does
    not; words, and code that no kernel sees, cost no compilation."""
    root = changed(root, name, old, new)
    assert forget_stale(root) == dropped
    assert compiled(root).exists() != dropped
    assert not forget_stale(root)


def test_kernels_of_an_unknown_source_are_dropped(root):
    """Requirement: without a mark nobody knows what they were compiled from."""
    (root / "spline_model" / "__pycache__" / "kernels.json").unlink()
    assert forget_stale(root)
    assert not compiled(root).exists()
