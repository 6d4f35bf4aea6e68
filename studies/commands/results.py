"""The commands of the studies and their stored results: run, draw, verify, status."""

import argparse
import sys
from collections.abc import Iterator
from typing import Any

from studies.asking import Asking, Kept, cores, processes, whole
from studies.commands.arguments import NAMES, RESULTS
from studies.commands.parser import Argument, command, whole_number
from studies.engine import Study, Tables
from studies.errors import BadInput
from studies.record import style
from studies.record.progress import Bar
from studies.record.source import ROOT, source_hash
from studies.record.store import Store, same
from studies.registry import STUDIES, selected, study_of

#: Where the answers of interrupted studies by the present source are kept; not a result.
KEPT = ROOT / ".cache" / "answers"
DIFFERS = 1
PROCESSES = Argument(
    "--processes N",
    "answer points beside each other where time is not measured, default the number of cores",
    whole_number(1),
    default=cores(),
)


@command(NAMES, RESULTS, PROCESSES)
def run(arguments: argparse.Namespace) -> int:
    """Compute studies, store their tables and draw their figures.

        python -m studies run fig04_trajectory
        python -m studies run paper convergence --processes 1

    A name is a study, its last part, a group of studies or "all". Tables and their provenance go to
    results/data, figures to results/figures. A study that this machine cannot compute, for want of a
    browser, a cluster or the other codes that it is about (pip install ".[peers]"), says so and keeps its
    stored result. One that was interrupted goes on from there. Exit code 0: done; 2: bad input, for example
    a folder that cannot be written to.
    """
    store = Store(arguments.results)
    store.require_writable()
    names = []
    for name in selected(arguments.names):
        if reason := study_of(name).missing():
            print(f"{name}: left as it is: {reason}", file=sys.stderr)
        else:
            names.append(name)
    for name, asking, bar in _whole(names, arguments.processes, keep=True):
        study = asking.study
        store.save_tables(
            name,
            asking.tables(),
            module=STUDIES[name],
            cases=study.cases,
            command=f"python -m studies run {name}",
            elapsed=asking.seconds,
        )
        asking.forget()
        with style.applied():
            store.save_figures(name, study.draw(store.load_tables(name)))
        bar.say(f"{name}: {asking.seconds:.1f} s: {store.data(name)}, figures in {store.figures}")
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
        try:
            tables = store.load_tables(name)
        except FileNotFoundError:
            raise BadInput(
                f"{name}: got no stored tables, expected those of `python -m studies run {name}`"
            ) from None
        with style.applied():
            store.save_figures(name, study_of(name).draw(tables))
        print(f"{name}: figures in {store.figures}", file=sys.stderr)
    return 0


@command(NAMES, RESULTS, PROCESSES)
def verify(arguments: argparse.Namespace) -> int:
    """Compute stale studies anew and call them fresh where every table comes out as it is stored.

        python -m studies verify convergence/elements

    A name is a study, its last part, a group of studies or "all". Tables that differ from run to run, as
    times do, are not compared, and columns that other work on the machine changes only to the digits that the
    study states. Nothing is drawn: only the note of the source that the results are of is renewed. A study
    with another table is named and keeps what is stored. Exit code 0: all that could be
    computed here is fresh; 1: a table differs; 2: bad input.
    """
    store, code, stale = Store(arguments.results), 0, []
    for name in selected(arguments.names):
        study = study_of(name)
        said = study.missing() or store.state(name, module=STUDIES[name], cases=study.cases).kind
        if said == "stale":
            stale.append(name)
        else:
            print(f"{name}: {said}", file=sys.stderr)
    for name, asking, bar in _whole(stale, arguments.processes):
        known: dict[str, Any] = {"module": STUDIES[name], "cases": asking.study.cases}
        differing = _differing(store.load_tables(name), asking.tables(), asking.study)
        if differing:
            code = DIFFERS
            bar.say(f"{name}: differs: {', '.join(differing)}")
        else:
            store.renew(name, **known)
            bar.say(f"{name}: the same, {store.state(name, **known).kind}")
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


def _whole(names: list[str], count: int, *, keep: bool = False) -> Iterator[tuple[str, Asking, Bar]]:
    """Yield studies as their points are all answered, by so many processes, while a bar shows how far they
    are; answers are kept from an interrupted run to the next where asked for."""
    askings, names_at = {}, {STUDIES[name]: name for name in names}
    for place, name in names_at.items():
        file = KEPT / f"{name.replace('/', '_')}_{source_hash(place)[:16]}.pickle"
        askings[place] = Asking(study_of(name), Kept(file) if keep else None)
    with processes(count) as pool, Bar(names[0] if len(names) == 1 else f"{len(names)} studies") as bar:
        for place in whole(askings, bar, pool):
            yield names_at[place], askings[place], bar


def _differing(stored: Tables, found: Tables, study: Study) -> list[str]:
    """Return the tables that are not as stored, of those that do not differ from run to run."""
    names = [name for name in {**stored, **found} if not study.varies(name)]
    both = {name for name in stored if name in found}
    return [name for name in names if name not in both or not same(stored[name], found[name], study.digits)]
