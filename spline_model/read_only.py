"""Arrays of answers, which nobody may write."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property, wraps
from typing import Any, TypeVar

import numpy as np

T = TypeVar("T")


def read_only(given: T) -> T:
    """Return the same array, or the same container of arrays, after its arrays were set to read only."""
    if isinstance(given, np.ndarray):
        given.flags.writeable = False
    elif isinstance(given, dict | tuple):
        for each in given.values() if isinstance(given, dict) else given:
            read_only(each)
    return given


def kept(make: Callable[[Any], T]) -> cached_property[T]:
    """Return a property that is computed at its first access; its arrays are read only."""

    @wraps(make)
    def made(own: Any) -> T:
        return read_only(make(own))

    return cached_property(made)
