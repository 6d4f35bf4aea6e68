"""Tables to read: columns of numbers with the digits that a design of any size needs, units in the heading.

A column has one SI prefix and as many decimals as its largest value needs for its significant digits; what is
below the last decimal, or below what the solvers resolve, is printed as zero, without a sign.
"""

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import groupby
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from studies.answers.quantities import NOTHING, Scale, fixed

#: Digits of the largest value of a column.
DIGITS = 7
#: Decimals of angles at least, which have no prefix, and what no solver resolves [rad].
ANGLE_DECIMALS, ANGLE_FLOOR = 3, 1e-10


class Column(NamedTuple):
    """One column of a table.

    Attributes:
        name: heading. unit: printed below, prefix included. cells: one a row, as printed.
        group: heading over neighbouring columns.
    """

    name: str
    unit: str
    cells: tuple[str, ...]
    group: str = ""


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
    shown = np.stack([_above(floor, each) for each in values.values()])
    factor, fitting = Scale(heading="", unit=unit, highest=highest).fitting([shown])
    decimals = _decimals(factor * shown, digits)
    return tuple(
        Column(name, fitting.replace("µ", "u"), tuple(fixed(value, decimals) for value in own), group)
        for name, own in zip(values, factor * shown, strict=True)
    )


def by_row(
    scales: Mapping[str, Scale], columns: Sequence[tuple[str, Mapping[str, float]]], digits: int
) -> Iterator[Column]:
    """Yield the columns of a table with a quantity a row, each in the unit that suits it.

    Args:
        scales: of the rows, by key. columns: heading of each column, and its numbers by key.
        digits: significant, of each number.
    """
    values = [np.array([own[key] for _, own in columns]) for key in scales]
    fitted = [scale.fitting([own]) for scale, own in zip(scales.values(), values, strict=True)]
    yield plain("", (scale.heading for scale in scales.values()), left=True)
    yield plain("unit", (unit.replace("µ", "u") for _, unit in fitted))
    shown = [factor * own for (factor, _), own in zip(fitted, values, strict=True)]
    for (heading, _), cells in zip(columns, zip(*shown, strict=True), strict=True):
        yield plain(heading, (significant(each, digits) for each in cells))


def angle(radians: ArrayLike, *, group: str = "") -> Column:
    """Return a column of angles in degrees; radians: values (S,) [rad]."""
    degrees = np.degrees(_above(ANGLE_FLOOR, radians))
    decimals = max(ANGLE_DECIMALS, _decimals(degrees, ANGLE_DECIMALS + 2))
    return Column("rotation", "deg", tuple(fixed(each, decimals) for each in degrees), group)


def plain(name: str, cells: Iterable[str], unit: str = "", *, left: bool = False) -> Column:
    """Return a column of texts, flush right, or flush left where they are words."""
    shown = (name, *cells)
    width = max(map(len, shown)) if left else 0
    name, *texts = (each.ljust(width) for each in shown)
    return Column(name, unit, tuple(texts))


def numbers(name: str, values: Iterable[float], form: str = ".1e") -> Column:
    """Return a column of numbers, of any unit, in a form of Python; a dash for NaN."""
    return plain(name, (f"{each:{form}}" if math.isfinite(each) else NOTHING for each in values))


def significant(value: float, digits: int = DIGITS) -> str:
    """Return a number, of any unit, with its significant digits, for wide columns; a dash for NaN."""
    return f"{value + 0.0:.{digits}g}" if math.isfinite(value) else NOTHING


def one(value: float, digits: int) -> str:
    """Return a number, of any unit, for a sentence, without a power of ten if it is readable; a dash for
    NaN."""
    if not math.isfinite(value):
        return NOTHING
    exponent = math.floor(math.log10(abs(value))) if value else 0
    if -4 <= exponent < 9:
        return f"{value:.{max(0, digits - 1 - exponent)}f}" if value else "0"
    return f"{value:.{digits}g}"


def table(columns: Iterable[Column]) -> Iterator[str]:
    """Yield the lines of a table: groups, headings and units where there are any, then the rows."""
    groups = (_lines(list(own)) for _, own in groupby(columns, lambda column: column.group))
    for parts in zip(*groups, strict=True):
        if line := " | ".join(parts).rstrip(" |"):
            yield line


def _lines(columns: Sequence[Column]) -> list[str]:
    """Return the lines of neighbouring columns of one group, flush right below its name."""
    texts = [(each.name, each.unit, *each.cells) for each in columns]
    widths = [max(map(len, own)) for own in texts]
    rows = [map(str.rjust, row, widths) for row in zip(*texts, strict=True)]
    lines = [columns[0].group, *map("  ".join, rows)]
    width = max(map(len, lines))
    return [line.rjust(width) for line in lines]


def _above(floor: float, values: ArrayLike) -> np.ndarray:
    """Return the values as floats, zero where they are below the floor."""
    found = np.atleast_1d(np.asarray(values, dtype=float))
    return np.where(np.abs(found) < floor, 0.0, found)


def _decimals(values: np.ndarray, digits: int) -> int:
    """Return the decimals of so many significant digits of the largest value; of zero alone one."""
    largest = float(np.nanmax(np.abs(values), initial=0.0))
    return 1 if largest == 0.0 else max(0, digits - 1 - math.floor(math.log10(largest)))
