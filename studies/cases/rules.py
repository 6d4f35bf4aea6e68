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


@dataclass(frozen=True, kw_only=True)
class Number:
    """A finite number in an interval, whose ends are excluded unless closed, converted to SI by `to_si`."""

    expected: str
    low: float = -math.inf
    high: float = math.inf
    closed_low: bool = False
    closed_high: bool = False
    to_si: Callable[[float], float] = _same
    from_si: Callable[[float], float] = _same

    def parse(self, value: Any) -> float:
        """Return `value` (in the file's unit) in SI; ValueError says what was got and expected."""
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise ValueError(f"got {shown(value)}, expected {self.expected}")
        number = _as_float(value)
        above = number >= self.low if self.closed_low else number > self.low
        below = number <= self.high if self.closed_high else number < self.high
        if not (math.isfinite(number) and above and below):
            raise ValueError(f"got {shown(value)}, expected {self.expected}")
        return self.to_si(number)

    def verify(self, value: Any) -> None:
        """Raise ValueError unless `value` (SI) is admissible."""
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise ValueError(f"got {shown(value)}, expected {self.expected}")
        self.parse(self.from_si(_as_float(value)))


@dataclass(frozen=True, kw_only=True)
class _Parsed:
    """A rule whose values in SI are those of the file."""

    def parse(self, value: Any) -> Any:
        """Return `value` as it is kept; raises ValueError that says what was got and expected."""
        raise NotImplementedError

    def verify(self, value: Any) -> None:
        """Raise ValueError unless `value` is admissible."""
        self.parse(value)


@dataclass(frozen=True, kw_only=True)
class Whole(_Parsed):
    """A whole number from `low` to `high`, both included."""

    expected: str
    low: int
    high: int

    def parse(self, value: Any) -> int:
        """Return `value`; raises ValueError that says what was got and expected."""
        if isinstance(value, bool) or not isinstance(value, int) or not self.low <= value <= self.high:
            raise ValueError(f"got {shown(value)}, expected {self.expected}")
        return value


@dataclass(frozen=True, kw_only=True)
class Pair(_Parsed):
    """Two finite numbers [x, y]."""

    expected: str

    def parse(self, value: Any) -> tuple[float, float]:
        """Return `value` as a tuple; raises ValueError that says what was got and expected."""
        if not isinstance(value, list | tuple) or len(value) != 2:
            raise ValueError(f"got {shown(value)}, expected {self.expected}")
        for part in value:
            if (
                isinstance(part, bool)
                or not isinstance(part, int | float)
                or not math.isfinite(_as_float(part))
            ):
                raise ValueError(f"got {shown(value)}, expected {self.expected}")
        return float(value[0]), float(value[1])


@dataclass(frozen=True, kw_only=True)
class FreePair(Pair):
    """Two finite numbers [x, y], or one of them and "free" in place of the other, which is then None."""

    def parse(self, value: Any) -> tuple[float | None, float | None]:  # type: ignore[override]
        """Return `value` as a tuple; raises ValueError that says what was got and expected."""
        parts = list(value) if isinstance(value, list | tuple) else []
        free = [part in (FREE, None) for part in parts]
        if not any(free) or all(free):
            return super().parse(value)
        x, y = super().parse([0.0 if is_free else part for part, is_free in zip(parts, free, strict=True)])
        return (None, y) if free[0] else (x, None)


@dataclass(frozen=True, kw_only=True)
class Text(_Parsed):
    """A text that is not empty."""

    expected: str

    def parse(self, value: Any) -> str:
        """Return `value`; raises ValueError that says what was got and expected."""
        if not isinstance(value, str) or not value:
            raise ValueError(f"got {shown(value)}, expected {self.expected}")
        return value


@dataclass(frozen=True, kw_only=True)
class NumberOr(_Parsed):
    """A number, or one word in its place."""

    expected: str
    word: str
    number: Number

    def parse(self, value: Any) -> float | str:
        """Return `value`; raises ValueError that says what was got and expected."""
        if value == self.word:
            return self.word
        try:
            return self.number.parse(value)
        except ValueError:
            raise ValueError(f"got {shown(value)}, expected {self.expected}") from None


@dataclass(frozen=True, kw_only=True)
class Choice(_Parsed):
    """One of some names."""

    names: tuple[str, ...]

    @property
    def expected(self) -> str:
        """The names."""
        return "one of " + ", ".join(f'"{name}"' for name in self.names)

    def parse(self, value: Any) -> str:
        """Return `value`; raises ValueError that says what was got and expected."""
        if value not in self.names:
            raise ValueError(f"got {shown(value)}, expected {self.expected}")
        return str(value)


@dataclass(frozen=True, kw_only=True)
class History(_Parsed):
    """Pairs [time in s, factor] in order of time."""

    expected: str = "pairs [time, factor] with increasing times [s]"

    def parse(self, value: Any) -> tuple[tuple[float, float], ...]:
        """Return `value` as tuples; raises ValueError that says what was got and expected."""
        if not isinstance(value, list | tuple) or not value:
            raise ValueError(f"got {shown(value)}, expected {self.expected}")
        points = tuple(Pair(expected=self.expected).parse(point) for point in value)
        if any(after[0] <= before[0] for before, after in pairwise(points)):
            raise ValueError(f"got {shown(value)}, expected {self.expected}")
        return points


@dataclass(frozen=True, kw_only=True)
class Interval(_Parsed):
    """Two instants [begin, end]."""

    expected: str = "two instants [begin, end], the first before the second [s]"

    def parse(self, value: Any) -> tuple[float, float]:
        """Return `value` as a tuple; raises ValueError that says what was got and expected."""
        begin, end = Pair(expected=self.expected).parse(value)
        if not begin < end:
            raise ValueError(f"got {shown(value)}, expected {self.expected}")
        return begin, end


Rule = Number | NumberOr | Whole | Pair | Text | Choice | History | Interval


@dataclass(frozen=True, kw_only=True)
class Key:
    """One key of a case file: what is read, refused, shown in a template and told on the page of case files.

    Args:
        section: table that it stands in; name: in the file; attribute: or parameter that it fills.
        rule: for its value. optional: whether it may be left out.
        meaning: what it is, in a few words. default: what holds where it is left out.
        example: a value that a template may show, as it stands in the file.
    """

    section: str
    name: str
    attribute: str
    rule: Rule
    optional: bool = False
    meaning: str
    default: str = ""
    example: str

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
    return tuple(
        Key(
            section=section,
            name=name,
            attribute=attribute,
            rule=rule,
            optional=bool(default),
            meaning=meaning,
            default=default,
            example=example,
        )
        for name, attribute, rule, default, example, meaning in rows
    )


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
