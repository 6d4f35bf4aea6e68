"""Rules for the values of a case file: type, admissible range, and what they are in SI units."""

import math
import re
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

#: What stands in place of a number that is not prescribed.
FREE = "free"
#: Bits of the longest whole number that an error shows in full.
LONGEST = 64


def _same(value: float) -> float:
    return float(value)


class _Refused(Exception):
    """A value that a rule does not admit."""


@dataclass(frozen=True, kw_only=True)
class Rule:
    """What a value of a case file may be.

    Attributes:
        expected: what a refusal says. read: makes of a value what is kept.
    """

    expected: str
    read: Callable[[Any], Any]

    def parse(self, value: Any) -> Any:
        """Return `value` (in the file's unit) as it is kept, in SI; ValueError says what was got and
        expected."""
        try:
            return self.read(value)
        except _Refused:
            raise ValueError(f"got {shown(value)}, expected {self.expected}") from None

    def verify(self, value: Any) -> None:
        """Raise ValueError unless `value` (in SI) is admissible."""
        self.parse(value)


@dataclass(frozen=True, kw_only=True)
class Number(Rule):
    """A finite number in an interval, whose ends are excluded unless closed, converted to SI by `to_si`."""

    read: Callable[[Any], Any] = _same
    low: float = -math.inf
    high: float = math.inf
    closed_low: bool = False
    closed_high: bool = False
    to_si: Callable[[float], float] = _same
    from_si: Callable[[float], float] = _same

    def parse(self, value: Any) -> float:
        """Return `value` (in the file's unit) in SI; ValueError says what was got and expected."""
        if _is_number(value):
            number = _as_float(value)
            above = number >= self.low if self.closed_low else number > self.low
            below = number <= self.high if self.closed_high else number < self.high
            if math.isfinite(number) and above and below:
                return self.to_si(number)
        raise ValueError(f"got {shown(value)}, expected {self.expected}")

    def verify(self, value: Any) -> None:
        """Raise ValueError unless `value` (SI) is admissible."""
        self.parse(self.from_si(_as_float(value)) if _is_number(value) else value)


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _pair(value: Any) -> tuple[float, float]:
    if not isinstance(value, list | tuple) or len(value) != 2:
        raise _Refused
    if not all(_is_number(part) and math.isfinite(_as_float(part)) for part in value):
        raise _Refused
    return float(value[0]), float(value[1])


@dataclass(frozen=True, kw_only=True)
class Pair(Rule):
    """Two finite numbers [x, y], or what `read` makes of two."""

    read: Callable[[Any], Any] = _pair


def free_pair(unit: str) -> Pair:
    """Return the rule for two finite numbers, or one of them and "free" in place of the other, which is then
    None."""

    def read(value: Any) -> tuple[float | None, float | None]:
        parts = list(value) if isinstance(value, list | tuple) else []
        free = [part in (FREE, None) for part in parts]
        if not any(free) or all(free):
            return _pair(value)
        x, y = _pair([0.0 if is_free else part for part, is_free in zip(parts, free, strict=True)])
        return (None, y) if free[0] else (x, None)

    return Pair(expected=f'two finite numbers [x, y], one of them or "free" [{unit}]', read=read)


def _text(value: Any) -> str:
    if not isinstance(value, str) or not value:
        raise _Refused
    return value


@dataclass(frozen=True, kw_only=True)
class Text(Rule):
    """A text that is not empty."""

    read: Callable[[Any], Any] = _text


class Choice(Rule):
    """One of some names."""


def choice(*names: str) -> Choice:
    """Return the rule for one of these names."""

    def read(value: Any) -> str:
        if value not in names:
            raise _Refused
        return str(value)

    return Choice(expected="one of " + ", ".join(f'"{name}"' for name in names), read=read)


def whole(low: int, high: int) -> Rule:
    """Return the rule for a whole number between these, both included."""

    def read(value: Any) -> int:
        if not isinstance(value, int) or isinstance(value, bool) or not low <= value <= high:
            raise _Refused
        return value

    return Rule(expected=f"a whole number from {low} to {high}", read=read)


def number_or(word: str, number: Number) -> Rule:
    """Return the rule for a number, or one word in its place."""

    def read(value: Any) -> float | str:
        try:
            return word if value == word else number.parse(value)
        except ValueError:
            raise _Refused from None

    return Rule(expected=f'"{word}" or {number.expected}', read=read)


def _history(value: Any) -> tuple[tuple[float, float], ...]:
    if not isinstance(value, list | tuple) or not value:
        raise _Refused
    points = tuple(Pair(expected=HISTORY.expected).parse(point) for point in value)
    if any(after[0] <= before[0] for before, after in pairwise(points)):
        raise _Refused
    return points


def _interval(value: Any) -> tuple[float, float]:
    begin, end = _pair(value)
    if not begin < end:
        raise _Refused
    return begin, end


def _truth(value: Any) -> bool:
    if not isinstance(value, bool):
        raise _Refused
    return value


#: A truth value; pairs [time in s, factor] in order of time; two instants.
TRUTH = Rule(expected="true or false", read=_truth)
HISTORY = Rule(expected="pairs [time, factor] with increasing times [s]", read=_history)
INTERVAL = Rule(expected="two instants [begin, end], the first before the second [s]", read=_interval)


@dataclass(frozen=True)
class Key:
    """One key of a case file: what is read, refused, shown in a template and told on the page of case files.

    Args:
        section: table that it stands in; name: in the file; attribute: or parameter that it fills.
        rule: for its value. default: what holds where it is left out.
        example: a value that a template may show, as it stands in the file.
        meaning: what it is, in a few words. optional: whether it may be left out.
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
        """Unit of the value in the file, "" of one that has none."""
        found = re.search(r"\[([^\[\]]+)\]$", self.rule.expected)
        return found[1] if found else ""

    @property
    def admitted(self) -> str:
        """What the rule admits, without the unit."""
        return self.rule.expected.removesuffix(f" [{self.unit}]")


def keys_of(section: str, *rows: tuple[str, str, Rule, str, str, str]) -> tuple[Key, ...]:
    """Return the keys of a table of a case file.

    Args:
        section: name of the table.
        rows: of each key its name in the file, attribute, rule, default ("" of one that is needed), example
            and meaning.
    """
    return tuple(Key(section, *row, optional=bool(row[3])) for row in rows)


def _as_float(value: float) -> float:
    """Return a number as a float: infinite where a whole number is beyond the range of floats."""
    try:
        return float(value)
    except OverflowError:
        return math.inf if value > 0 else -math.inf


def shown(value: Any) -> str:
    """Return `value` as it stands in a TOML file, with its type where that is the likely mistake.

    A whole number that fills lines, which Python does not even write, is told by its size.
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


def positive(unit: str) -> Number:
    """Return the rule for a positive number of that unit."""
    return Number(expected=f"a positive number [{unit}]", low=0.0)


def not_negative(unit: str) -> Number:
    """Return the rule for a number of that unit that is not below zero."""
    return Number(expected=f"a number of at least 0 [{unit}]", low=0.0, closed_low=True)


def finite(unit: str) -> Number:
    """Return the rule for any finite number of that unit."""
    return Number(expected=f"a finite number [{unit}]")


def finite_pair(unit: str) -> Pair:
    """Return the rule for two finite numbers of that unit."""
    return Pair(expected=f"two finite numbers [x, y] [{unit}]")
