"""How a load or a drive changes in time."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from spline_model.errors import InvalidParameter

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
