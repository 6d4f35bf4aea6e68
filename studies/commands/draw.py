"""Redraw studies from their stored tables, without computing anything.

    python -m studies draw fig04_trajectory

A name is a study, its last part, a group of studies or "all". Exit code 0: done; 2: bad input, for example a
study that was never run.
"""

import argparse

from studies.commands.parser import Parser, add_results, add_studies
from studies.errors import BadInput
from studies.record import style
from studies.record.store import Store
from studies.registry import selected, study_of


def add_arguments(parser: Parser) -> None:
    """Declare the arguments of the command."""
    add_studies(parser)
    add_results(parser)


def main(arguments: argparse.Namespace) -> int:
    """Redraw the studies one after the other; return the exit code."""
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
    return 0
