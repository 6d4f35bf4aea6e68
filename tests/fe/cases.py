"""What the tests of the finite elements share: the paper's pivot, a cantilever, limits of refinement."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from fe_reference import (
    DEFAULT_EFFECTS,
    BodyDesign,
    Model,
    StripDesign,
    compliant_mechanism,
    cross_axis_pivot,
)
from tests import table_one
from tests.refusals import scene

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


def cantilever(*, moment: float = 0.0, elements: int, element: str = "corotational", **changes: Any) -> Model:
    """Return a horizontal strip, clamped on the left, with a massless body as its tip and a moment on it."""
    return compliant_mechanism(
        strips=[replace(STRIP, **changes)],
        bodies=[BodyDesign(centre=(LENGTH, 0.0))],
        elements=elements,
        element=element,
        **scene(DEFAULT_EFFECTS, applied_moment={"moment": moment}),
    )


def rotation_matrix(angle: float) -> np.ndarray:
    """Return the matrix (2, 2) that turns by an angle [rad]."""
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def extrapolated(values: Sequence[Any]) -> Any:
    """Return the Romberg value of results on meshes each twice as fine as the last (even powers)."""
    row = [np.asarray(value, dtype=float) for value in values]
    for power in range(1, len(row)):
        row = [fine + (fine - coarse) / (4.0**power - 1.0) for coarse, fine in pairwise(row)]
    return row[0]


def observed_order(values: Sequence[Any]) -> float:
    """Return the order seen in three results on meshes each twice as fine as the one before."""
    coarse, middle, fine = (np.ravel(value) for value in values)
    return float(np.log2(np.linalg.norm(coarse - middle) / np.linalg.norm(middle - fine)))
