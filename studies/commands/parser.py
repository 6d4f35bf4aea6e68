"""Commands and their arguments as values, a parser whose errors are one line, and the types of numbers."""

import argparse
import difflib
import math
import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any, NoReturn

from studies.cases.rules import Rule
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


class Argument:
    """One argument of a command: its names, and what `argparse` is to know of it.

    Args:
        names: of the argument. group: heading that it stands under in the help.
        keywords: of `ArgumentParser.add_argument`.
    """

    def __init__(self, *names: str, group: str = "", **keywords: Any) -> None:
        self.names, self.group, self.keywords = names, group, keywords

    def but(self, **keywords: Any) -> "Argument":
        """Return the same argument, with what else is to be known of it here."""
        return Argument(*self.names, group=self.group, **self.keywords | keywords)

    def of(self, group: str) -> "Argument":
        """Return the same argument, to stand under a heading of its own."""
        return Argument(*self.names, group=group, **self.keywords)


@dataclass(frozen=True)
class Command:
    """What a command does, from its arguments to its exit code, and the arguments that it takes."""

    run: Callable[[argparse.Namespace], int]
    takes: tuple[Argument, ...]

    def parser(self, name: str, text: str | None) -> Parser:
        """Return the parser of the command of that name, which `text` explains."""
        parser = Parser(prog=f"python -m studies {name}", description=text)
        groups: dict[str, Any] = {"": parser}
        for each in self.takes:
            if each.group not in groups:
                groups[each.group] = parser.add_argument_group(each.group)
            groups[each.group].add_argument(*each.names, **each.keywords)
        return parser


def command(*takes: Argument) -> Callable[[Callable[[argparse.Namespace], int]], Command]:
    """Make a command of a function of these arguments."""
    return lambda run: Command(run, takes)


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


def number(low: float, expected: str, *, least: bool = False) -> Callable[[str], float]:
    """Return a parser of finite numbers above `low`, or with `least` from there upwards."""

    def parse(text: str) -> float:
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if not (low <= value if least else low < value) or not math.isfinite(value):
            raise argparse.ArgumentTypeError(f"got {text}, expected a finite number {expected}")
        return value

    return parse


degrees = number(-math.inf, "of degrees")
positive = number(0.0, "above 0")
not_negative = number(0.0, "of at least 0", least=True)


def ruled(rule: Rule, read: Callable[[str], Any]) -> Callable[[str], Any]:
    """Return a parser of what a key of a case may be, in SI, from the text that `read` makes a number of."""

    def parse(text: str) -> Any:
        value = read(text)
        try:
            return rule.parse(value)
        except ValueError as error:
            raise argparse.ArgumentTypeError(str(error)) from None

    return parse


def names_of(known: Iterable[str]) -> Callable[[str], tuple[str, ...]]:
    """Return a parser of comma-separated names, each one of `known` and none twice."""
    choices = tuple(known)

    def parse(text: str) -> tuple[str, ...]:
        given = tuple(text.split(","))
        for name in given:
            if name not in choices or given.count(name) > 1:
                expected = f"one or more of {', '.join(choices)}, each once, separated by commas"
                raise argparse.ArgumentTypeError(f"got {name or 'nothing'}, expected {expected}")
        return given

    return parse


def degrees_list(text: str) -> tuple[float, ...]:
    """Parse comma-separated angles in degrees."""
    return tuple(degrees(part) for part in text.split(","))
