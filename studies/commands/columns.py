"""Tables to read: columns of numbers with the digits that a design of any size needs, units in the heading.

A column has one SI prefix and as many decimals as its largest value needs for its significant digits; what is
below the last decimal, or below what the solvers resolve, is printed as zero, without a sign.
"""

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import groupby

import numpy as np
from numpy.typing import ArrayLike

from studies.answers.quantities import NOTHING, PREFIXES, fixed, power_of

#: Digits of the largest value of a column.
DIGITS = 7
#: Decimals of angles at least, which have no prefix, and what no solver resolves [rad].
ANGLE_DECIMALS, ANGLE_FLOOR = 3, 1e-10


@dataclass(frozen=True, kw_only=True)
class Column:
    """One column of a table.

    Attributes:
        name: heading. unit: printed below, prefix included. cells: one a row, as printed.
        group: heading over neighbouring columns.
    """

    name: str
    unit: str
    cells: tuple[str, ...]
    group: str = ""

    @property
    def width(self) -> int:
        """Characters that the column needs."""
        return max(map(len, (self.name, self.unit, *self.cells)))


def quantity(
    unit: str,
    *,
    floor: float = 0.0,
    highest: int = 0,
    digits: int = DIGITS,
    group: str = "",
    **values: ArrayLike,
) -> tuple[Column, ...]:
    """Return columns of one quantity, with one prefix and the same decimals.

    Args:
        unit: SI, as "N m". floor: what is below it in magnitude is zero, in that unit.
        highest: power of ten of the largest prefix; 0 for none above one.
        digits: significant, of the largest value.
        group: heading over the columns.
        **values: of each column by its heading; NaN where there is none.
    """
    shown, scaled = _prefixed(unit, np.stack([_above(floor, each) for each in values.values()]), highest)
    decimals = _decimals(_largest(scaled), digits)
    rows = [tuple(fixed(value, decimals) for value in each) for each in scaled]
    pairs = zip(values, rows, strict=True)
    return tuple(Column(name=name, unit=shown, cells=cells, group=group) for name, cells in pairs)


def wide(unit: str, digits: int, *, floor: float = 0.0, **values: ArrayLike) -> tuple[Column, ...]:
    """Return columns (S,) over many powers of ten: every number has its significant digits, a column a
    prefix.

    unit: SI unit of the values. digits: significant ones [1]. floor: smaller magnitudes print as zero.
    """
    columns = []
    for name, value in values.items():
        shown, scaled = _prefixed(unit, _above(floor, value), 6)
        cells = tuple(one(each, digits) for each in scaled)
        columns.append(Column(name=name, unit=shown, cells=cells))
    return tuple(columns)


def _prefixed(unit: str, values: np.ndarray, highest: int) -> tuple[str, np.ndarray]:
    """Return a unit with a prefix, of a power of ten of `highest` at most, and the values in it.

    Of the largest value it leaves three digits before the point at most.
    """
    power = power_of(_largest(values), highest)
    return PREFIXES[power].replace("µ", "u") + unit, values / 10.0**power


def angle(radians: ArrayLike, *, group: str = "") -> Column:
    """Return a column of angles in degrees; radians: values (S,) [rad]."""
    degrees = np.degrees(_above(ANGLE_FLOOR, radians))
    decimals = max(ANGLE_DECIMALS, _decimals(_largest(degrees), ANGLE_DECIMALS + 2))
    cells = tuple(fixed(each, decimals) for each in degrees)
    return Column(name="rotation", unit="deg", cells=cells, group=group)


def plain(name: str, cells: Iterable[str], unit: str = "") -> Column:
    """Return a column of texts."""
    return Column(name=name, unit=unit, cells=tuple(cells))


def significant(value: float, digits: int = DIGITS) -> str:
    """Return a number, of any unit, with its significant digits, for wide columns; a dash for NaN."""
    return f"{value + 0.0:.{digits}g}" if math.isfinite(value) else NOTHING


def cell(value: float, width: int, form: str = ".1e", sign: str = "") -> str:
    """Return a number, of any unit, right-aligned in `width` characters; a dash for NaN."""
    return f"{value:{sign}{width}{form}}" if math.isfinite(value) else f"{NOTHING:>{width}}"


def one(value: float, digits: int) -> str:
    """Return a number, of any unit, for a sentence, without a power of ten if it is readable; a dash for
    NaN."""
    if not math.isfinite(value):
        return NOTHING
    exponent = math.floor(math.log10(abs(value))) if value else 0
    if -4 <= exponent < 9:
        return f"{value:.{max(0, digits - 1 - exponent)}f}" if value else "0"
    return f"{value:.{digits}g}"


def table(columns: Sequence[Column]) -> Iterator[str]:
    """Yield the lines of a table: groups where there are any, headings, units, rows; all flush right."""
    columns = [
        each for _, group in groupby(columns, lambda column: column.group) for each in _wide(list(group))
    ]
    heads = [[column.name for column in columns], [column.unit for column in columns]]
    rows = zip(*(column.cells for column in columns), strict=True)
    if any(column.group for column in columns):
        yield from _groups(columns)
    for cells in (*heads, *rows):
        yield "".join(_cell(columns, place, text) for place, text in enumerate(cells))


def _wide(group: list[Column]) -> list[Column]:
    """Return the columns of a group, the first of them so wide that the name of the group fits over them."""
    first, *others = group
    missing = len(first.group) - sum(each.width + 2 for each in others) - first.width
    return [replace(first, unit=first.unit.rjust(first.width + max(missing, 0))), *others]


def _groups(columns: Sequence[Column]) -> Iterator[str]:
    """Yield the line of the groups, each flush right over its columns."""
    line, span = "", 0
    for place, column in enumerate(columns):
        line += _cell(columns, place, "")
        span = span + 2 + column.width if place and columns[place - 1].group == column.group else column.width
        last = place + 1 == len(columns) or columns[place + 1].group != column.group
        if last:
            line = f"{line[:-span]}{column.group:>{span}}"
    yield line


def _cell(columns: Sequence[Column], place: int, text: str) -> str:
    """Return a cell with the space before it; a group begins with a line."""
    column = columns[place]
    first = place > 0 and column.group != columns[place - 1].group
    gap = " | " if first else ("  " if place else "")
    return f"{gap}{text:>{column.width}}"


def _above(floor: float, values: ArrayLike) -> np.ndarray:
    """Return the values as floats, zero where they are below the floor."""
    found = np.atleast_1d(np.asarray(values, dtype=float))
    return np.where(np.abs(found) < floor, 0.0, found)


def _largest(values: np.ndarray) -> float:
    return float(np.nanmax(np.abs(values), initial=0.0))


def _decimals(largest: float, digits: int) -> int:
    """Return the decimals of so many significant digits of the largest value; of zero alone one."""
    return 1 if largest == 0.0 else max(0, digits - 1 - math.floor(math.log10(largest)))
