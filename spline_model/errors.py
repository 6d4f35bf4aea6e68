"""Exceptions of the spline model: each carries the evidence of what went wrong."""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterable
from numbers import Real
from typing import Any

FORMER = {
    "slide_stiffness": "penalty_stiffness",
    "swinging_slide_stiffness": "motion_penalty_stiffness",
    "printed": "published",
}
"""Former names of keywords, functions and values, with the present ones: accepted until version 0.3."""


def present(name: str) -> str:
    """Return the present name of a keyword, function or value; a former name causes a FutureWarning."""
    if name in FORMER:
        text = f"{name} is now called {FORMER[name]}; version 0.3 ends {name}"
        warnings.warn(text, FutureWarning, stacklevel=3)
    return FORMER.get(name, name)


class InvalidParameter(ValueError):
    """A parameter outside its range; the message is one line ``name: got X, expected Y``.

    Attributes
    ----------
    name : str
        Of the parameter.
    got : object
        What was given.
    expected : str
        What is, with the unit.

    Examples
    --------
    >>> try:
    ...     BodyDesign(name="tip", centre=(0.1, 0.0), mass=-1.0)
    ... except InvalidParameter as refusal:
    ...     print(refusal.name, refusal.got)
    mass -1.0
    """

    def __init__(self, name: str, got: Any, expected: str) -> None:
        super().__init__(name, got, expected)  # of which another process makes it again
        self.name, self.got, self.expected = name, got, expected

    def __str__(self) -> str:
        name, got, expected = self.args
        return f"{name}: got {got!r}, expected {expected}"


class ConvergenceError(RuntimeError):
    """A path that could not be followed to its end.

    Attributes
    ----------
    solution : the converged part of the path as a ``StaticSolution``, last good state included.
    load_factor : fraction of the path that was reached, 0 to 1.
    history : residual norms of the failed attempts, dimensionless.

    Examples
    --------
    A strip of 80 mm that a body pushes far beyond its Euler load, of which a part of the path is left:

    >>> far = compliant_mechanism(
    ...     strips=[
    ...         StripDesign(
    ...             name="strip", start=(0.0, 0.0), end=(0.08, 0.0), tip="body", width=0.01, thickness=1e-4,
    ...             youngs_modulus=206e9, density=7850.0,
    ...         )
    ...     ],
    ...     bodies=[BodyDesign(name="body", centre=(0.08, 0.0))],
    ...     control_points=4,
    ...     effects=("bending", "stretching", "applied_force"),
    ...     parameters={"applied_force": {"force": (-1.0, 0.01)}},
    ... )
    >>> try:
    ...     solve_statics(far, increments=3)
    ... except ConvergenceError as stopped:
    ...     print(0.0 <= stopped.load_factor < 1.0, len(stopped.solution.load_factor) >= 1)
    True True
    """

    def __init__(
        self,
        message: str,
        *,
        solution: Any = None,
        load_factor: float = 0.0,
        history: tuple[tuple[float, ...], ...] = (),
    ) -> None:
        super().__init__(message)
        self.solution = solution
        self.load_factor = load_factor
        self.history = history


def is_finite(value: Any) -> bool:
    """Return whether `value` is one finite number; a truth value is not."""
    if type(value) is float:
        return math.isfinite(value)
    if isinstance(value, bool) or not isinstance(value, Real):
        return False
    try:
        return math.isfinite(value)
    except OverflowError:  # a whole number beyond the range of floats
        return False


def require_finite(name: str, value: Any, unit: str) -> None:
    """Raise InvalidParameter unless `value` (in ``unit``) is a finite number."""
    if not is_finite(value):
        raise InvalidParameter(name, value, f"a finite number [{unit}]")


def finite_numbers(name: str, value: Any, unit: str) -> list[float]:
    """Return a finite number (in ``unit``), or a sequence of such numbers, as a list.

    Raises
    ------
    InvalidParameter
        Anything else, or an empty sequence.
    """
    numbers = list(value) if isinstance(value, Iterable) else [value]
    if not numbers or not all(map(is_finite, numbers)):
        raise InvalidParameter(name, value, f"a finite number or several [{unit}]")
    return [float(number) for number in numbers]


def require_positive(name: str, value: float, unit: str) -> None:
    """Raise InvalidParameter unless `value` (in ``unit``) is a finite number above zero."""
    if not (is_finite(value) and value > 0):
        raise InvalidParameter(name, value, f"a finite number > 0 [{unit}]")


def require_not_negative(name: str, value: float, unit: str) -> None:
    """Raise InvalidParameter unless `value` (in ``unit``) is a finite number of at least zero."""
    if not (is_finite(value) and value >= 0):
        raise InvalidParameter(name, value, f"a finite number >= 0 [{unit}]")


def require_count(name: str, value: int, lowest: int, highest: int | None = None) -> None:
    """Raise InvalidParameter unless `value` is an integer in ``lowest ... highest``."""
    is_count = isinstance(value, int) and not isinstance(value, bool)
    if not is_count or value < lowest or (highest is not None and value > highest):
        upper = "" if highest is None else f" and <= {highest}"
        raise InvalidParameter(name, value, f"an integer >= {lowest}{upper}")


def require_kind(name: str, value: Any, kind: type, expected: str) -> None:
    """Raise InvalidParameter unless `value` is an object of this kind; the message has the name of its
    kind."""
    if not isinstance(value, kind):
        told = value if value is None or isinstance(value, int | float | str | dict) else type(value).__name__
        raise InvalidParameter(name, told, expected)


def require_choice(name: str, value: str, choices: tuple[str, ...]) -> None:
    """Raise InvalidParameter unless `value` is one of the named choices."""
    if value not in choices:
        raise InvalidParameter(name, value, "one of " + ", ".join(choices))
