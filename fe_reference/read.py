"""Values that a user gives: each is read by its name, or refused in one line; and a solve that stopped."""

import math
from collections.abc import Callable, Sequence
from dataclasses import fields
from itertools import pairwise
from numbers import Integral
from typing import Any

#: Residual norms of iterations, one tuple an attempt.
Norms = tuple[tuple[float, ...], ...]
Pair = tuple[float, float]
History = tuple[Pair, ...]


class InvalidParameter(ValueError):
    """A parameter outside its domain; the message is one line "name: got X, expected Y [unit]".

    Examples
    --------
    >>> try:
    ...     BodyDesign(name="tip", centre=(0.1, 0.0), mass=-1.0)
    ... except InvalidParameter as refusal:
    ...     print(refusal)
    mass: got -1.0, expected a number not below 0 [kg]
    """

    def __init__(self, name: str, got: object, expected: str) -> None:
        super().__init__(name, got, expected)  # of which another process makes it again
        self.name = name

    def __str__(self) -> str:
        name, got, expected = self.args
        return f"{name}: got {got!r}, expected {expected}"


class ConvergenceError(RuntimeError):
    """A solve that stopped before its end.

    Attributes:
        solution: the converged part (`StaticSolution` or `Trajectory`), last good state last.
        load_factor: fraction of the path (statics) or of the duration (dynamics) that was reached.
        history: dimensionless residual norms, one tuple an attempt, those that failed last.
    """

    def __init__(
        self, message: str, *, solution: Any = None, load_factor: float = 0.0, history: Norms = ()
    ) -> None:
        super().__init__(message)
        self.solution = solution
        self.load_factor = load_factor
        self.history = history


class Checked:
    """A frozen dataclass that reads its fields as they are annotated, or refuses them by their names.

    `mass: Annotated[float, positive, "kg"]` is read by `positive("mass", mass, "kg")`.
    """

    def __post_init__(self) -> None:
        for each in fields(self):  # type: ignore[arg-type]  # every subclass is a dataclass
            read, *domain = getattr(each.type, "__metadata__", (None,))
            if read is not None:
                object.__setattr__(self, each.name, read(each.name, getattr(self, each.name), *domain))


def refuse(wrong: Any, name: str, got: object, expected: str) -> None:
    """Refuse a value that is wrong.

    Raises:
        InvalidParameter: it is.
    """
    if wrong:
        raise InvalidParameter(name, got, expected)


def finite(name: str, value: Any, unit: str) -> float:
    """Return `value` as a float.

    Args:
        name, unit: for the message. value: in `unit`.

    Raises:
        InvalidParameter: anything but a finite real number.
    """
    plain = value.item() if getattr(value, "ndim", 1) == 0 else value  # a number of numpy's
    try:
        if isinstance(plain, bool) or not isinstance(plain, int | float) or not math.isfinite(plain):
            raise InvalidParameter(name, plain, f"a finite number [{unit}]")
    except OverflowError:  # a whole number that no float holds
        raise InvalidParameter(name, value, f"a finite number [{unit}]") from None
    return float(plain)


def positive(name: str, value: Any, unit: str) -> float:
    """Return `value` (in `unit`) as a float; InvalidParameter unless it is finite and above zero."""
    refuse(finite(name, value, unit) <= 0.0, name, value, f"a number above 0 [{unit}]")
    return float(value)


def not_negative(name: str, value: Any, unit: str) -> float:
    """Return `value` (in `unit`) as a float; InvalidParameter unless it is finite and not below zero."""
    refuse(finite(name, value, unit) < 0.0, name, value, f"a number not below 0 [{unit}]")
    return float(value)


def within(name: str, value: Any, low: float, high: float, unit: str) -> float:
    """Return `value` (in `unit`) as a float; InvalidParameter unless it is strictly between `low` and
    `high`."""
    if not low < finite(name, value, unit) < high:
        raise InvalidParameter(name, value, f"a number between {low:g} and {high:g}, both excluded [{unit}]")
    return float(value)


def count(name: str, value: Any, minimum: int = 1) -> int:
    """Return `value`; InvalidParameter unless it is an integer of at least `minimum`."""
    if isinstance(value, bool) or not isinstance(value, Integral) or value < minimum:
        raise InvalidParameter(name, value, f"an integer of at least {minimum} [1]")
    return int(value)


def require_kind(name: str, value: Any, kind: type, expected: str) -> None:
    """Check that a value is of a kind; a value whose text is too long is named by its own kind.

    Raises:
        InvalidParameter: it is of another kind.
    """
    if not isinstance(value, kind):
        told = value if value is None or isinstance(value, int | float | str | dict) else type(value).__name__
        raise InvalidParameter(name, told, expected)


def choice(name: str, value: Any, known: tuple[str, ...]) -> str:
    """Return `value`; InvalidParameter unless it is one of the names in `known`."""
    refuse(value not in known, name, value, f"one of {', '.join(known)} [name]")
    return str(value)


def flag(name: str, value: Any) -> bool:
    """Return `value`; InvalidParameter unless it is True or False."""
    require_kind(name, value, bool, "True or False")
    return bool(value)


def optional(name: str, value: Any, read: Callable[..., Any], *domain: object) -> Any:
    """Return None for None, and otherwise `read(name, value, *domain)`; InvalidParameter as of `read`."""
    return None if value is None else read(name, value, *domain)


def _parts(value: Any) -> list[Any]:
    """Return the parts of a sequence or of an array; of anything else that alone."""
    return list(value) if isinstance(value, list | tuple) or getattr(value, "ndim", 0) > 0 else [value]


def several(name: str, value: Any, unit: str) -> list[float]:
    """Return a number, or a sequence of numbers (in `unit`), as a list of floats.

    Raises:
        InvalidParameter: anything else, or an empty sequence.
    """
    parts = _parts(value)
    refuse(not parts, name, value, f"at least one finite number [{unit}]")
    return [finite(name, part, unit) for part in parts]


def pair(name: str, value: Any, unit: str) -> Pair:
    """Return `value` (2,) (in `unit`) as two floats; InvalidParameter unless it is two finite numbers."""
    parts = _parts(value)
    refuse(len(parts) != 2, name, value, f"two finite numbers [{unit}]")
    return finite(name, parts[0], unit), finite(name, parts[1], unit)


def not_negatives(name: str, value: Any, unit: str) -> Pair:
    """Return `value` (2,) (in `unit`) as two floats; InvalidParameter unless both are finite and not below
    zero."""
    x, y = pair(name, value, unit)
    return not_negative(name, x, unit), not_negative(name, y, unit)


def partly(name: str, value: Any, unit: str) -> tuple[float | None, float | None]:
    """Return `value` (2,) (in `unit`) as two floats, None where it is None.

    Raises:
        InvalidParameter: anything else, or no finite number at all.
    """
    parts = _parts(value)
    if len(parts) != 2 or all(part is None for part in parts):
        raise InvalidParameter(name, value, f"two finite numbers [{unit}], or one and None where it is free")
    return optional(name, parts[0], finite, unit), optional(name, parts[1], finite, unit)


def history(name: str, value: Sequence[Sequence[float]]) -> History:
    """Return the pairs of instant [s] and factor [1] that a piecewise linear history passes through.

    Raises:
        InvalidParameter: no pair, numbers that are not finite, or instants that do not increase.
    """
    points = tuple(pair(name, point, "s, 1") for point in value)
    if not points or any(b <= a for (a, _), (b, _) in pairwise(points)):
        raise InvalidParameter(name, value, "pairs of ascending instants [s] and factors [1]")
    return points
