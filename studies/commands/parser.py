"""Commands and their arguments as values, a parser whose errors are one line, and types of what they read."""

import argparse
import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NoReturn

from studies.cases.document import nearest, present
from studies.cases.rules import Rule, number
from studies.errors import BadInput

#: What stands for the output stream in place of a file.
STREAM = Path("-")


class Parser(argparse.ArgumentParser):
    """Parser that keeps the layout of its texts and raises BadInput instead of exiting."""

    def __init__(self, **keywords: Any) -> None:
        super().__init__(formatter_class=argparse.RawDescriptionHelpFormatter, allow_abbrev=False, **keywords)

    def parse_args(self, args: Any = None, namespace: Any = None) -> Any:
        """Parse the words of a command; of an option=-- argparse would make a list without a value."""
        args = [present(word) if word.startswith("--") else word for word in args or ()]
        for word in args:
            if word.startswith("--") and word.endswith("=--"):
                self.error(f"argument {word[:-3]}: expected one argument")
        return super().parse_args(args, namespace)

    def error(self, message: str) -> NoReturn:
        """Raise BadInput with `message` in one line, naming the option nearest to an unknown one."""
        if unknown := re.match(r"unrecognized arguments: (--[\w-]+)", message):
            options = [option for action in self._actions for option in action.option_strings]
            message += f", expected {nearest(unknown[1], options, what='option')}"
        if other := re.match(r"(argument .*: )invalid choice: '(.*)' \(choose from (.*)\)$", message):
            known = re.findall(r"[\w-]+", other[3])
            message = f"{other[1]}got {other[2]}, expected {nearest(other[2], known)}"
        if bare := re.match(r"argument (--[\w-]+): expected one argument", message):
            message += f"; one that begins with - is given as {bare[1]}=-..."
        command = self.prog.removeprefix("python -m studies").strip()
        raise BadInput(f"{command}: {message}" if command else message)


class Argument:
    """One argument of a command.

    Args:
        usage: its name and that of its value, as "--step S"; an option without a value, or choices, is a
            switch.
        said: of it in the help. read: what makes a value of its text.
        keywords: of `ArgumentParser.add_argument` beside these.
    """

    def __init__(self, usage: str, said: str = "", read: Any = None, **keywords: Any):
        self.usage, self.said, self.read, self.keywords = usage, said, read, keywords

    @property
    def name(self) -> str:
        """The attribute that it fills unless `dest` says another."""
        return self.usage.partition(" ")[0].removeprefix("--").replace("-", "_")

    def but(self, said: str = "", **changed: Any) -> "Argument":
        """Return the same argument, with what else is to be known of it here."""
        given = {"said": said or self.said, "read": self.read} | self.keywords
        return Argument(self.usage, **given | changed)

    def add_to(self, parser: Parser) -> None:
        """Add it to a parser."""
        name, _, value = self.usage.partition(" ")
        known: dict[str, Any] = {"help": self.said}
        known |= {"type": self.read} if self.read else {}
        if value:
            known["metavar"] = value
        elif name.startswith("--") and "choices" not in self.keywords:
            known["action"] = "store_true"
        parser.add_argument(name, **known | self.keywords)


@dataclass(frozen=True)
class Command:
    """What a command does, from its arguments to its exit code, and the arguments that it takes."""

    run: Callable[[argparse.Namespace], int]
    takes: tuple[Argument, ...]

    def parser(self, name: str, text: str | None) -> Parser:
        """Return the parser of the command of that name, which `text` explains."""
        parser = Parser(prog=f"python -m studies {name}", description=text)
        for each in self.takes:
            each.add_to(parser)
        return parser


def command(*takes: Argument) -> Callable[[Callable[[argparse.Namespace], int]], Command]:
    """Make a command of a function of these arguments."""
    return lambda run: Command(run, takes)


def reads(expected: str, value_of: Callable[[str], Any]) -> Callable[[str], Any]:
    """Return a parser by what makes a value of a text, None or a ValueError where it is not as expected."""

    def parse(text: str) -> Any:
        try:
            value = value_of(text)
        except ValueError:
            value = None
        if value is None:
            raise BadInput(f"got {text}, expected {expected}")
        return value

    return parse


def whole_number(low: int) -> Callable[[str], int]:
    """Return a parser of whole numbers from `low` upwards."""

    def value_of(text: str) -> int | None:
        return found if (found := int(text)) >= low else None

    return reads(f"a whole number of at least {low}", value_of)


def as_in_file(rule: Rule, kind: Callable[[str], Any] = float) -> Callable[[str], Any]:
    """Return a parser of numbers of a kind that a rule of case files admits."""
    return reads(rule.expected, lambda text: rule.parse(kind(text)))


degrees = as_in_file(number("a finite number of degrees"))
positive = as_in_file(number("a finite number above 0", low=0.0))


def names_of(known: Iterable[str]) -> Callable[[str], tuple[str, ...]]:
    """Return a parser of names with commas, each one of `known` and none twice; it raises BadInput."""
    choices = tuple(known)

    def value_of(text: str) -> tuple[str, ...] | None:
        given = tuple(text.split(","))
        return given if set(given) <= set(choices) and len(set(given)) == len(given) else None

    return reads(f"one or more of {', '.join(choices)}, each once, separated by commas", value_of)
