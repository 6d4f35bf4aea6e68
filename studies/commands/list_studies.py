"""List the studies: the names that `run` and `draw` take.

    python -m studies list

A study may also be called by its last part, its group, or as one of "all". Exit code 0.
"""

import argparse

from studies.commands.parser import Parser
from studies.registry import STUDIES, question_of


def add_arguments(parser: Parser) -> None:
    """Declare the arguments of the command: there are none."""


def main(arguments: argparse.Namespace) -> int:
    """Print one line a study; return the exit code."""
    width = max(map(len, STUDIES))
    for name in STUDIES:
        print(f"{name:{width}}  {question_of(name)}")
    return 0
