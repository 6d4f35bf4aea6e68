"""Say of every study whether its stored result is fresh, stale or missing.

    python -m studies status

A result is stale when the case, the source it was computed by (docstrings and layout aside) or one of its
files was changed since. Exit code 0 whatever the states.
"""

import argparse
from pathlib import Path

from studies.commands.parser import Parser
from studies.record.store import RESULTS, Store
from studies.registry import STUDIES, module_of


def add_arguments(parser: Parser) -> None:
    """Declare the arguments of the command."""
    parser.add_argument(
        "--results",
        type=Path,
        default=RESULTS,
        metavar="FOLDER",
        help="where tables and figures are, default results/",
    )


def main(arguments: argparse.Namespace) -> int:
    """Print one line a study; return the exit code."""
    store = Store(arguments.results)
    width = max(map(len, STUDIES))
    for name, (module, _) in STUDIES.items():
        state = store.state(name, module=module, cases=module_of(name).CASES)
        print(f"{name:{width}}  {state.kind:7}  {state.reason}".rstrip())
    return 0
