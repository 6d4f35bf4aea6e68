"""Rewrite the tables of the README, of the page of findings and of that of case files.

    python -m studies readme

Only what stands between marks is written: in README.md and docs/findings.md from results/data, in
docs/cases.md from the declarations that read case files. The benchmark package in results/reference is
written as a whole from results/data. Exit code 0: done; 2: a study it needs was never
run, or a file has no marks.
"""

import argparse
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import partial
from pathlib import Path

from studies.answers import quantities
from studies.commands.case import PAGE, markdown_head
from studies.commands.findings import TABLES, stored_table
from studies.commands.parser import command
from studies.errors import BadInput
from studies.published import benchmark
from studies.record.files import write_whole
from studies.record.source import HOME, ROOT
from studies.record.store import Store


def _quantities(store: Store) -> Iterator[str]:
    """Yield the table of the quantities of a path."""
    yield markdown_head("key", "unit", "meaning", "in a sweep")
    for each in quantities.QUANTITIES:
        swept = f"`{each.name_in_sweep}`, {each.standing}" if each.standing else "–"
        meaning = each.meaning + (", of mechanisms" if each.mechanisms else "")
        yield f"| `{each.key}` | {each.unit} | {meaning} | {swept} |"


def _of_page(name: str) -> Callable[[Store], Iterable[str]]:
    return lambda store: PAGE[name]()


#: File -> block -> the lines that stand between its marks.
BLOCKS: dict[Path, Mapping[str, Callable[[Store], Iterable[str]]]] = {
    ROOT / "README.md": {"agreement": TABLES["agreement"]},
    ROOT / "docs" / "findings.md": {name: table for name, table in TABLES.items() if name != "agreement"},
    ROOT / "docs" / "data.md": {"quantities": _quantities},
    ROOT / "docs" / "cases.md": {name: _of_page(name) for name in PAGE},
}


@command()
def main(arguments: argparse.Namespace) -> int:
    """Rewrite the blocks; return the exit code. BadInput: an installed package instead of a clone."""
    if HOME != ROOT:
        raise BadInput("readme: got an installed package, expected a clone of the repository")
    texts = {path: _rewritten(path, Store()) for path in BLOCKS}
    for path, text in texts.items():
        write_whole(path, text.encode())
        print(f"{path.relative_to(ROOT)}: {', '.join(BLOCKS[path])}")
    for name, content in benchmark.package(partial(stored_table, Store())).items():
        write_whole(benchmark.FOLDER / name, content)
    print(f"{benchmark.FOLDER.relative_to(ROOT)}: {', '.join(benchmark.THEORIES)}")
    return 0


def _rewritten(path: Path, store: Store) -> str:
    """Return the text of a file of `BLOCKS` with what stands between its marks made again from `store`;
    BadInput where the marks are missing, or a study was never run."""
    text = path.read_text(encoding="utf-8")
    for name, made in BLOCKS[path].items():
        begin, end = f"<!-- {name}: written by `python -m studies readme` -->", f"<!-- end of {name} -->"
        head, found_begin, rest = text.partition(begin)
        _, found_end, tail = rest.partition(end)
        if not (found_begin and found_end):
            raise BadInput(f"{path.name}: got no marks, expected {begin} and {end}")
        text = "\n".join([f"{head}{begin}", "", *made(store), "", f"{end}{tail}"])
    return text
