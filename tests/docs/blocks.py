"""The code blocks of the pages, and what each kind of block must do in a copy of the checkout.

python   runs, all of a page in one namespace; `print(...)  # text` must print that text. With the name of
         a file as its first line it is written there instead.
toml     is a case or a sweep that its reader accepts, a part of a case behind that of Table 1. With the name
         of a file as its first line it is written there, or, "at its end", added to a file that is no case.
diff     a file's name, a line of that file, and lines with + that are put in after it.
sh       each command succeeds; a text block that follows is the end of what it prints.

A command that draws into `docs/pictures` must draw what is there.
"""

import contextlib
import io
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

from sybil import Document, Example, Region, Sybil
from sybil.parsers.markdown.lexers import FencedCodeBlockLexer

from studies.record.source import ROOT

PAGES = (
    "README.md",
    "CONTRIBUTING.md",
    *sorted(str(path.relative_to(ROOT)) for path in ROOT.glob("docs/*.md")),
)

#: Commands that a page shows and that are not run: what they would need, or where they are run.
NOT_RUN = {
    "make ": "the target must exist; continuous integration runs setup, test-all, lint and docs",
    "python3 -m venv": "as above: setup",
    "python3 -m pip": "tests/suite/test_start_up.py builds and installs the wheel",
    ".venv/bin/python -m pip": "as above: setup",
    "python -m studies interactive": "serves until it is stopped; tests/interactive runs it",
    "python -m studies markers": "needs the extra `interactive`; tests/interactive runs it",
    "python -m studies calibrate": "needs a camera; tests/interactive gives it a film",
    "python -m tests.interactive": "needs the extra `interactive`, or a browser",
    "dask ": "runs until it is ended; tests/sweep runs a scheduler and workers",
    "python -m studies sweep designs.toml --out designs --scheduler": "as above",
    "source ": "the commands run with the environment of the tests",
}

PICTURES = ROOT / "docs" / "pictures"
#: What differs in two files of one picture: names made from its content, and its numbers [pt].
_NAMES, _NUMBERS = re.compile(r'(id|href|clip-path)="[^"]*"'), re.compile(r"-?\d+(?:\.\d+)?")
#: How far a point of a picture may be from where it is shown [pt].
_APART = 0.1

_LANGUAGES = "python|toml|diff|sh|text"
_NAME = re.compile(r"# ([\w/]+\.\w+)( \(at its end\))?\n")
_PROMISE = re.compile(r"\)  # (.*)")


def examples(page: str) -> list[Example]:
    """Return the code blocks of a page, in order, as Sybil finds them."""
    return list(Sybil(parsers=[_blocks], path=str(ROOT)).parse(ROOT / page).examples())


def lines(page: str) -> Iterator[str]:
    """Yield the commands of the sh blocks of a page."""
    for example in examples(page):
        language, source = example.parsed
        if language == "sh":
            yield from commands(source)


def commands(source: str) -> list[str]:
    """Return the commands of an sh block, those that go on after a backslash in one."""
    return [line for line in source.replace("\\\n", " ").splitlines() if line and not line.startswith("#")]


def checkout(folder: Path) -> Path:
    """Return a copy of this checkout in `folder`, compiled kernels included, this Python as its .venv."""
    hidden = shutil.ignore_patterns(".*", "_build", "*.egg-info")
    copy = shutil.copytree(ROOT, folder / "checkout", ignore=hidden)
    (copy / ".venv").symlink_to(sys.prefix)
    return copy


def other_pictures(copy: Path) -> list[str]:
    """Return the pictures of the pages that are drawn otherwise in a copy of the checkout."""
    return [
        made.name
        for made in sorted((copy / "docs" / "pictures").glob("*.svg"))
        if not _alike(made.read_text(encoding="utf-8"), (PICTURES / made.name).read_text(encoding="utf-8"))
    ]


def _alike(made: str, shown: str) -> bool:
    made, shown = (_NAMES.sub("", text) for text in (made, shown))
    numbers, others = (list(map(float, _NUMBERS.findall(text))) for text in (made, shown))
    apart = max((abs(a - b) for a, b in zip(numbers, others, strict=False)), default=0.0)
    return _NUMBERS.sub("", made) == _NUMBERS.sub("", shown) and apart < _APART


class Runner:
    """Runs the blocks of one page in a copy of the checkout."""

    def __init__(self, copy: Path) -> None:
        self.copy = copy
        self.printed: str | None = None

    def run(self, example: Example) -> None:
        """Run one block; AssertionError or the block's own exception where it does not do what it must."""
        language, source = example.parsed
        getattr(self, f"_{language}")(str(source), example.namespace)

    def _python(self, source: str, namespace: dict[str, object]) -> None:
        if self._written(source):
            return
        heard = io.StringIO()
        with contextlib.redirect_stdout(heard), contextlib.chdir(self.copy):
            exec(compile(source, "block", "exec"), namespace)
        self._promised(_PROMISE.findall(source), heard.getvalue().splitlines())

    def _toml(self, source: str, namespace: dict[str, object]) -> None:
        whole = re.search(r"^(\[strip\]|\[\[strips\]\]|case = )", source, re.MULTILINE)
        table_1 = (ROOT / "studies" / "cases" / "cross_axis_pivot.toml").read_text(encoding="utf-8")
        path = self._written(source) or self.copy / "block.toml"
        if "(at its end)" in source:
            return
        path.write_text(source if whole else f"{table_1}\n{source}", encoding="utf-8")
        sweep = "[vary]" in source
        reader = "sweep.plan import read_plan" if sweep else "cases.design import read_design"
        read = f"from studies.{reader} as read; read({path.name!r})"
        self._command(f'python -c "{read}"')

    def _diff(self, source: str, namespace: dict[str, object]) -> None:
        name = _NAME.match(source)
        assert name, f"a diff without a file: {source}"
        path = self.copy / name[1]
        text = path.read_text(encoding="utf-8")
        context = ""
        for line in source[name.end() :].splitlines():
            if line.startswith("+"):
                text = text.replace(context, f"{context}{line[1:]}\n")
                context += f"{line[1:]}\n"
            else:
                context = f"{line[1:]}\n"
                assert text.count(context) == 1, f"{name[1]}: {context!r} is not there once"
        path.write_text(text, encoding="utf-8")

    def _sh(self, source: str, namespace: dict[str, object]) -> None:
        self.printed = ""
        for line in commands(source):
            if not line.startswith(tuple(NOT_RUN)):
                self.printed += self._command(line)

    def _command(self, line: str) -> str:
        path = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])
        surroundings = {**os.environ, "PATH": path, "PYTHONPATH": str(self.copy), "MPLBACKEND": "Agg"}
        words = ["bash", "-o", "pipefail", "-c", line]
        done = subprocess.run(words, cwd=self.copy, env=surroundings, capture_output=True, text=True)
        assert done.returncode == 0, f"{line}\nexit code {done.returncode}\n{done.stderr}"
        return done.stdout

    def _text(self, source: str, namespace: dict[str, object]) -> None:
        if self.printed is not None:
            wanted = [line.strip() for line in source.splitlines()]
            printed = [line.strip() for line in self.printed.splitlines()]
            assert printed[-len(wanted) :] == wanted
        self.printed = None

    def _written(self, source: str) -> Path | None:
        """Return the file that a block is written to, if it names one."""
        name = _NAME.match(source)
        if not name:
            return None
        path = self.copy / name[1]
        before = path.read_text(encoding="utf-8") + "\n" if name[2] else ""
        path.write_text(before + source[name.end() :], encoding="utf-8")
        return path

    def _promised(self, promises: list[str], printed: list[str]) -> None:
        rest = iter(printed)
        for promise in promises:
            assert promise in rest, f"not printed, or not in this order: {promise}\n" + "\n".join(printed)


def _blocks(document: Document) -> Iterator[Region]:
    """Yield the fenced blocks of the languages above (a parser for Sybil)."""
    for language in _LANGUAGES.split("|"):
        for region in FencedCodeBlockLexer(language)(document):
            region.parsed = (language, region.lexemes["source"])
            region.evaluator = lambda example: None
            yield region
