"""Accuracy gates: the limits of ``gates.toml`` and the one way to hold a measured error against them.

A gate is a table of ``gates.toml``, the only place where accuracy limits are written::

    [name]
    limit = 1e-6            # the error a test may not exceed, in `unit`
    unit = "1"              # of limit and measured
    measured = 2e-7         # what was last seen; a limit is at most 20 x this
    set = "2026-01-31, ..." # the date the limit was set, and on what occasion
    against = "..."         # what the error is measured against
    why = "..."             # why this limit and not another
    teeth = { elements = 5 }  # a coarser setting with which the same check must fail
    parts = { model = 4e-7, discretisation = 1e-7 }  # optional: what the limit is made of ...
    factor = 2.0            # ... and the allowance on their sum, limit <= factor * sum(parts)

A test calls :func:`hold` with its error as a function of the setting: the gate passes that of the defaults
and refuses that of the coarser setting, the negative control. Where several tests share a gate, or where the
control is much slower than the check, they call :func:`check`, and one test calls :func:`refuse`.
"""

import math
import tomllib
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import pytest

PATH = Path(__file__).with_name("gates.toml")

#: Fields that every gate has, with their types.
REQUIRED: dict[str, tuple[type, ...]] = {
    "limit": (int, float),
    "unit": (str,),
    "measured": (int, float),
    "set": (str,),
    "against": (str,),
    "why": (str,),
    "teeth": (dict,),
}
#: Fields that a gate may have.
OPTIONAL: dict[str, tuple[type, ...]] = {"parts": (dict,), "factor": (int, float)}


@cache
def table() -> dict[str, dict[str, Any]]:
    """Return every gate by name, as read from ``gates.toml``."""
    with PATH.open("rb") as stream:
        return tomllib.load(stream)


def gate(name: str) -> dict[str, Any]:
    """Return the gate `name`; a KeyError lists the near ones."""
    gates = table()
    if name not in gates:
        raise KeyError(f"no gate {name!r} in gates.toml; there are: {', '.join(sorted(gates)) or 'none'}")
    return gates[name]


def limit(name: str) -> float:
    """Return the largest error that the gate lets pass, in the gate's unit."""
    return float(gate(name)["limit"])


def teeth(name: str) -> dict[str, Any]:
    """Return the coarser setting with which the gate's own check must fail."""
    return dict(gate(name)["teeth"])


def check(name: str, error: float) -> None:
    """Hold `error` against the gate `name`.

    Refuses an error above the limit, one that is not finite, and one of exactly zero or below: an error of
    zero says that a thing was compared with itself.

    Raises:
        AssertionError: one line with the gate, the error, its ratio to the limit, against what it was
            measured and what was last seen.
    """
    entry = gate(name)
    value, bound = float(error), float(entry["limit"])
    if math.isfinite(value) and 0.0 < value <= bound:
        return
    if not math.isfinite(value):
        verdict = "is not a finite number"
    elif value <= 0.0:
        verdict = "is not positive (compared with itself?)"
    else:
        verdict = f"is {value / bound:.3g} x the gate"
    raise AssertionError(
        f"gate {name}: error {value:.6g} [{entry['unit']}] {verdict}"
        f" (limit {bound:.3g}, against {entry['against']}, last measured {float(entry['measured']):.3g})"
    )


def hold(name: str, error: Callable[..., float]) -> None:
    """Hold an error against its gate, and see the gate refuse the error of the coarser setting."""
    check(name, error())
    refuse(name, error)


def refuse(name: str, error: Callable[..., float]) -> None:
    """See the gate refuse the error of the coarser setting: the negative control alone."""
    with pytest.raises(AssertionError, match=r"x the gate|is not a finite number"):
        check(name, error(**teeth(name)))
