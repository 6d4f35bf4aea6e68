"""The commands of the studies and their stored results: run, draw, verify, status.

Points of studies are asked beside each other in other processes, as of `whole`.
"""

import argparse
import os
import sys
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from concurrent.futures import Executor, ProcessPoolExecutor, as_completed
from contextlib import ExitStack
from functools import cache
from multiprocessing import get_context
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pandas as pd

from studies.answers import quantities
from studies.commands.arguments import NAMES, RESULTS
from studies.commands.case import PAGE, markdown
from studies.commands.parser import Argument, command, whole_number
from studies.engine import Answer, Part, Study, Tables
from studies.errors import BadInput
from studies.kinds import Progress
from studies.published import benchmark
from studies.record import style
from studies.record.files import write_all, write_whole
from studies.record.progress import Bar
from studies.record.source import HOME, ROOT
from studies.record.store import Inputs, Store, differing, inputs
from studies.registry import STUDIES, selected, study_at, study_of

DIFFERS = 1
PROCESSES = Argument(
    "--processes N",
    "answer points beside each other where time is not measured, default the number of cores",
    whole_number(1),
    default=len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1,
)
FRESH_TOO = Argument("--fresh-too", "compute fresh results as well")

#: Place of a study, number of its part and of the point.
Key = tuple[str, int, int]
#: Points of studies by their keys, in the order of their answers.
Points = dict[Key, tuple[Part, Any]]
#: An answer and the seconds that it took.
Timed = tuple[Answer, float]


@command(NAMES, RESULTS, PROCESSES)
def run(arguments: argparse.Namespace) -> int:
    """Compute studies, store their tables and draw their figures.

        python -m studies run fig04_trajectory
        python -m studies run paper convergence --processes 1

    A name is a study, its last part, a group of studies or "all". Tables and their provenance go to
    results/data, figures to results/figures. A stored table stays as it is if every number of the new one
    is within its tolerance (docs/data.md). Figures are drawn if a table or the source changed, so that
    another machine changes times only. A study that this machine cannot compute, for want of a browser, a
    cluster or other codes (pip install ".[peers]"), is named and keeps its stored result. Each study is
    stored as soon as it is computed. Exit code 0: done; 2: bad input, for example a folder that cannot be
    written to.
    """
    store = Store(arguments.results)
    store.require_writable()
    names = []
    for name in selected(arguments.names):
        if reason := study_of(name).missing():
            print(f"{name}: left as it is: {reason}", file=sys.stderr)
        else:
            names.append(name)
    for name, study, tables, seconds, bar in _whole(names, arguments.processes):
        stored = _stored(store, name)
        other = _differing(stored, tables, study)
        kept = {each: stored[each] for each in stored if each not in other and not study.varies(each)}
        if store.save_tables(name, {**tables, **kept}, _inputs(name, study), seconds):
            with style.applied():
                store.save_figures(name, study.draw(store.load_tables(name)))
        said = f"changed: {', '.join(other.values())}" if stored and other else "stored"
        bar.say(f"{name}: {seconds:.1f} s: {said}: {store.data(name)}, figures in {store.figures}")
    return 0


@command(NAMES, RESULTS)
def draw(arguments: argparse.Namespace) -> int:
    """Redraw studies from their stored tables, without computing anything.

        python -m studies draw fig04_trajectory

    A name is a study, its last part, a group of studies or "all". Exit code 0: done; 2: bad input, for
    example a study that was never run.
    """
    store = Store(arguments.results)
    for name in selected(arguments.names):
        if not (tables := _stored(store, name)):
            raise BadInput(f"{name}: got no stored tables, expected those of `python -m studies run {name}`")
        with style.applied():
            store.save_figures(name, study_of(name).draw(tables))
        print(f"{name}: figures in {store.figures}", file=sys.stderr)
    return 0


@command(NAMES, RESULTS, PROCESSES, FRESH_TOO)
def verify(arguments: argparse.Namespace) -> int:
    """Compute stale studies again and mark them as fresh if every table is reproduced.

        python -m studies verify convergence/elements
        python -m studies verify paper convergence --fresh-too

    A name is a study, its last part, a group of studies or "all". Numbers are compared within the tolerance
    of their column (docs/data.md), words and whole numbers exactly, and tables that differ from run to run,
    such as times, not at all. No table and no figure is written, only the hash of the source in the
    provenance. A study that differs is named with its columns and keeps what is stored. Exit code 0: all
    that could be computed here is fresh; 1: a study differs; 2: bad input.
    """
    store, code, asked = Store(arguments.results), 0, []
    for name in selected(arguments.names):
        study = study_of(name)
        said = study.missing() or store.state(name, _inputs(name, study)).kind
        if said == "stale" or (said == "fresh" and arguments.fresh_too):
            asked.append(name)
        else:
            print(f"{name}: {said}", file=sys.stderr)
    for name, study, tables, _, bar in _whole(asked, arguments.processes):
        now, other = _inputs(name, study), _differing(store.load_tables(name), tables, study)
        if not other:
            store.renew(name, now)
        kind = store.state(name, now).kind
        bar.say(f"{name}: " + (f"differs: {', '.join(other.values())}" if other else f"the same, {kind}"))
        code = DIFFERS if other or kind != "fresh" else code
    return code


@command(RESULTS)
def status(arguments: argparse.Namespace) -> int:
    """Say of every study whether its stored result is fresh, stale or missing.

        python -m studies status

    A result is stale when the case, the source it was computed by (docstrings and layout aside) or one of
    its files was changed since. Exit code 0 whatever the states.
    """
    store = Store(arguments.results)
    width = max(map(len, STUDIES))
    for name in STUDIES:
        state = store.state(name, _inputs(name, study_of(name)))
        print(f"{name:{width}}  {state.kind:7}  {state.reason}".rstrip())
    return 0


def _inputs(name: str, study: Study) -> Inputs:
    """Return the hashes of what a study is made from now."""
    return inputs(STUDIES[name], study.cases)


def _whole(names: list[str], count: int) -> Iterator[tuple[str, Study, Tables, float, Bar]]:
    """Yield studies with their tables and seconds as their points are all answered, while a bar shows how far
    they are; by so many processes of one thread each, or by this one alone."""
    names_at = {STUDIES[name]: name for name in names}
    with ExitStack() as opened, Bar(names[0] if len(names) == 1 else f"{len(names)} studies") as bar:
        pool = ProcessPoolExecutor(count, mp_context=get_context("spawn")) if count > 1 else None
        if pool:
            opened.callback(pool.shutdown, cancel_futures=True)
        for place, tables, seconds in whole(names_at, bar, pool):
            yield names_at[place], study_at(place), tables, seconds, bar


def _stored(store: Store, name: str) -> Tables:
    """Return the stored tables of a study; none if it was never run."""
    try:
        return store.load_tables(name)
    except FileNotFoundError:
        return {}


def _differing(stored: Tables, found: Tables, study: Study) -> dict[str, str]:
    """Return the tables that are not reproduced, each with its columns, of those that are to be compared."""
    others: dict[str, str] = {}
    for name in sorted({*stored, *found}):
        if study.varies(name):
            continue
        if name not in stored or name not in found:
            others[name] = f"{name} (only {'stored' if name in stored else 'computed'})"
        elif columns := differing(name, stored[name], found[name], study.digits):
            others[name] = f"{name} ({', '.join(columns)})"
    return others


def whole(
    places: Iterable[str], progress: Progress, pool: Executor | None = None
) -> Iterator[tuple[str, dict[str, pd.DataFrame], float]]:
    """Ask all points, and yield each study as soon as it is whole: its place, its tables, and what all its
    answers took, one after the other [s].

    Args:
        places: of studies, as of `study_at`, where other processes find them.
        progress: is told how many points of how many of all studies are done.
        pool: has points of all studies beside each other, but for those that must be alone, which come when
            it has done the others. Without it one study comes after the other.
    """
    points = {key: one for place in places for key, one in _points(place).items()}
    found: dict[Key, Timed] = {}
    progress(0, len(points))
    for key, timed in _answers(points, pool):
        found[key] = timed
        progress(len(found), len(points))
        mine = [each for each in points if each[0] == key[0]]
        if all(each in found for each in mine):
            answers, seconds = zip(*(found[each] for each in mine), strict=True)
            yield key[0], study_at(key[0]).tables(answers), sum(seconds)


def _answers(points: Points, pool: Executor | None) -> Iterator[tuple[Key, Timed]]:
    """Yield the answer of each point: those of other processes, then those of this one."""
    beside = [key for key, (part, _) in points.items() if pool and not part.alone]
    waiting = {pool.submit(_elsewhere, key): key for key in beside if pool}
    for future in as_completed(waiting):
        yield waiting[future], future.result()
    yield from ((key, _timed(*point)) for key, point in points.items() if key not in beside)


@cache
def _points(place: str) -> Points:
    """Return part and point by their key."""
    return {
        (place, i, k): (part, point)
        for i, part in enumerate(study_at(place).parts)
        for k, point in enumerate(part.at())
    }


def _timed(part: Part, point: Any) -> Timed:
    """Answer one point; return the seconds that it took as well."""
    start = time.perf_counter()
    return part.answer(point), time.perf_counter() - start


def _elsewhere(key: Key) -> Timed:
    """Answer one point in another process, which has the study from its place."""
    return _timed(*_points(key[0])[key])


if TYPE_CHECKING:  # the report is in a clone only
    from report.facts import Results

#: Makes the lines that stand between the marks of a block.
Made = Callable[["Results"], Iterable[str]]
#: Spaces of the report that do not break, or are narrow.
SPACES = str.maketrans({"\u00a0": " ", "\u202f": " "})


def _quantities(results: "Results") -> Iterator[str]:
    """Yield the table of the quantities of a path."""
    rows = []
    for each in quantities.QUANTITIES:
        swept = f"`{each.name_in_sweep}`, {each.standing}" if each.standing else "–"
        meaning = each.meaning + (", of mechanisms" if each.mechanisms else "")
        rows.append((f"`{each.key}`", each.unit, meaning, swept))
    return markdown(("key", "unit", "meaning", "in a sweep"), rows)


def _of_page(name: str) -> Made:
    return lambda results: PAGE[name]()


def _of_report(name: str) -> Made:
    """Return what makes a table of the report."""

    def lines(results: "Results") -> Iterator[str]:
        from report.build import quotable

        table = quotable()["listings"][name].given(name, results)
        return (line.translate(SPACES) for line in markdown(table["head"], table["rows"]))

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
def readme(arguments: argparse.Namespace) -> int:
    """Rewrite the tables of the README, of the page of findings and of that of case files.

        python -m studies readme

    Only what stands between marks is written: in README.md and docs/findings.md tables of the report, in
    docs/cases.md from the declarations that read case files. The benchmark package in results/reference
    is written as a whole from results/data. Exit code 0: done; 2: a study it needs was never run, or a
    file has no marks.
    """
    if HOME != ROOT:
        raise BadInput("readme: got an installed package, expected a clone of the repository")
    from report.facts import Results

    results = Results(Store(), allow_stale=True)
    texts = {path: _rewritten(path, results) for path in BLOCKS}
    for path, text in texts.items():
        write_whole(path, text.encode())
        print(f"{path.relative_to(ROOT)}: {', '.join(BLOCKS[path])}")
    write_all(benchmark.FOLDER, benchmark.package(results.table))
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
