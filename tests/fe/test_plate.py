"""The strip as a plate between built-in ends: published factors, limits and its mesh."""

import numpy as np
import pytest

from fe_reference import plate, plate_factors
from tests.gates import hold


@pytest.mark.slow
@pytest.mark.parametrize("ratio", [0.05, 0.5])
def test_mesh_is_fine_enough(ratio, monkeypatch):
    """Requirement: halved elements change the factors by far less than the printed digits, also of a narrow
    strip, whose smallest triangles are a hundredth of its width and far from its middle."""

    def error(layers: int = plate.LAYERS) -> float:
        monkeypatch.setattr(plate, "LAYERS", layers)
        given, finer = (plate_factors(ratio, 0.45, halvings=each) for each in (0, 1))
        return max(abs(given.constant - finer.constant), abs(given.linear - finer.linear))

    hold("fe_plate_mesh", error)


@pytest.mark.slow
def test_limits():
    """Requirement: the excess of a narrow strip goes with its width, and no strip is stiffer than one that is
    held flat."""
    narrow, wider = plate_factors(0.1, 0.3).constant - 1.0, plate_factors(0.2, 0.3).constant - 1.0
    assert wider / narrow == pytest.approx(2.0, rel=0.02)
    wide = plate_factors(20.0, 0.3)
    assert 1.09 < wide.constant < wide.linear < 1.0 / (1.0 - 0.3**2)


@pytest.mark.slow
def test_a_narrow_strip_has_the_rigidity_of_its_plate():
    """Requirement: a strip whose clamps do not see each other is as much stiffer as its plate is."""
    ends = np.linspace(0.0, 1.0, 401)
    compliance = 0.91 / (1.0 - plate.left_in_elements(0.01, 0.3, ends, False, 1)[:, 0, 0])
    excess = 1.0 / compliance.mean() - 1.0
    assert excess == pytest.approx(plate_factors(0.01, 0.3).constant - 1.0, rel=0.02)


def test_no_poisson_effect():
    """Requirement: a strip whose section does not curl is a beam."""
    found = plate_factors(1.0, 0.0)
    assert max(abs(found.constant - 1.0), abs(found.linear - 1.0)) <= 1e-12
