"""Rewrite the tables of the README, of the page of findings and of that of case files.

    python -m studies readme

Only what stands between marks is written: in README.md and docs/findings.md from results/data, in
docs/cases.md from the declarations that read case files. Exit code 0: done; 2: a study it needs was never
run, or a file has no marks.
"""

import argparse
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path

from studies.cases import page
from studies.commands import tables
from studies.commands.parser import command
from studies.errors import BadInput
from studies.record.files import write_whole
from studies.record.source import ROOT
from studies.record.store import Store
from studies.stability.summary import lines


def _digits(store: Store) -> Iterable[str]:
    studies = ("work_precision/statics", "work_precision/dynamics")
    return tables.digits(*(tables.stored(store, study, "digits_of_time") for study in studies))


def _published(store: Store) -> Iterable[str]:
    return tables.published_values(tables.stored(store, "published/problems", "values"))


#: File -> block -> the lines that stand between its marks.
BLOCKS: dict[Path, Mapping[str, Callable[[Store], Iterable[str]]]] = {
    ROOT / "README.md": {"agreement": tables.short, "published": _published},
    ROOT / "docs" / "findings.md": {
        "paths": tables.paths,
        "swings": tables.swings,
        "claims": tables.claims,
        "digits": _digits,
        "hard cases": lines,
        "sized": tables.sized,
    },
    ROOT / "docs" / "cases.md": {
        "keys of a pivot": lambda store: page.pivot(),
        "keys of a mechanism": lambda store: page.mechanism(),
        "effects": lambda store: page.effects(),
        "materials": lambda store: page.materials(),
    },
}


@command()
def main(arguments: argparse.Namespace) -> int:
    """Rewrite the blocks; return the exit code."""
    texts = {path: rewritten(path, Store()) for path in BLOCKS}
    for path, text in texts.items():
        write_whole(path, text.encode())
        print(f"{path.relative_to(ROOT)}: {', '.join(BLOCKS[path])}")
    return 0


def rewritten(path: Path, store: Store) -> str:
    """Return the text of a file of `BLOCKS` with what stands between its marks made anew from `store`.

    Raises:
        BadInput: the marks are missing, or a study was never run.
    """
    text = path.read_text(encoding="utf-8")
    for name, made in BLOCKS[path].items():
        text = between(text, name, made(store), path.name)
    return text


def marks(name: str) -> tuple[str, str]:
    """Return the marks before and after the block of this name."""
    return f"<!-- {name}: written by `python -m studies readme` -->", f"<!-- end of {name} -->"


def between(text: str, name: str, made: Iterable[str], where: str) -> str:
    """Return `text` with `made` in place of what stands between the marks of the block `name`.

    Raises:
        BadInput: the marks are missing; `where` is the file that the message names.
    """
    begin, end = marks(name)
    head, found_begin, rest = text.partition(begin)
    _, found_end, tail = rest.partition(end)
    if not (found_begin and found_end):
        raise BadInput(f"{where}: got no marks, expected {begin} and {end}")
    return "\n".join([f"{head}{begin}", "", *made, "", f"{end}{tail}"])
