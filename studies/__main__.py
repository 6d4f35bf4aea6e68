"""`python -m studies COMMAND ...`, or `crosspivot COMMAND ...`: find the command, import it, run it."""

import inspect
import os
import sys
from collections.abc import Sequence
from functools import cache

# One thread, set before numpy is first imported: small matrices gain nothing from more, and timings must not
# vary.
for _variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_variable, "1")

from importlib import import_module  # noqa: E402

from studies.cases.document import present  # noqa: E402
from studies.commands.parser import Command, Parser  # noqa: E402
from studies.errors import BadInput  # noqa: E402
from studies.record.files import forget_stale  # noqa: E402
from studies.record.source import HOME, ROOT  # noqa: E402
from studies.registry import COMMANDS, MODULES  # noqa: E402

BAD_INPUT = 2
INTERRUPTED = 130
#: What a shell reports of a command whose reader is gone: 128 and SIGPIPE.
BROKEN_PIPE = 141
#: What the overview shows: an example of one command.
EXAMPLE = "solve cross_axis_pivot --control-points 8"


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command; return its exit code, or 2 after one line on the error stream for bad input
    or a missing package. If the reader of the output stops, as `head` does, the rest is discarded."""
    try:
        try:
            return _told(list(sys.argv[1:] if arguments is None else arguments))
        finally:
            sys.stdout.flush()  # what is still to be written is written where its failure can be met
    except BrokenPipeError:
        discarded = os.open(os.devnull, os.O_WRONLY)
        for stream in (sys.stdout, sys.stderr):
            os.dup2(discarded, stream.fileno())
        return BROKEN_PIPE


def _told(words: list[str]) -> int:
    """Run one command and tell its failure in a line; return the exit code."""
    try:
        return _dispatch(words)
    except BadInput as error:
        print(f"studies: {error}", file=sys.stderr)
        return BAD_INPUT
    except ModuleNotFoundError as error:
        if (error.name or "").partition(".")[0] in ("studies", "spline_model", "fe_reference"):
            raise  # a fault of this suite, not of its surroundings
        remedy = "run `make setup` and use .venv/bin/python"
        if HOME != ROOT:
            remedy = f"run `python -m pip install {error.name}`"
        print(f"studies: the package {error.name} is not installed: {remedy}", file=sys.stderr)
        return BAD_INPUT
    except KeyboardInterrupt:
        print("studies: interrupted", file=sys.stderr)
        return INTERRUPTED


def _dispatch(words: list[str]) -> int:
    parser = _overview()
    if not words:
        parser.print_help()
        return 0
    name = parser.parse_args([present(words[0])]).command
    _forget_kernels()
    command, parser = command_of(name)
    return command.run(parser.parse_args(words[1:]))


@cache
def _forget_kernels() -> None:
    """Remove kernels of a former source before the first command; what a process has loaded stays so."""
    if forget_stale():
        print("studies: the source of the kernels has changed: they are compiled again", file=sys.stderr)


def command_of(name: str) -> tuple[Command, Parser]:
    """Import a command; return it with its parser, which its own text or that of its module explains."""
    place = next((module for module, names in MODULES.items() if name in names), name)
    module = import_module(f"studies.commands.{place}")
    alone = name not in MODULES.get(place, ())
    command: Command = getattr(module, "main" if alone else name.replace("-", "_"))
    return command, command.parser(name, module.__doc__ if alone else inspect.getdoc(command.run))


def _overview() -> Parser:
    lines = "\n".join(f"  {name:13s} {text}" for name, text in COMMANDS.items())
    parser = Parser(
        prog="python -m studies",
        description="Studies of the cross-axis flexural pivot, by splines and by finite elements.\n\n"
        f"    python -m studies {EXAMPLE}\n\ncommands:\n{lines}",
        epilog="`python -m studies COMMAND --help` explains a command, with an example.\n"
        "After an installation, `crosspivot COMMAND` is a short form of `python -m studies COMMAND`.",
    )
    parser.add_argument(
        "command", choices=list(COMMANDS), metavar="COMMAND", help="one of the commands above"
    )
    return parser


if __name__ == "__main__":
    sys.exit(main())
