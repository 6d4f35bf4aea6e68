"""What the tests of the finite elements share: the paper's pivot, a cantilever, limits of refinement."""

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from fe_reference import (
    Model,
    StripDesign,
    cross_axis_pivot,
)
from tests import table_one

QUICK_ELEMENTS = ("corotational", pytest.param("reissner", marks=pytest.mark.slow))
"""Both elements where the interpreted forms of the second take seconds."""

TABLE_1: dict[str, Any] = table_one.TABLE_ONE
LENGTH = TABLE_1["length"]
STRIP = StripDesign(name="strip", start=(0.0, 0.0), end=(LENGTH, 0.0), tip="body", **table_one.SECTION)
EI = STRIP.flexural_rigidity
#: Unit of moment and rotational stiffness in which errors are given.
MOMENT = EI / LENGTH


def pivot(**changes: Any) -> Model:
    """Return the paper's pivot with some parameters changed."""
    return cross_axis_pivot(**{**TABLE_1, **changes})


def rotation_matrix(angle: float) -> np.ndarray:
    """Return the matrix (2, 2) that turns by an angle [rad]."""
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def extrapolated(values: Sequence[Any]) -> Any:
    """Return the Romberg value of results on meshes each twice as fine as the last (even powers)."""
    row = [np.asarray(value, dtype=float) for value in values]
    for power in range(1, len(row)):
        row = [fine + (fine - coarse) / (4.0**power - 1.0) for coarse, fine in pairwise(row)]
    return row[0]
