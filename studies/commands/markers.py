"""Print the sheet with the ground marker, the moving marker, the pivot's outline and a ruler, as PDF for A4.

    python -m studies markers -o markers.pdf

Print it at 100 %, measure the ruler, and type its length into the page if it is not 100 mm: no picture can
tell the printed size. It needs the extra `interactive`. Exit code 0: done; 2: bad input.
"""

import argparse
from pathlib import Path

from studies.commands.interactive import missing_packages
from studies.commands.parser import Parser
from studies.errors import BadInput
from studies.record.files import require_writable_file, write_whole


def add_arguments(parser: Parser) -> None:
    """Declare the arguments of the command."""
    parser.add_argument(
        "-o", "--output", type=Path, default=Path("markers.pdf"), metavar="FILE", help="default markers.pdf"
    )


def main(arguments: argparse.Namespace) -> int:
    """Write the sheet; return the exit code."""
    missing = missing_packages()
    if missing:
        raise BadInput(
            f"markers: got no {', '.join(missing)}, expected the extra: run `make interactive`, "
            "or pip install -e '.[interactive]'"
        )
    from studies.interactive.film.sheet import sheet

    require_writable_file(arguments.output)
    write_whole(arguments.output, sheet())
    print(f"{arguments.output}: print at 100 %; the ruler must measure 100 mm")
    return 0
