"""Arrays of answers, which nobody may write."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property, wraps
from typing import Any, TypeVar

import numpy as np

T = TypeVar("T")


def read_only(given: T) -> T:
    """The same, its arrays no longer to be written: an array, or what holds some by name or in order."""
    if isinstance(given, np.ndarray):
        given.flags.writeable = False
    elif isinstance(given, dict | tuple):
        for each in given.values() if isinstance(given, dict) else given:
            read_only(each)
    return given


def kept(make: Callable[[Any], T]) -> cached_property[T]:
    """A property that is made when it is first asked for, and then read only."""

    @wraps(make)
    def made(own: Any) -> T:
        return read_only(make(own))

    return cached_property(made)
