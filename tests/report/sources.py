"""The sections as the tests read them: prose without what may hold digits, the names they quote; results."""

import re

import pandas as pd

from studies.record.source import ROOT

FOLDER = ROOT / "report"
SECTIONS = sorted((FOLDER / "sections").glob("*.typ"))

#: Digits that are names: of the paper's numbered parts, and units of a space.
_NUMBER = r"\d+(?:\.\d+)?(?:\s*(?:–|,|and|to|a|c)\s*\d+)*"
NAMES = rf"\b(?:Eqs?|Figs?|Sec|section|Table|body|Part)\s{_NUMBER}"
#: Wholes that quote the paper, or are the definition of a measure.
QUOTED = (
    "1/100 s",
    "25 pictures",
    "95th percentile",
    "1/4",
    "4-point",
    "19 degrees",
    "19 coordinates",
    "m²",
    "m⁴",
)


def text(path) -> str:
    """Return a source without comments."""
    return re.sub(r"(?m)^\s*//.*$", "", path.read_text(encoding="utf-8"))


def prose(source: str) -> str:
    """Return what a reader reads of a source: no mathematics, no names of facts, no lengths."""
    source = re.sub(r"(?s)\$.*?\$", " ", source)
    source = re.sub(r"(?s)```.*?```", " ", source)
    source = re.sub(r"#equation\[[^\]]*\]", " ", source)
    source = re.sub(r"<[\w-]+>|@[\w-]+", " ", source)
    source = re.sub(r'#import "[^"]*"|#include "[^"]*"', " ", source)
    source = re.sub(r'(?:fact|see|seetable|plot|listing|supported)\("[^"]*"', " ", source)
    source = re.sub(
        r'"\w+_\w+"|slice\(0, \d+\)|update\(0\)|rgb\("#\w+"\)|"S1"|level: 2|len\(\) > 0', " ", source
    )
    source = re.sub(r"\b\d+(?:\.\d+)?(?:fr|pt|em|cm)\b|width: \d+%", " ", source)
    source = re.sub(r"depth: \d|leading: |y > 0", " ", source)
    source = re.sub(NAMES, " ", source)
    for whole in QUOTED:
        source = source.replace(whole, " ")
    return source


def quoted(function: str) -> set[str]:
    """Return the names that the sections hand to a function of lib.typ."""
    found: set[str] = set()
    for path in SECTIONS:
        source = text(path)
        found |= set(re.findall(rf'\b{function}\("([^"]+)"\)', source))
        found |= set(re.findall(rf'\b{function}\("([^"]+)"[,\[]', source))
    return found


class OneTable:
    """Results in which every table is the same one."""

    def __init__(self, **columns):
        self._table = pd.DataFrame(columns)

    def table(self, study, name):
        return self._table
