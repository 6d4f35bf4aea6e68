"""The finite-element statics against closed forms of the same continuum theory."""

from functools import cache

import numpy as np
import pytest

from fe_reference import solve_loads, solve_statics
from tests import gates
from tests.closed_forms import by_quadrature, elastica_tip
from tests.fe.cases import EI, FORCE, LENGTH, MOMENT, QUICK_ELEMENTS, SECTION, cantilever, extrapolated, pivot
from tests.gates import hold

LOADS = (0.5, 1.0, 2.0, 5.0, 7.5, 10.0)


def test_half_the_moment_bends_the_strip_into_half_a_circle() -> None:
    """At half a circle the tip lies at (0, 2/pi) L; the polygon tends to it in even powers of 1/n."""

    def error(elements: tuple[int, ...] = (5, 10, 20, 40)) -> float:
        tips = []
        for n in elements:
            tips.append(solve_loads(cantilever(elements=n), moment=np.pi * MOMENT, increments=6).centre[-1])
        return float(np.abs(extrapolated(tips) / LENGTH - [0.0, 2.0 / np.pi]).max())

    hold("fe_roll_up_half_circle", error)


def test_reference_elastica_tends_to_elliptic_integrals() -> None:
    """Without stretch and shear the quadrature used below is the elastica in elliptic integrals."""

    def error(stretch: float = 0.0) -> float:
        pairs = [(by_quadrature(p, stretch=stretch, shear=0.0), elastica_tip(p)) for p in LOADS]
        return max(float(np.abs(np.subtract(*pair)).max()) for pair in pairs)

    hold("fe_elastica_reference", error)


@cache
def tips(element: str, elements: int) -> np.ndarray:
    """Return rotation and position (6, 3) of the tip at the LOADS."""
    path = solve_loads(
        cantilever(elements=elements, element=element), force=(0.0, 10.0 * FORCE), increments=20
    )
    rows = [round(2 * load) for load in LOADS]
    return np.column_stack([path.rotation, path.centre / LENGTH])[rows]


@pytest.mark.parametrize("element", QUICK_ELEMENTS)
def test_tip_force_follows_the_elastica(element: str) -> None:
    """Under a tip force up to 10 EI/L^2 the tip follows the elastica with the same stretch and shear.

    The meshes are extrapolated, so that what is left is the theory: the inextensible elastica is off by
        far more.
    """
    stretch = EI / (SECTION.axial_rigidity * LENGTH**2)
    shear = EI / (SECTION.shear_rigidity * LENGTH**2) if element == "reissner" else 0.0

    def error(elements: tuple[int, ...] = (10, 20, 40, 80), inextensible: bool = False) -> float:
        factor = 0.0 if inextensible else 1.0
        exact = [by_quadrature(load, stretch=factor * stretch, shear=factor * shear) for load in LOADS]
        return float(np.abs(extrapolated([tips(element, n) for n in elements]) - exact).max())

    name = f"fe_tip_force_{element}"
    hold(name, error)
    with pytest.raises(AssertionError, match="x the gate"):
        gates.check(name, error(inextensible=True))


def test_small_angle_stiffness_of_the_pivot() -> None:
    """At rest K = 8 (EI/L) (1 - 3 r + 3 r^2) at any inclination, if the strips do not stretch.

    The area is raised a thousandfold for that; what is left is of the order of EI/(EA L^2).
    """

    def error(area_factor: float = 1e3) -> float:
        worst = 0.0
        for ratio in (0.2, 0.35, 0.5, 0.8):
            for degrees in (30.0, 45.0, 60.0):
                model = pivot(
                    crossing_ratio=ratio, inclination=np.radians(degrees), area=area_factor * SECTION.area
                )
                stiffness = solve_statics(model, rotation=1e-3, increments=1).stiffness[0]
                worst = max(
                    worst, abs(stiffness / (8.0 * MOMENT * (1.0 - 3.0 * ratio + 3.0 * ratio**2)) - 1.0)
                )
        return worst

    hold("fe_small_angle_stiffness", error)
