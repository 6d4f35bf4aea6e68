"""Fields of an event, each checked: BadInput in one line for what does not fit."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from studies.errors import BadInput


def number(event: Mapping[str, Any], key: str) -> float:
    """Return a finite number."""
    value = event.get(key)
    if not isinstance(value, int | float) or isinstance(value, bool) or not math.isfinite(value):
        raise BadInput(f"{key}: got {value!r}, expected a finite number")
    return float(value)


def three(event: Mapping[str, Any], key: str) -> NDArray[np.float64]:
    """Return three finite numbers."""
    values = event.get(key)
    if not isinstance(values, list | tuple) or len(values) != 3:
        raise BadInput(f"{key}: got {values!r}, expected three finite numbers")
    return np.array([number({key: value}, key) for value in values])


def choice(event: Mapping[str, Any], key: str, choices: tuple[str, ...]) -> str:
    """Return one of the choices."""
    value = event.get(key)
    if value not in choices:
        raise BadInput(f"{key}: got {value!r}, expected one of {', '.join(choices)}")
    return str(value)


def mapping(event: Mapping[str, Any], key: str) -> Mapping[str, Any]:
    """Return names with their values, none where the key is absent."""
    value = event.get(key, {})
    if not isinstance(value, Mapping):
        raise BadInput(f"{key}: got {value!r}, expected values by name")
    return value


def words(event: Mapping[str, Any], key: str) -> list[str]:
    """Return a list of texts, empty where the key is absent."""
    value = event.get(key, [])
    if not isinstance(value, list) or not all(isinstance(word, str) for word in value):
        raise BadInput(f"{key}: got {value!r}, expected a list of texts")
    return value
