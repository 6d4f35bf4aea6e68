"""Print a commented case file to begin with, which can be solved as it is.

    python -m studies case --pivot --out my_design.toml
    python -m studies case --mechanism

Every key that a case may have is in it, with its meaning, its unit and what holds where it is left out;
docs/cases.md tells the same with the rules. Exit code 0: done; 2: bad input.
"""

import argparse
from pathlib import Path

from studies.cases.page import template
from studies.commands.arguments import OUT
from studies.commands.parser import Argument, command
from studies.errors import BadInput
from studies.record.files import require_writable_file, write_whole


@command(
    Argument("--pivot", action="store_true", help="of a cross-axis pivot (default)"),
    Argument("--mechanism", action="store_true", help="of any mechanism of strips and bodies"),
    OUT.but(metavar="FILE", help="write it there (default: the output stream)"),
)
def main(arguments: argparse.Namespace) -> int:
    """Print or write the template; return the exit code."""
    if arguments.pivot and arguments.mechanism:
        raise BadInput("case: got --pivot and --mechanism, expected one of them")
    text = "\n".join(template(mechanism=arguments.mechanism))
    if arguments.out is None:
        print(text)
        return 0
    written(arguments.out, text)
    return 0


def written(path: Path, text: str) -> None:
    """Write a case file and say so."""
    require_writable_file(path)
    write_whole(path, f"{text}\n".encode())
    print(f"{path}: written; `python -m studies solve {path}`")
