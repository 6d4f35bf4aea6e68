"""Texts use plain English and the terms of the glossary; README and how-to guides have short sentences."""

import re
from pathlib import Path

import pytest

from studies.record.source import ROOT
from tests.docs import blocks

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
