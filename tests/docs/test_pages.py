"""Texts: blocks of pages work as written, words are standard terms, the API reference is whole."""

import ast
import doctest
import inspect
import json
import re
import shlex
import subprocess
import sys
import tomllib
import zlib
from collections.abc import Iterator
from pathlib import Path

import matplotlib
import pytest

import fe_reference
import spline_model
import studies
from studies.record.source import ROOT
from studies.registry import COMMANDS
from tests.docs import blocks

#: Fences that Sphinx alone reads.
SPHINX = ("{toctree}", "{include} ../README.md", "{include} ../CONTRIBUTING.md")
LINK = re.compile(r"\]\((?!https?:)([^)#\s]*)(?:#([\w-]+))?\)")


@pytest.mark.slow
@pytest.mark.parametrize("page", blocks.PAGES)
def test_blocks_of_a_page_work_in_their_order(page, tmp_path):
    """All blocks of a page do what `blocks` says of their kind, in order in one copy of the checkout, and
    draw the pictures that the page shows."""
    runner = blocks.Runner(blocks.checkout(tmp_path))
    for example in blocks.examples(page):
        try:
            runner.run(example)
        except Exception as error:
            raise AssertionError(f"{page}:{example.line}: {error}") from error
    assert blocks.other_pictures(runner.copy) == []


@pytest.mark.parametrize("page", blocks.PAGES)
def test_blocks_can_be_read(page):
    """Python compiles, TOML parses, and no fence is of a kind that nothing checks."""
    for example in blocks.examples(page):
        language, source = example.parsed
        if language == "python":
            ast.parse(source)
        if language == "toml":
            tomllib.loads(source)
    text = (ROOT / page).read_text(encoding="utf-8")
    kinds = [kind for kind in re.findall(r"^ *```(.*)$", text, re.MULTILINE)[::2] if kind not in SPHINX]
    assert kinds == [example.parsed[0] for example in blocks.examples(page)]


@pytest.mark.parametrize("page", blocks.PAGES)
def test_commands_that_are_shown_exist(page):
    """`make` would run the targets, and every command of `python -m studies` is registered."""
    for line in blocks.lines(page):
        words = shlex.split(line)
        if words[0] == "make":
            subprocess.run(["make", "--dry-run", *words[1:]], cwd=ROOT, capture_output=True, check=True)
        elif words[1:3] == ["-m", "studies"]:
            assert words[3] in COMMANDS, line
        elif words[0] not in ("cp", "dask", "source", "python3", ".venv/bin/python", "python"):
            pytest.fail(f"{page}: {line}")


@pytest.mark.parametrize("page", blocks.PAGES)
def test_tables_end_before_the_text(page):
    """An empty line follows each table: without it the next line of text is drawn as a row."""
    text = (ROOT / page).read_text(encoding="utf-8")
    assert re.findall(r"^\|.*\n(?![|\n]).+", text, re.MULTILINE) == []


@pytest.mark.parametrize("page", blocks.PAGES)
def test_links_lead_somewhere(page):
    """Files that a page links to or shows are there, and so are the headings."""
    text = (ROOT / page).read_text(encoding="utf-8")
    for name, heading in LINK.findall(text):
        target = (ROOT / page).parent / name if name else ROOT / page
        assert target.exists(), f"{page}: {name}"
        if heading:
            titles = re.findall(r"^#+ (.*)$", target.read_text(encoding="utf-8"), re.MULTILINE)
            assert heading in [re.sub(r"[^\w -]", "", title).lower().replace(" ", "-") for title in titles]


NOTEBOOK = ROOT / "docs" / "designers_hour.ipynb"


@pytest.mark.slow
def test_notebook_runs_and_its_design_meets_the_requirement(monkeypatch, tmp_path, capsys):
    """Requirement: all cells run in order; their assertions hold for a design that is not the first one."""
    matplotlib.use("agg")
    monkeypatch.chdir(tmp_path)
    cells = [cell for cell in json.loads(NOTEBOOK.read_text("utf-8"))["cells"] if cell["cell_type"] == "code"]
    assert len(cells) >= 8
    names: dict[str, object] = {}
    for cell in cells:
        assert (cell["outputs"], cell["execution_count"]) == ([], None), "clear the outputs before a commit"
        exec("".join(cell["source"]), names)
    assert names["ratio"] != 0.5
    assert names["path"].stiffness[0] == pytest.approx(names["STIFFNESS"], rel=0.02)
    assert "torque of the finite elements" in capsys.readouterr().out


#: Word or phrase -> the standard one.
REPLACED = {
    r"\banew\b": "again",
    r"\bbettered\b": "improved",
    r"\bfurthest off\b": "largest deviation",
    r"\bin print\b": "published",
    r"\b[Ll]ets? (it |the \w+ )?go\b": "release",
    r"(?<!/)\bnowhere\b": "never",
    r"\bsays? so\b": "prints a message",
    r"\bshall\b": "must",
    r"\bin silence\b": "without a message",
    r"\bthe reference pivot\b": "the benchmark pivot",
    r"\bwaited for\b": "end-to-end time",
    r"\b[Ll]eft out\b": "neglected",
    r"\b[Ll]eaves? out\b": "neglects",
    r"\bwhat (a|an|the) [a-z]+ (leaves?|makes?|takes?|holds?|asks?)\b": "a noun",
}
#: Folders whose texts follow these rules: docstrings, comments, help, messages and the text of the report.
FOLDERS = ("docs", "fe_reference", "report", "spline_model", "studies", "tests")
ENDINGS = {".md", ".py", ".typ", ".toml", ".html", ".js"}
#: Pages whose sentences are at most so many words long.
SHORT, LONGEST = ("README.md", "docs/how_to.md"), 30


def prose(page: str) -> str:
    """Return the text of a page without code blocks, tables, links and headings."""
    text = (ROOT / page).read_text(encoding="utf-8")
    text = re.sub(r"^```.*?^```$", "", text, flags=re.MULTILINE | re.DOTALL)
    text = re.sub(r"^(\||#|!\[|<!--|    ).*$", "", text, flags=re.MULTILINE)
    return re.sub(r"\]\([^)]*\)", "]", text)


def replaced(text: str) -> dict[str, str]:
    """Return the words of a text that the glossary or plain English replaces, with the standard ones."""
    return {word[0]: better for pattern, better in REPLACED.items() for word in re.finditer(pattern, text)}


@pytest.mark.parametrize("page", blocks.PAGES)
def test_words_are_standard_terms(page):
    """No page has a word that the glossary or plain English replaces."""
    assert replaced(prose(page)) == {}


def flat(path: Path) -> str:
    """Return the text of a file as one line, without the marks of comments at the begin of its lines."""
    return " ".join(re.sub(r"\n\s*(#:?|//)", "\n", path.read_text(encoding="utf-8")).split())


def test_sources_use_standard_terms():
    """No docstring, comment, help, message or text of the report has a replaced word."""
    files = [path for folder in FOLDERS for path in sorted((ROOT / folder).rglob("*"))]
    files = [path for path in files if path.suffix in ENDINGS and "_build" not in path.parts]
    found = {str(path.relative_to(ROOT)): replaced(flat(path)) for path in files if path != Path(__file__)}
    assert {path: words for path, words in found.items() if words} == {}


@pytest.mark.parametrize("page", SHORT)
def test_sentences_are_short(page):
    """A sentence of README and of the how-to guides has at most 30 words."""
    paragraphs = re.split(r"\n\s*\n|\n- ", prose(page))
    sentences = [each for part in paragraphs for each in re.split(r"(?<=[.:?!;])\s+", " ".join(part.split()))]
    assert [each for each in sentences if len(each.split()) > LONGEST] == []


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
