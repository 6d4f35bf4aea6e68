"""Rewrite the tables of the README, of the page of findings and of that of case files.

    python -m studies readme

Only what stands between marks is written: in README.md and docs/findings.md tables of the report, in
docs/cases.md from the declarations that read case files. The benchmark package in results/reference is
written as a whole from results/data. Exit code 0: done; 2: a study it needs was never
run, or a file has no marks.
"""

import argparse
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from studies.answers import quantities
from studies.commands.case import PAGE, markdown_head
from studies.commands.parser import command
from studies.errors import BadInput
from studies.published import benchmark
from studies.record.files import write_whole
from studies.record.source import HOME, ROOT
from studies.record.store import Store

if TYPE_CHECKING:  # the report is in a clone only
    from report.facts import Results

#: Makes the lines that stand between the marks of a block.
Made = Callable[["Results"], Iterable[str]]
#: Spaces of the report that do not break, or are narrow.
SPACES = str.maketrans({"\u00a0": " ", "\u202f": " "})


def _quantities(results: "Results") -> Iterator[str]:
    """Yield the table of the quantities of a path."""
    yield markdown_head("key", "unit", "meaning", "in a sweep")
    for each in quantities.QUANTITIES:
        swept = f"`{each.name_in_sweep}`, {each.standing}" if each.standing else "–"
        meaning = each.meaning + (", of mechanisms" if each.mechanisms else "")
        yield f"| `{each.key}` | {each.unit} | {meaning} | {swept} |"


def _of_page(name: str) -> Made:
    return lambda results: PAGE[name]()


def _of_report(name: str) -> Made:
    """Return what makes a table of the report."""

    def lines(results: "Results") -> Iterator[str]:
        from report.build import quotable

        table = quotable()["listings"][name].given(name, results)
        yield markdown_head(*table["head"])
        yield from (f"| {' | '.join(row)} |".translate(SPACES) for row in table["rows"])

    return lines


#: Tables of the page of findings, in its order, as the report calls them.
FINDINGS = ("claims", "agreement", "cost", "families", "effects", "solids", "sizing", "published")
#: File -> block -> the lines that stand between its marks.
BLOCKS: dict[Path, Mapping[str, Made]] = {
    ROOT / "README.md": {"agreement": _of_report("agreement")},
    ROOT / "docs" / "findings.md": {name: _of_report(name) for name in FINDINGS},
    ROOT / "docs" / "data.md": {"quantities": _quantities},
    ROOT / "docs" / "cases.md": {name: _of_page(name) for name in PAGE},
}


@command()
def main(arguments: argparse.Namespace) -> int:
    """Rewrite the blocks; return the exit code. BadInput: an installed package instead of a clone."""
    if HOME != ROOT:
        raise BadInput("readme: got an installed package, expected a clone of the repository")
    from report.facts import Results

    results = Results(Store(), allow_stale=True)
    texts = {path: _rewritten(path, results) for path in BLOCKS}
    for path, text in texts.items():
        write_whole(path, text.encode())
        print(f"{path.relative_to(ROOT)}: {', '.join(BLOCKS[path])}")
    for name, content in benchmark.package(results.table).items():
        write_whole(benchmark.FOLDER / name, content)
    print(f"{benchmark.FOLDER.relative_to(ROOT)}: {', '.join(benchmark.THEORIES)}")
    return 0


def _rewritten(path: Path, results: "Results") -> str:
    """Return the text of a file of `BLOCKS` with what stands between its marks made again from results;
    BadInput where the marks are missing, or a study was never run."""
    text = path.read_text(encoding="utf-8")
    for name, made in BLOCKS[path].items():
        begin, end = f"<!-- {name}: written by `python -m studies readme` -->", f"<!-- end of {name} -->"
        head, found_begin, rest = text.partition(begin)
        _, found_end, tail = rest.partition(end)
        if not (found_begin and found_end):
            raise BadInput(f"{path.name}: got no marks, expected {begin} and {end}")
        text = "\n".join([f"{head}{begin}", "", *made(results), "", f"{end}{tail}"])
    return text
