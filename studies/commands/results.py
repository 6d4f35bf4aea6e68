"""The commands of the studies and their stored results: run, draw, verify, status."""

import argparse
import sys
from collections.abc import Iterator
from typing import Any

from studies.asking import answered, cores, processes
from studies.commands.arguments import NAMES, RESULTS
from studies.commands.parser import Argument, command, whole_number
from studies.engine import Study, Tables
from studies.errors import BadInput
from studies.record import style
from studies.record.digits import differing
from studies.record.progress import Bar
from studies.record.store import Store
from studies.registry import STUDIES, selected, study_of

DIFFERS = 1
PROCESSES = Argument(
    "--processes N",
    "answer points beside each other where time is not measured, default the number of cores",
    whole_number(1),
    default=cores(),
)
FRESH_TOO = Argument("--fresh-too", "compute fresh results as well")


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
    for name, tables, seconds, bar in _whole(names, arguments.processes):
        study = study_of(name)
        stored = _stored(store, name)
        other = _differing(stored, tables, study)
        kept = {each: stored[each] for each in stored if each not in other and not study.varies(each)}
        changed = store.save_tables(
            name,
            {**tables, **kept},
            module=STUDIES[name],
            cases=study.cases,
            command=f"python -m studies run {name}",
            elapsed=seconds,
        )
        if changed:
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
        said = study.missing() or store.state(name, module=STUDIES[name], cases=study.cases).kind
        if said == "stale" or (said == "fresh" and arguments.fresh_too):
            asked.append(name)
        else:
            print(f"{name}: {said}", file=sys.stderr)
    for name, tables, _, bar in _whole(asked, arguments.processes):
        study = study_of(name)
        known: dict[str, Any] = {"module": STUDIES[name], "cases": study.cases}
        other = _differing(store.load_tables(name), tables, study)
        if not other:
            store.renew(name, **known)
        kind = store.state(name, **known).kind
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
    for name, module in STUDIES.items():
        state = store.state(name, module=module, cases=study_of(name).cases)
        print(f"{name:{width}}  {state.kind:7}  {state.reason}".rstrip())
    return 0


def _whole(names: list[str], count: int) -> Iterator[tuple[str, Tables, float, Bar]]:
    """Yield studies as their points are all answered, by so many processes, with their tables and seconds,
    while a bar shows how far they are."""
    at = {STUDIES[name]: name for name in names}
    studies = {place: study_of(name) for place, name in at.items()}
    with processes(count) as pool, Bar(names[0] if len(names) == 1 else f"{len(names)} studies") as bar:
        for place, tables, seconds in answered(studies, bar, pool):
            yield at[place], tables, seconds, bar


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
