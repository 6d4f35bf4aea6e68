"""The hash of a study's source changes with its code and with nothing else."""

import pytest

from studies.record.source import closure, source_hash

FILES = {
    "studies/__init__.py": "",
    "studies/study.py": '"""What it shows."""\nfrom . import part\n\ndef compute():\n    return part.VALUE\n',
    "studies/part.py": "import spline_model.deep\nVALUE = 1\n",
    "studies/other.py": "VALUE = 2\n",
    "spline_model/__init__.py": "",
    "spline_model/deep.py": "def f():\n    from studies import other\n    return 1.0\n",
}


@pytest.fixture
def root(tmp_path):
    """A small repository."""
    for name, text in FILES.items():
        path = tmp_path / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(text, encoding="utf-8")
    return tmp_path


def test_closure_follows_every_import(root):
    """The source of a study is all it imports: relatively, through other modules, inside functions."""
    assert closure("studies.study", root=root) == [
        "spline_model",
        "spline_model.deep",
        "studies",
        "studies.other",
        "studies.part",
        "studies.study",
    ]


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("studies/study.py", FILES["studies/study.py"].replace("What it shows", "Something else")),
        ("studies/part.py", "# a remark\nimport   spline_model.deep\n\n\nVALUE = 1  # another\n"),
        ("studies/part.py", 'import spline_model.deep\n\nVALUE = 1\n"""What it is."""\n'),
        (
            "spline_model/deep.py",
            FILES["spline_model/deep.py"].replace("():\n", '():\n    """Say so."""\n', 1),
        ),
    ],
)
def test_hash_ignores_docstrings_comments_and_layout(root, name, text):
    """Editing docstrings, comments or layout does not make a result stale."""
    before = source_hash("studies.study", root=root)
    (root / name).write_text(text, encoding="utf-8")
    assert source_hash("studies.study", root=root) == before


@pytest.mark.parametrize(
    ("name", "old", "new"),
    [
        ("studies/study.py", "part.VALUE", "-part.VALUE"),
        ("studies/part.py", "VALUE = 1", "VALUE = 1.0"),
        ("spline_model/deep.py", "1.0", "1.5"),
        ("studies/other.py", "2", "3"),
    ],
)
def test_hash_sees_code_however_far(root, name, old, new):
    """Editing code that a study depends on, directly or not, makes its result stale."""
    before = source_hash("studies.study", root=root)
    path = root / name
    path.write_text(path.read_text(encoding="utf-8").replace(old, new), encoding="utf-8")
    assert source_hash("studies.study", root=root) != before


def test_unknown_module_is_refused(root):
    """A module that does not exist has no source: it is named."""
    with pytest.raises(FileNotFoundError, match=r"studies\.absent"):
        source_hash("studies.absent", root=root)
