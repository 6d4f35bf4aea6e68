"""Pages, help and texts of the studies use plain English; README and how-to guides have short sentences."""

import ast
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
    r"\blets? (it |the \w+ )?go\b": "release",
    r"\blet go\b": "released",
    r"\bnowhere\b": "never",
    r"\bsays so\b": "prints a message",
    r"\bthe reference pivot\b": "the benchmark pivot",
    r"\bwaited for\b": "end-to-end time",
    r"\bleft out\b": "neglected",
    r"\bleaves out\b": "neglects",
}
#: Pages that are written in the rules of today, outside code and written tables.
PLAIN = (
    "README.md",
    *(f"docs/{name}.md" for name in ("how_to", "first_hour", "design_a_pivot", "four_designs")),
)
PLAIN += tuple(f"docs/{name}.md" for name in ("findings", "limits", "messages", "numerics", "glossary"))
#: Pages whose sentences are at most so many words long.
SHORT, LONGEST = ("README.md", "docs/how_to.md"), 30


def prose(page: str) -> str:
    """Return the text of a page without code blocks, tables, links and headings."""
    text = (ROOT / page).read_text(encoding="utf-8")
    text = re.sub(r"^```.*?^```$", "", text, flags=re.MULTILINE | re.DOTALL)
    text = re.sub(r"^(\||#|!\[|<!--|    ).*$", "", text, flags=re.MULTILINE)
    return re.sub(r"\]\([^)]*\)", "]", text)


def test_pages_are_there():
    """Every page of the lists exists."""
    assert set(PLAIN) <= set(blocks.PAGES)


def replaced(text: str) -> dict[str, str]:
    """Return the words of a text that the glossary or plain English replaces, with the standard ones."""
    return {word[0]: better for pattern, better in REPLACED.items() for word in re.finditer(pattern, text)}


@pytest.mark.parametrize("page", PLAIN)
def test_words_are_standard_terms(page):
    """No page has a word that the glossary or plain English replaces."""
    assert replaced(prose(page)) == {}


def sources() -> list[Path]:
    """Return the modules whose strings follow these rules."""
    files = (ROOT / "studies").rglob("*.py")
    return [path for path in sorted(files) if not {"interactive", "published"} & set(path.parts)]


def test_help_messages_and_docstrings_use_standard_terms():
    """No string of the studies, be it help, message or docstring, has a replaced word."""
    found = {}
    for path in sources():
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            text = node.value if isinstance(node, ast.Constant) else None
            if isinstance(text, str) and (words := replaced(" ".join(text.split()))):
                found[f"{path.relative_to(ROOT)}:{node.lineno}"] = words
    assert found == {}


@pytest.mark.parametrize("page", SHORT)
def test_sentences_are_short(page):
    """A sentence of README and of the how-to guides has at most 30 words."""
    paragraphs = re.split(r"\n\s*\n|\n- ", prose(page))
    sentences = [each for part in paragraphs for each in re.split(r"(?<=[.:?!;])\s+", " ".join(part.split()))]
    assert [each for each in sentences if len(each.split()) > LONGEST] == []
