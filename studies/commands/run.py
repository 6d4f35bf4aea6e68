"""Compute studies, store their tables and draw their figures.

    python -m studies run fig04_trajectory
    python -m studies run paper convergence

A name is a study, its last part, a group of studies or "all". Tables and their provenance go to results/data,
figures to results/figures. A study that this machine cannot compute, for want of a browser, a cluster or the
other codes that it is about (pip install ".[peers]"), says so and keeps its stored result. Exit code 0: done;
2: bad input, for example a folder that cannot be written to.
"""

import argparse
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from studies.commands.parser import Parser
from studies.record import style
from studies.record.progress import Bar
from studies.record.store import RESULTS, Store
from studies.registry import STUDIES, module_of, selected


def add_arguments(parser: Parser) -> None:
    """Declare the arguments of the command."""
    parser.add_argument("names", nargs="+", metavar="NAME", help="studies, groups, or all; `list` names them")
    parser.add_argument(
        "--results",
        type=Path,
        default=RESULTS,
        metavar="FOLDER",
        help="where tables and figures are, default results/",
    )


def main(arguments: argparse.Namespace) -> int:
    """Run the studies one after the other; return the exit code."""
    names = selected(arguments.names)
    store = Store(arguments.results)
    store.require_writable()
    for name in names:
        reason = missing(module_of(name))
        if reason:
            print(f"{name}: left as it is: {reason}", file=sys.stderr)
            continue
        seconds = _run(name, store)
        print(f"{name}: {seconds:.1f} s: {store.data(name)}, figures in {store.figures}", file=sys.stderr)
    return 0


def missing(module: Any) -> str:
    """Return what a study asks of the machine, and this one lacks; nothing for most studies."""
    lacks: Callable[[], str] = getattr(module, "missing", str)
    return lacks()


def _run(name: str, store: Store) -> float:
    """Compute, store and draw one study; return the seconds it took."""
    start = time.perf_counter()
    module = module_of(name)
    with Bar(name) as bar:
        tables = module.compute(bar)
    store.save_tables(
        name,
        tables,
        module=STUDIES[name][0],
        cases=module.CASES,
        command=f"python -m studies run {name}",
        elapsed=time.perf_counter() - start,
    )
    with style.applied():
        store.save_figures(name, module.draw(store.load_tables(name)))
    return time.perf_counter() - start
