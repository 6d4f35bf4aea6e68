"""What must hold on any mesh: energy, balance, symmetry, frame indifference, reversibility."""

from dataclasses import replace

import numpy as np
import pytest

from fe_reference import ELEMENTS, solve_statics
from tests.fe.cases import LENGTH, SECTION, pivot
from tests.gates import hold

QUARTER = np.pi / 2.0


@pytest.mark.parametrize("element", ELEMENTS)
def test_stiffness_does_not_depend_on_the_order(element: str) -> None:
    """Whichever strip comes first, stiffness is the same: round-off of EA is not in it, however slender."""
    thinner = {"area": 0.1 * SECTION.area, "second_moment_of_area": 1e-3 * SECTION.second_moment_of_area}
    thin = replace(SECTION, **thinner)
    given = pivot(crossing_ratio=0.35, element=element)
    model = replace(given, strips=tuple(replace(strip, section=thin) for strip in given.strips))
    turned = replace(model, strips=model.strips[::-1])
    one, other = (solve_statics(each, rotation=0.5, increments=4).stiffness for each in (model, turned))
    assert one[1:] == pytest.approx(other[1:], rel=1e-12)


def test_section_forces_are_in_balance_along_the_strip() -> None:
    """The end values of M, N and V are the clamp reactions, and dM/ds = -(1 + eps) V between the nodes."""

    def error(elements: int = 80) -> float:
        answer = solve_statics(pivot(elements=elements, crossing_ratio=0.35), rotation=QUARTER, increments=5)
        moment = answer.bending_moment[1:]
        strain = answer.axial_force[1:] / SECTION.axial_rigidity
        load = (1.0 + strain) * answer.shear_force[1:]
        gain = np.diff(moment, axis=-1) + LENGTH / elements * 0.5 * (load[..., 1:] + load[..., :-1])
        assert np.allclose(moment[..., 0], -answer.clamp_reactions[1:, :, 0, 2], rtol=1e-12)
        assert np.allclose(moment[..., -1], answer.clamp_reactions[1:, :, 1, 2], rtol=1e-12)
        return float(np.abs(gain).max() * elements / np.abs(moment).max())

    hold("fe_section_force_balance", error)
