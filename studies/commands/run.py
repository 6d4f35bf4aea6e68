"""Compute studies, store their tables and draw their figures.

    python -m studies run fig04_trajectory
    python -m studies run paper convergence --processes 1

A name is a study, its last part, a group of studies or "all". Tables and their provenance go to results/data,
figures to results/figures. A study that this machine cannot compute, for want of a browser, a cluster or the
other codes that it is about (pip install ".[peers]"), says so and keeps its stored result. One that was
interrupted goes on from there. Exit code 0: done; 2: bad input, for example a folder that cannot be written
to.
"""

import argparse
import sys
import time
from concurrent.futures import Executor

import pandas as pd

from studies.commands.parser import Parser, add_results, add_studies, whole_number
from studies.engine.answer import Kept, answered, cores, processes
from studies.record import style
from studies.record.progress import Bar
from studies.record.source import ROOT, source_hash
from studies.record.store import Store
from studies.registry import STUDIES, selected, study_of

#: Where the answers of interrupted studies are kept; not a result.
KEPT = ROOT / ".cache" / "studies"


def add_arguments(parser: Parser) -> None:
    """Declare the arguments of the command."""
    add_run_arguments(parser)


def add_run_arguments(parser: Parser) -> None:
    """Declare which studies are computed, where their results are, and on how many processes."""
    add_studies(parser)
    add_results(parser)
    parser.add_argument(
        "--processes",
        type=whole_number(1),
        default=cores(),
        metavar="N",
        help="answer points beside each other where time is not measured, default the number of cores",
    )


def main(arguments: argparse.Namespace) -> int:
    """Run the studies one after the other; return the exit code."""
    names = selected(arguments.names)
    store = Store(arguments.results)
    store.require_writable()
    with processes(arguments.processes) as pool:
        for name in names:
            reason = study_of(name).missing()
            if reason:
                print(f"{name}: left as it is: {reason}", file=sys.stderr)
                continue
            seconds = _run(name, store, pool)
            print(f"{name}: {seconds:.1f} s: {store.data(name)}, figures in {store.figures}", file=sys.stderr)
    return 0


def _run(name: str, store: Store, pool: Executor | None) -> float:
    """Compute, store and draw one study; return the seconds it took."""
    start = time.perf_counter()
    study, kept = study_of(name), _kept(name)
    store.save_tables(
        name,
        computed(name, pool, kept),
        module=STUDIES[name],
        cases=study.cases,
        command=f"python -m studies run {name}",
        elapsed=time.perf_counter() - start,
    )
    kept.forget()
    with style.applied():
        store.save_figures(name, study.draw(store.load_tables(name)))
    return time.perf_counter() - start


def computed(name: str, pool: Executor | None, kept: Kept | None = None) -> dict[str, pd.DataFrame]:
    """Return the tables of one study while a bar shows how far it is."""
    with Bar(name) as bar:
        return answered(study_of(name), bar, kept=kept, pool=pool, module=STUDIES[name])


def _kept(name: str) -> Kept:
    """Return where the answers of a study by the present source are kept."""
    return Kept(KEPT / f"{name.replace('/', '_')}_{source_hash(STUDIES[name])[:16]}.pickle")
