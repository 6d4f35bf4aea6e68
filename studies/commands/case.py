"""Print a commented case file to begin with, which can be solved as it is.

    python -m studies case --pivot --out my_design.toml
    python -m studies case --mechanism

Every key that a case may have is in it, with its meaning, its unit and what holds where it is left out;
docs/cases.md tells the same with the rules. Exit code 0: done; 2: bad input.
"""

import argparse

from studies.cases.write import template
from studies.commands.arguments import OUT
from studies.commands.parser import Argument, command
from studies.errors import BadInput
from studies.record.files import require_writable_file, write_whole


@command(
    Argument("--pivot", "of a cross-axis pivot (default)"),
    Argument("--mechanism", "of any mechanism of strips and bodies"),
    OUT.but("write it there (default: the output stream)", metavar="FILE"),
)
def main(arguments: argparse.Namespace) -> int:
    """Print or write the template; return the exit code."""
    if arguments.pivot and arguments.mechanism:
        raise BadInput("case: got --pivot and --mechanism, expected one of them")
    text = "\n".join(template(mechanism=arguments.mechanism))
    if arguments.out is None:
        print(text)
        return 0
    require_writable_file(arguments.out)
    written = f"{text}\n".encode()
    if arguments.out.is_file() and arguments.out.read_bytes() != written:
        raise BadInput(f"--out: got {arguments.out}, which holds something else, expected a new file")
    write_whole(arguments.out, written)
    print(f"{arguments.out}: written; `python -m studies solve {arguments.out}`")
    return 0
