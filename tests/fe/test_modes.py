"""Linearised frequencies against closed forms, and their convergence."""

import numpy as np
import pytest

from fe_reference import ELEMENTS, natural_frequencies
from tests.fe.cases import extrapolated, pivot
from tests.gates import hold


def relative(value: np.ndarray, exact: np.ndarray) -> float:
    return float(np.abs(value / exact - 1.0).max())


@pytest.mark.parametrize("element", ELEMENTS)
def test_both_masses_extrapolate_to_the_same_frequencies(element: str) -> None:
    """At rest and at 60 degrees the frequencies do not depend on how the mass is put on the mesh."""

    def error(elements: tuple[int, ...] = (20, 40, 80)) -> float:
        worst = 0.0
        for rotation in (0.0, np.pi / 3.0):
            limits = []
            for mass in ("consistent", "lumped"):
                values = [
                    natural_frequencies(
                        pivot(elements=n, element=element),
                        rotation=rotation,
                        count=5,
                        mass=mass,
                        increments=5,
                    ).frequency
                    for n in elements
                ]
                limits.append(extrapolated(values))
            worst = max(worst, relative(*limits))
        return worst

    hold(f"fe_frequencies_by_mass_{element}", error)


def test_holding_the_rotation_interlaces_the_frequencies() -> None:
    """With the rotation held each frequency lies between two of the released pivot."""
    model = pivot(elements=10)
    free = natural_frequencies(model, rotation=1.0, count=6)
    held = natural_frequencies(model, rotation=1.0, count=5, held=True)
    assert np.all(held.frequency >= free.frequency[:5])
    assert np.all(held.frequency <= free.frequency[1:])
    assert np.all(held.body_shapes[:, 2] == 0.0)


def test_small_meshes_give_all_their_modes() -> None:
    """A mesh too small for the sparse solver is solved densely, and has no more modes than coordinates."""
    model = pivot(elements=2)
    many = natural_frequencies(model, count=9)
    few = natural_frequencies(model, count=3)
    assert many.frequency.shape == (9,)
    assert few.frequency == pytest.approx(many.frequency[:3], rel=1e-9)
    assert natural_frequencies(model, count=10).frequency == pytest.approx(many.frequency, rel=1e-9)
    assert natural_frequencies(model, count=10, accuracy=0.1).frequency.shape == (9,)
