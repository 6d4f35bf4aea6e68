"""Refusals of this package: bad parameters, and a solve that stopped, with what it found until then."""

import math
from numbers import Integral
from typing import Any


class InvalidParameter(ValueError):
    """A parameter outside its domain; the message is one line "name: got X, expected Y [unit]"."""

    def __init__(self, name: str, got: object, expected: str) -> None:
        super().__init__(f"{name}: got {got!r}, expected {expected}")
        self.name = name


class ConvergenceError(RuntimeError):
    """A solve that stopped before its end.

    Attributes:
        solution: the converged part (`StaticSolution` or `Trajectory`), last good state last.
        load_factor: fraction of the path (statics) or of the duration (dynamics) that was reached.
        history: dimensionless residual norms, one tuple an attempt, those that failed last.
    """

    def __init__(
        self, message: str, *, solution: Any, load_factor: float, history: tuple[tuple[float, ...], ...]
    ) -> None:
        super().__init__(message)
        self.solution = solution
        self.load_factor = load_factor
        self.history = history


def finite(name: str, value: Any, unit: str) -> float:
    """Return `value` as a float, or refuse it if it is not a finite real number."""
    plain = float_or_same(value)
    try:
        if isinstance(plain, bool) or not isinstance(plain, int | float) or not math.isfinite(plain):
            raise InvalidParameter(name, value, f"a finite number [{unit}]")
    except OverflowError:  # a whole number that no float holds
        raise InvalidParameter(name, value, f"a finite number [{unit}]") from None
    return float(plain)


def several(name: str, value: Any, unit: str) -> list[float]:
    """Return a number, or a sequence of such, as a list of floats; refuse anything else, and none at all."""
    parts = list(value) if isinstance(value, list | tuple) or getattr(value, "ndim", 0) == 1 else [value]
    if not parts:
        raise InvalidParameter(name, value, f"at least one finite number [{unit}]")
    return [finite(name, part, unit) for part in parts]


def positive(name: str, value: Any, unit: str) -> float:
    """Return `value` as a float, or refuse it if it is not finite and above zero."""
    if finite(name, value, unit) <= 0.0:
        raise InvalidParameter(name, value, f"a number above 0 [{unit}]")
    return float(value)


def not_negative(name: str, value: Any, unit: str) -> float:
    """Return `value` as a float, or refuse it if it is not finite or is below zero."""
    if finite(name, value, unit) < 0.0:
        raise InvalidParameter(name, value, f"a number not below 0 [{unit}]")
    return float(value)


def within(name: str, value: Any, low: float, high: float, unit: str) -> float:
    """Return `value` as a float, or refuse it if it is not strictly between `low` and `high`."""
    if not low < finite(name, value, unit) < high:
        raise InvalidParameter(name, value, f"a number between {low:g} and {high:g}, both excluded [{unit}]")
    return float(value)


def count(name: str, value: Any, minimum: int = 1) -> int:
    """Return `value` if it is an integer of at least `minimum`."""
    if isinstance(value, bool) or not isinstance(value, Integral) or value < minimum:
        raise InvalidParameter(name, value, f"an integer of at least {minimum} [1]")
    return int(value)


def choice(name: str, value: Any, known: tuple[str, ...]) -> str:
    """Return `value` if it is one of the names in `known`."""
    if value not in known:
        raise InvalidParameter(name, value, f"one of {', '.join(known)} [name]")
    return str(value)


def pair(name: str, value: Any, unit: str) -> tuple[float, float]:
    """Return `value` as two floats, or refuse it if it is not two finite numbers."""
    parts = list(value) if isinstance(value, list | tuple) or hasattr(value, "tolist") else []
    if len(parts) != 2:
        raise InvalidParameter(name, value, f"two finite numbers [{unit}]")
    return finite(name, float_or_same(parts[0]), unit), finite(name, float_or_same(parts[1]), unit)


def partly(name: str, value: Any, unit: str) -> tuple[float | None, float | None]:
    """Return `value` as two floats, None where it is None, or refuse it if that leaves no finite number."""
    parts = list(value) if isinstance(value, list | tuple) or hasattr(value, "tolist") else []
    if len(parts) != 2 or parts == [None, None]:
        raise InvalidParameter(name, value, f"two finite numbers [{unit}], or one and None where it is free")
    x, y = (None if part is None else finite(name, float_or_same(part), unit) for part in parts)
    return x, y


def float_or_same(value: Any) -> Any:
    """Return a numpy number as a plain one; anything else as it is."""
    return value.item() if getattr(value, "ndim", 1) == 0 else value
