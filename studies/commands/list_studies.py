"""List the studies: the names that `run` and `draw` take.

    python -m studies list

A study may also be called by its last part, its group, or as one of "all". Exit code 0.
"""

import argparse

from studies.commands.parser import command
from studies.registry import STUDIES, question_of


@command()
def main(arguments: argparse.Namespace) -> int:
    """Print one line a study; return the exit code."""
    width = max(map(len, STUDIES))
    for name in STUDIES:
        print(f"{name:{width}}  {question_of(name)}")
    return 0
