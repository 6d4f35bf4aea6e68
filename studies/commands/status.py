"""Say of every study whether its stored result is fresh, stale or missing.

    python -m studies status

A result is stale when the case, the source it was computed by (docstrings and layout aside) or one of its
files was changed since. Exit code 0 whatever the states.
"""

import argparse

from studies.commands.parser import Parser, add_results
from studies.record.store import Store
from studies.registry import STUDIES, study_of


def add_arguments(parser: Parser) -> None:
    """Declare the arguments of the command."""
    add_results(parser)


def main(arguments: argparse.Namespace) -> int:
    """Print one line a study; return the exit code."""
    store = Store(arguments.results)
    width = max(map(len, STUDIES))
    for name, module in STUDIES.items():
        state = store.state(name, module=module, cases=study_of(name).cases)
        print(f"{name:{width}}  {state.kind:7}  {state.reason}".rstrip())
    return 0
