"""Level of the discretisation error on the paper's path to 90 degrees."""

from functools import cache

import numpy as np
import pytest

from fe_reference import ELEMENTS, StaticSolution, solve_statics
from tests.fe.cases import extrapolated, pivot
from tests.gates import hold

QUANTITIES = {
    "torque": lambda path: path.torque,
    "trajectory": lambda path: path.centre,
    "stiffness": lambda path: path.stiffness,
}


@cache
def path(element: str, elements: int) -> StaticSolution:
    return solve_statics(pivot(element=element, elements=elements), rotation=np.pi / 2.0, increments=10)


def deviation(value: np.ndarray, exact: np.ndarray) -> float:
    """Return the largest deviation over the path, over the largest change of the quantity on it."""
    size = np.linalg.norm(
        np.atleast_2d(exact.T - exact[0][..., None] if exact.ndim > 1 else exact), axis=0
    ).max()
    gap = value - exact
    return float((np.linalg.norm(gap, axis=1) if gap.ndim > 1 else np.abs(gap)).max() / size)


@pytest.mark.parametrize("element", ELEMENTS)
@pytest.mark.parametrize("quantity", QUANTITIES)
def test_level_of_twenty_elements(element: str, quantity: str) -> None:
    """Twenty elements are as near to the extrapolated value as stated."""
    pick = QUANTITIES[quantity]

    def error(elements: int = 20) -> float:
        return deviation(
            pick(path(element, elements)), extrapolated([pick(path(element, n)) for n in (40, 80, 160)])
        )

    hold(f"fe_level_{quantity}_{element}", error)
