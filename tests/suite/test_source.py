"""The hash of a study's source changes with the code that the study reaches and with nothing else."""

import inspect
import sys
from pathlib import Path

import pytest

from studies.record.definitions import PACKAGES
from studies.record.source import ROOT, WITHOUT_INFLUENCE, reached, source_hash
from studies.record.store import inputs
from studies.registry import STUDIES, study_of

FILES = {
    "studies/__init__.py": "",
    "studies/study.py": '"""What it shows."""\nfrom . import part\n\ndef compute():\n    return part.VALUE\n',
    "studies/shape.py": (
        "class Shape:\n    size = 1\n\n    def __init__(self):\n        self.x = 2\n\n"
        "    def area(self):\n        return 3\n\n    def edge(self):\n        return 4\n"
    ),
    "studies/drawn.py": "from studies.shape import Shape\nAREA = Shape().area()\n",
    "studies/part.py": "import spline_model.deep\nVALUE = spline_model.deep.f()\nBESIDE = 5\n",
    "studies/other.py": "VALUE = 2\n",
    "spline_model/__init__.py": "",
    "spline_model/deep.py": "def f():\n    from studies import other\n    return other.VALUE * 1.0\n",
    "spline_model/effects/__init__.py": "",
    "spline_model/effects/registry.py": (
        'from . import own\nREGISTRY = {"bending": own.bent, "spring": own.drawn}\n'
    ),
    "spline_model/effects/own.py": "def bent(x):\n    return x\n\n\ndef drawn(x):\n    return 7 * x\n",
    "studies/scene.py": (
        "from spline_model.effects.registry import REGISTRY\n\ndef build(names):\n"
        "    return [REGISTRY[name](1.0) for name in names]\n"
    ),
}


@pytest.fixture
def root(tmp_path):
    """A small repository."""
    for name, text in FILES.items():
        path = tmp_path / name
        path.parent.mkdir(exist_ok=True, parents=True)
        path.write_text(text, encoding="utf-8")
    return tmp_path


def edit(root, name, old, new):
    """Change a file of the small repository."""
    path = root / name
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new), encoding="utf-8")


def test_a_study_reaches_what_it_names(root):
    """Names lead from a study to its source: through modules and packages, and imports inside functions."""
    assert reached("studies.study", root=root) == [
        "spline_model.deep:",
        "spline_model.deep:f",
        "spline_model:",
        "studies.other:",
        "studies.other:VALUE",
        "studies.part:",
        "studies.part:VALUE",
        "studies.study:",
        "studies.study:compute",
        "studies:",
    ]


@pytest.mark.parametrize(
    ("name", "old", "new"),
    [
        ("studies/part.py", "BESIDE = 5", "BESIDE = 6"),
        ("studies/part.py", "BESIDE = 5", "BESIDE = 5\n\ndef more():\n    return BESIDE"),
        ("spline_model/effects/own.py", "return x", "return 2 * x"),
    ],
)
def test_what_a_study_does_not_name_leaves_it_alone(root, name, old, new):
    """A command or a constant that stands beside, or is added, does not make a result stale."""
    before = source_hash("studies.study", root=root)
    edit(root, name, old, new)
    assert source_hash("studies.study", root=root) == before


@pytest.mark.parametrize(
    ("said", "name", "old", "new", "same"),
    [
        ("bending", "spline_model/effects/own.py", "7 * x", "8 * x", True),
        ("bending spring", "spline_model/effects/own.py", "7 * x", "8 * x", False),
        (None, "spline_model/effects/own.py", "7 * x", "8 * x", False),
        ("bending", "spline_model/effects/own.py", "return x", "return -x", False),
        ("bending", "spline_model/effects/registry.py", "own.drawn}", 'own.drawn, "drag": own.drawn}', True),
        ("drag", "spline_model/effects/registry.py", "own.drawn}", 'own.drawn, "drag": own.drawn}', False),
    ],
)
def test_an_effect_concerns_the_scenes_that_name_it(root, said, name, old, new, same):
    """An effect that is added or changed makes those results stale whose case or code says its name."""
    before = source_hash("studies.scene", said=said, root=root)
    edit(root, name, old, new)
    assert (source_hash("studies.scene", said=said, root=root) == before) == same


def test_code_that_says_the_name_counts_as_a_case_does(root):
    """A study that names an effect in its own code depends on it, whatever its cases say."""
    edit(root, "studies/scene.py", "def build(names):", 'SCENE = ("spring",)\n\ndef build(names=SCENE):')
    before = source_hash("studies.scene", said="", root=root)
    edit(root, "spline_model/effects/own.py", "7 * x", "8 * x")
    assert source_hash("studies.scene", said="", root=root) != before


@pytest.mark.parametrize("study", sorted(STUDIES))
def test_studies_reach_models_and_no_command(study):
    """What a study of today reaches is a model's laws and no command."""
    places = reached(STUDIES[study])
    assert any(place.startswith(("spline_model", "fe_reference")) for place in places)
    assert not [place for place in places if place.startswith("studies.commands")]


def test_studies_of_one_module_depend_on_what_each_reaches():
    """A study that is a constant of its module does not depend on what only the module's other one names."""
    rotation, slenderness = (
        set(reached(STUDIES[f"stability/{name}"])) for name in ("rotation", "slenderness")
    )
    own = {"studies.stability.paths:ROTATION", "studies.stability.paths:_critical"}
    assert own <= rotation and not own & slenderness
    assert "studies.stability.family:outcomes_of" in rotation & slenderness


@pytest.mark.parametrize(
    ("old", "new", "same"),
    [
        ("return 4", "return 5", True),
        ("return 3", "return 5", False),
        ("self.x = 2", "self.x = 3", False),
        ("size = 1", "size = 5", False),
    ],
)
def test_methods_count_where_they_are_called(root, old, new, same):
    """Of a class counts what every object has, and the methods whose name is said."""
    before = source_hash("studies.drawn", root=root)
    edit(root, "studies/shape.py", old, new)
    assert (source_hash("studies.drawn", root=root) == before) == same


def ran(ask, *points):
    """Return the functions of this repository that run while a question is asked: module and place in it."""
    codes = set()
    former = sys.getprofile()
    sys.setprofile(lambda frame, event, _: codes.add(frame.f_code) if event == "call" else None)
    try:
        ask(*points)
    finally:
        sys.setprofile(former)
    files = {code: Path(code.co_filename) for code in codes}
    inside = {code: file.relative_to(ROOT) for code, file in files.items() if file.is_relative_to(ROOT)}
    return {
        (".".join(file.with_suffix("").parts).removesuffix(".__init__"), code.co_qualname)
        for code, file in inside.items()
        if file.parts[0] in PACKAGES and is_function(code)
    }


def is_function(code):
    """Return whether code is called, and is neither a module or class on import nor a constant's own."""
    return code.co_flags & inspect.CO_OPTIMIZED and not code.co_qualname.startswith("<")


def place_of(module, name):
    """Return the place of the definition that a function stands in."""
    first, _, rest = name.partition(".")
    method = rest.partition(".")[0]
    if first.startswith("__"):
        return f"{module}:"
    return (
        f"{module}:{first}[{method}]"
        if method and not method.startswith(("__", "<"))
        else f"{module}:{first}"
    )


@pytest.mark.slow
@pytest.mark.parametrize(
    "study",
    ["paper/fig06_release", "convergence/frequency", "stability/buckling", "impulses/step_size"],
)
def test_what_runs_is_reached(study):
    """Every function that runs for a study's first question is of the source that its result depends on."""
    part = study_of(study).parts[0]
    run = ran(part.answer, next(iter(part.at())))
    places = {place_of(*at) for at in run if not at[0].startswith(WITHOUT_INFLUENCE)}
    assert len(places) > 100
    missed = places - set(reached(STUDIES[study], said=""))
    assert not missed


def test_inputs_name_source_and_cases():
    """What a result is made from is a hash of its source and one of every case."""
    found = inputs(STUDIES["paper/fig04_trajectory"], ("cross_axis_pivot",))
    assert len(found["source_sha256"]) == 64
    assert list(found["cases"]) == ["cross_axis_pivot"]


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("studies/study.py", FILES["studies/study.py"].replace("What it shows", "Something else")),
        (
            "studies/part.py",
            "# a remark\nimport   spline_model.deep\n\n\nVALUE = spline_model.deep.f()  # another\n",
        ),
        ("studies/part.py", 'import spline_model.deep\n\nVALUE = spline_model.deep.f()\n"""What it is."""\n'),
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
        ("studies/part.py", "deep.f()", "deep.f() + 1"),
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
