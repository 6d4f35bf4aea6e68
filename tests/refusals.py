"""How tests see both models refuse: a call, and the one line that must say why."""

from collections.abc import Callable, Iterable
from typing import Any

import pytest

#: Between two parts of what is said stands any text.
ANY = " ... "


def scene(names: Iterable[str], **parameters: dict[str, Any]) -> dict[str, Any]:
    """Return effects, and those that have parameters with them, as keywords."""
    return {"effects": (*names, *parameters), "parameters": parameters}


def refused(ask: Callable[[], object], said: str) -> None:
    """See a call refused in one line that says all parts of a text."""
    with pytest.raises((ValueError, RuntimeError), match=r"\A[^\n]+\Z") as caught:
        ask()
    line = str(caught.value)
    assert all(part in line for part in said.split(ANY)), line
