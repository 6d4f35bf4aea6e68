"""Rules for the values of a case file: type, admissible range, and what they are in SI units."""

import math
import re
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

from studies.errors import BadInput

#: What stands in place of a number that is not prescribed.
FREE = "free"
#: Bits of the longest whole number that an error shows in full.
LONGEST = 64


@dataclass(frozen=True, kw_only=True)
class Rule:
    """Admissible values of a key of a case file.

    Attributes:
        expected: phrase of error messages. admits: whether a value may stand in a file.
        read: converts an admitted value to SI; in_file: the inverse.
        kind: "number", "pair", "text" or "choice"; "" for others.
    """

    expected: str
    admits: Callable[[Any], bool] = lambda value: True
    read: Callable[[Any], Any] = lambda value: value
    in_file: Callable[[Any], Any] = lambda value: value
    kind: str = ""

    def parse(self, value: Any) -> Any:
        """Return `value` (in the file's unit) in SI; BadInput with the given and the expected value."""
        if not self.admits(value):
            raise BadInput(f"got {shown(value)}, expected {self.expected}")
        return self.read(value)


def number(
    expected: str,
    low: float = -math.inf,
    high: float = math.inf,
    *,
    closed: str = "",
    degrees: bool = False,
) -> Rule:
    """Return the rule for a finite number in an interval.

    Args:
        expected: phrase of error messages. low, high: ends, excluded unless `closed` names them.
        closed: "low", "high" or "low and high".
        degrees: whether the file has the angle in degrees; the value is in radians.
    """

    def admits(value: Any) -> bool:
        if not _is_number(value):
            return False
        above = low < value or ("low" in closed and low == value)
        below = value < high or ("high" in closed and value == high)
        return above and below

    def read(value: float) -> float:
        return math.radians(value) if degrees else float(value)

    def in_file(value: Any) -> Any:
        return math.degrees(value) if degrees and _is_number(value) else value

    return Rule(expected=expected, admits=admits, read=read, in_file=in_file, kind="number")


def _is_number(value: Any) -> bool:
    """Whether a value is a finite number; a whole number beyond the range of floats is none."""
    if not isinstance(value, int | float) or isinstance(value, bool):
        return False
    try:
        return math.isfinite(value)
    except OverflowError:
        return False


def positive(unit: str) -> Rule:
    """Return the rule for a positive number of that unit."""
    return number(f"a positive number [{unit}]", low=0.0)


def not_negative(unit: str) -> Rule:
    """Return the rule for a number of that unit that is not below zero."""
    return number(f"a number of at least 0 [{unit}]", low=0.0, closed="low")


def finite(unit: str) -> Rule:
    """Return the rule for any finite number of that unit."""
    return number(f"a finite number [{unit}]")


def number_or(word: str, other: Rule) -> Rule:
    """Return the rule for a number, or one word in its place."""
    return Rule(
        expected=f'"{word}" or {other.expected}',
        admits=lambda value: value == word or other.admits(value),
        read=lambda value: word if value == word else other.read(value),
    )


def whole(low: int, high: int) -> Rule:
    """Return the rule for a whole number between these, both included."""
    return Rule(
        expected=f"a whole number from {low} to {high}",
        admits=lambda value: isinstance(value, int) and not isinstance(value, bool) and low <= value <= high,
    )


def text(expected: str) -> Rule:
    """Return the rule for a text that is not empty."""
    return Rule(expected=expected, admits=lambda value: isinstance(value, str) and value != "", kind="text")


def choice(*names: str) -> Rule:
    """Return the rule for one of these names."""
    expected = "one of " + ", ".join(f'"{name}"' for name in names)
    return Rule(expected=expected, admits=lambda value: value in names, kind="choice")


def _is_pair(value: Any) -> bool:
    return isinstance(value, list | tuple) and len(value) == 2 and all(map(_is_number, value))


def _pair(value: Any) -> tuple[float, float]:
    return float(value[0]), float(value[1])


def finite_pair(unit: str) -> Rule:
    """Return the rule for two finite numbers of that unit."""
    return Rule(expected=f"two finite numbers [x, y] [{unit}]", admits=_is_pair, read=_pair, kind="pair")


def free_pair(unit: str) -> Rule:
    """Return the rule for two finite numbers of that unit, one of which may be "free", which is read as
    None."""

    def read(value: Any) -> tuple[float | None, ...]:
        return tuple(None if part in (FREE, None) else float(part) for part in value)

    def admits(value: Any) -> bool:
        given = (
            [part for part in value if part not in (FREE, None)] if isinstance(value, list | tuple) else []
        )
        return bool(given) and len(value) == 2 and all(map(_is_number, given))

    expected = f'two finite numbers [x, y], one of them or "free" [{unit}]'
    return Rule(expected=expected, admits=admits, read=read, kind="pair")


def _is_history(value: Any) -> bool:
    given = isinstance(value, list | tuple) and value and all(map(_is_pair, value))
    return bool(given) and all(before[0] < after[0] for before, after in pairwise(value))


#: A truth value; pairs [time in s, factor] in order of time; two instants [s].
TRUTH = Rule(expected="true or false", admits=lambda value: isinstance(value, bool))


def some_of(*names: str) -> Rule:
    """Return the rule for a list of some of these names, each at most once."""

    def admits(value: Any) -> bool:
        given = isinstance(value, list | tuple) and value and all(each in names for each in value)
        return bool(given) and len(set(value)) == len(value)

    listed = ", ".join(f'"{name}"' for name in names)
    return Rule(expected=f"a list of some of {listed}", admits=admits, read=tuple)


HISTORY = Rule(
    expected="pairs [time, factor] with increasing times [s]",
    admits=_is_history,
    read=lambda value: tuple(map(_pair, value)),
)
INTERVAL = Rule(
    expected="two instants [begin, end], the first before the second [s]",
    admits=lambda value: _is_pair(value) and value[0] < value[1],
    read=_pair,
)


@dataclass(frozen=True)
class Key:
    """One key of a case file: its rule, default, example and meaning.

    Args:
        section: table that contains it; name: in the file; attribute: or parameter that it fills.
        rule: for its value. default: its meaning if the key is omitted.
        example: a value that a template may show, as in the file.
        meaning: in a few words. optional: whether it may be omitted.
    """

    section: str
    name: str
    attribute: str
    rule: Rule
    default: str = ""
    example: str = ""
    meaning: str = ""
    optional: bool = False

    @property
    def unit(self) -> str:
        """Unit of the value in the file; "" for a value without unit."""
        found = re.search(r"\[([^\[\]]+)\]$", self.rule.expected)
        return found[1] if found else ""

    @property
    def admitted(self) -> str:
        """Admissible values without the unit."""
        return self.rule.expected.removesuffix(f" [{self.unit}]")


def keys_of(section: str, *rows: tuple[str, str, Rule, str, str, str]) -> tuple[Key, ...]:
    """Return the keys of a table of a case file.

    Args:
        section: name of the table.
        rows: for each key its name in the file, attribute, rule, default ("" if it is required), example and
            meaning.
    """
    return tuple(Key(section, *row, optional=bool(row[3])) for row in rows)


def shown(value: Any) -> str:
    """Return `value` as in a TOML file, with its type if the type is the likely mistake.

    A whole number with very many digits is described by its size.
    """
    if isinstance(value, str):
        return f'the text "{value}"'
    if isinstance(value, bool):
        return f"the truth value {str(value).lower()}"
    if isinstance(value, int) and value.bit_length() > LONGEST:
        return f"a whole number of about {round(value.bit_length() * math.log10(2.0))} digits"
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(_part, value))}]"
    return str(value)


def _part(value: Any) -> str:
    return repr(value) if isinstance(value, str) else shown(value)
