"""States whose elements are folded are no answers."""

import numpy as np
import pytest

from fe_reference import ELEMENTS, Status, solve_mechanism
from tests.fe.cases import MOMENT, cantilever


@pytest.mark.parametrize("element", ELEMENTS)
def test_elements_that_turn_by_half_a_turn_are_refused(element: str) -> None:
    """Two elements rolled by 1.2 whole turns stop where each is bent by half a turn, with a message."""
    model = cantilever(elements=2, element=element, moment=2.4 * np.pi * MOMENT)
    answer = solve_mechanism(model, increments=12, check=False, raise_on_failure=False)
    assert answer.status is Status.NOT_CONVERGED
    assert "an element is folded" in answer.message
    assert 0.9 < answer.rotation[-1] / (2.0 * np.pi) <= 1.0


@pytest.mark.parametrize("element", ELEMENTS)
def test_finer_elements_go_on(element: str) -> None:
    """Four elements, each bent by less, are rolled by 1.2 whole turns."""
    model = cantilever(elements=4, element=element, moment=2.4 * np.pi * MOMENT)
    answer = solve_mechanism(model, increments=12)
    assert answer.rotation[-1] == pytest.approx(2.4 * np.pi)
