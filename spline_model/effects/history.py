"""How a load or a drive changes in time."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from spline_model.errors import InvalidParameter
from spline_model.strip.compiled import kernel

Array = NDArray[np.float64]
History = tuple[tuple[float, float], ...]
"""(time [s], factor) pairs in order of time; linear between them, constant before and after."""

STEADY: History = ((0.0, 1.0),)


def factor_of(history: History, time: float) -> float:
    """The factor at an instant [s]."""
    times, factors = zip(*history, strict=True)
    return float(np.interp(time, times, factors))


def checked(history: History) -> History:
    """The history itself, if its times increase."""
    if not history or any(b[0] <= a[0] for a, b in pairwise(history)):
        raise InvalidParameter("history", history, "(time, factor) pairs with increasing times [s]")
    return history


@kernel()
def factor_at(time: float, first: int, count: int, times: Array, factors: Array) -> Any:
    """The factor at an instant [s] of a history in a table: ``count`` pairs from ``first`` on."""
    if time <= times[first]:
        return factors[first]
    for i in range(first + 1, first + count):
        if time <= times[i]:
            share = (time - times[i - 1]) / (times[i] - times[i - 1])
            return factors[i - 1] + share * (factors[i] - factors[i - 1])
    return factors[first + count - 1]
