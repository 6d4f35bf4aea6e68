"""How a number is written in the report: digits, powers of ten, units."""

import math
from collections.abc import Callable
from typing import Any

import pandas as pd

#: Turns a value into text.
Form = Callable[[Any], str]

_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
#: A space that does not break.
SPACE = "\u00a0"
MINUS = "\u2212"


def significant(value: Any, digits: int = 2) -> str:
    """Return `value` with so many significant digits, in powers of ten when it is tiny or huge."""
    value = float(value)
    if value == 0.0:
        return "0"
    exponent = int(f"{abs(value):.{digits - 1}e}".partition("e")[2])
    if -4 < exponent < 6:
        text = f"{round(value, digits - 1 - exponent):.{max(0, digits - 1 - exponent)}f}"
    else:
        text = f"{value / 10.0**exponent:.{digits - 1}f}{SPACE}×{SPACE}{_ten(exponent)}"
    return text.replace("-", MINUS)


def _ten(exponent: int) -> str:
    return f"10{str(exponent).translate(_RAISED)}"


def decade(value: Any) -> str:
    """Return a power of ten, or a number of one digit times one."""
    exponent = round(math.log10(float(value)))
    if math.isclose(float(value), 10.0**exponent, rel_tol=1e-9):
        return _ten(exponent)
    return significant(value, 1)


def percent(value: Any) -> str:
    """Return a ratio in percent with two digits, from a hundred on whole; below 0.01 % as a power of ten."""
    if 0.0 < abs(float(value)) < 1e-4:
        return significant(value)
    share = 100.0 * float(value)
    return f"{significant(share, max(2, len(str(int(abs(share))))))}{SPACE}%"


def signed_percent(value: Any) -> str:
    """Return a ratio in percent with its sign."""
    return ("+" if float(value) > 0.0 else "") + percent(value)


def times(value: Any) -> str:
    """Return a ratio as a factor."""
    return f"{significant(value)}{SPACE}×"


def count(value: Any) -> str:
    """Return a whole number, in groups of three digits.

    Raises:
        ValueError: it is not whole.
    """
    if float(value) != int(value):
        raise ValueError(f"{value} is not a whole number")
    text = str(int(value))
    return f"{int(value):,}".replace(",", "\u202f") if len(text) > 4 else text


def unit(name: str, digits: int = 2, scale: float = 1.0) -> Form:
    """Return a form that writes the value times `scale` with its unit."""
    return lambda value: f"{significant(scale * float(value), digits)}{SPACE}{name}"


def seconds(value: Any) -> str:
    """Return a time in the unit that suits its size."""
    for name, scale in (("s", 1.0), ("ms", 1e3), ("µs", 1e6)):
        if float(value) * scale >= 0.1:
            return unit(name, 2, scale)(value)
    return unit("ns", 2, 1e9)(value)


def digits(number: int) -> Form:
    """Return a form that writes so many significant digits."""
    return lambda value: significant(value, number)


def angle(value: Any) -> str:
    """Return an angle given in degrees."""
    return f"{significant(value)}°"


def dash(form: Form) -> Form:
    """Return a form that writes a dash for an empty cell."""
    return lambda value: "–" if pd.isna(value) else form(value)


def degrees(value: Any) -> str:
    """Return an angle given in radians in degrees."""
    return f"{math.degrees(float(value)):.3g}°"
