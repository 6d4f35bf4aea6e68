"""An argument parser whose errors are one line, and the number types that arguments share."""

import argparse
import difflib
import math
import re
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, NoReturn

from studies.errors import BadInput


class Parser(argparse.ArgumentParser):
    """Parser that keeps the layout of its texts and raises BadInput instead of exiting."""

    def __init__(self, **keywords: Any) -> None:
        super().__init__(formatter_class=argparse.RawDescriptionHelpFormatter, allow_abbrev=False, **keywords)

    def error(self, message: str) -> NoReturn:
        """Raise BadInput with `message` in one line, naming the option nearest to an unknown one."""
        unknown = re.match(r"unrecognized arguments: (--[\w-]+)", message)
        if unknown:
            options = [option for action in self._actions for option in action.option_strings]
            near = difflib.get_close_matches(unknown[1], options, n=1)
            message += (
                f", expected {near[0]} (the nearest option)" if near else f", expected one of {options}"
            )
        raise BadInput(f"{self.prog.removeprefix('python -m studies ')}: {message}")


def add_case(parser: Parser, what: str) -> None:
    """Declare the case file, with what it is to the command."""
    parser.add_argument("case", metavar="CASE.toml", help=what)


def add_studies(parser: Parser) -> None:
    """Declare the names of studies."""
    parser.add_argument("names", nargs="+", metavar="NAME", help="studies, groups, or all; `list` names them")


def add_results(parser: Parser) -> None:
    """Declare the folder of results."""
    parser.add_argument(
        "--results",
        type=Path,
        default=Path(__file__).parents[2] / "results",
        metavar="FOLDER",
        help="where tables and figures are, default results/",
    )


def whole_number(low: int) -> Callable[[str], int]:
    """Return a parser of whole numbers from `low` upwards."""

    def parse(text: str) -> int:
        try:
            value = int(text)
        except ValueError:
            value = low - 1
        if value < low:
            raise argparse.ArgumentTypeError(f"got {text}, expected a whole number of at least {low}")
        return value

    return parse


def counts(low: int) -> Callable[[str], tuple[int, int]]:
    """Return a parser of ranges "first:last" of whole numbers from `low` upwards, both ends included."""

    def parse(text: str) -> tuple[int, int]:
        first, separator, last = text.partition(":")
        if separator and first.isdecimal() and last.isdecimal() and low <= int(first) < int(last):
            return int(first), int(last)
        raise argparse.ArgumentTypeError(f"got {text}, expected FIRST:LAST with {low} <= FIRST < LAST")

    return parse


def degrees(text: str) -> float:
    """Parse a finite angle in degrees."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise argparse.ArgumentTypeError(f"got {text}, expected a finite number of degrees")
    return value


def positive(text: str) -> float:
    """Parse a finite number above zero."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not 0.0 < value < math.inf:
        raise argparse.ArgumentTypeError(f"got {text}, expected a finite number above 0")
    return value


def not_negative(text: str) -> float:
    """Parse a finite number of zero or above."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not 0.0 <= value < math.inf:
        raise argparse.ArgumentTypeError(f"got {text}, expected a finite number of at least 0")
    return value


def names_of(known: Iterable[str]) -> Callable[[str], tuple[str, ...]]:
    """Return a parser of comma-separated names, each one of `known` and none twice."""
    choices = tuple(known)

    def parse(text: str) -> tuple[str, ...]:
        given = tuple(text.split(","))
        for name in given:
            if name not in choices or given.count(name) > 1:
                expected = f"one or more of {', '.join(choices)}, separated by commas"
                raise argparse.ArgumentTypeError(f"got {name or 'nothing'}, expected {expected}")
        return given

    return parse


def degrees_list(text: str) -> tuple[float, ...]:
    """Parse comma-separated angles in degrees."""
    return tuple(degrees(part) for part in text.split(","))
