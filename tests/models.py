"""Both models in one test: on what grids, the limit over meshes of the elements, and how they refuse."""

from collections.abc import Callable, Iterable, Sequence
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

import fe_reference
import spline_model
from tests import gates

#: Both elements where the interpreted forms of the second take seconds.
QUICK_ELEMENTS = ("corotational", pytest.param("reissner", marks=pytest.mark.slow))
BOTH = pytest.mark.parametrize("models", [spline_model, fe_reference], ids=lambda each: each.__name__)


def short(models):
    """Name of a model in its gates."""
    return models.__name__.partition("_")[0]


def extrapolated(values: Sequence[Any]) -> Any:
    """Return the Romberg value of results on meshes each twice as fine as the last (even powers)."""
    row = [np.asarray(value, dtype=float) for value in values]
    for power in range(1, len(row)):
        row = [fine + (fine - coarse) / (4.0**power - 1.0) for coarse, fine in pairwise(row)]
    return row[0]


def rotation_matrix(angle: float) -> np.ndarray:
    """Return the matrix (2, 2) that turns by an angle [rad]."""
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def refined(ask, elements=None, **grid):
    """Return what `ask` finds, of finite elements the limit over meshes."""
    return ask(**grid) if elements is None else extrapolated([ask(elements=n, **grid) for n in elements])


def held(gate, models, error, control_points=10, elements=(10, 20, 40)):
    """Hold an error of both models' discretisations against the model's gate."""
    grid = {"elements": elements} if models is fe_reference else {"control_points": control_points}
    gates.hold(gate, lambda **coarse: float(error(**grid | coarse)))


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
