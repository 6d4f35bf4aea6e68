"""The finite-element statics against closed forms of the same continuum theory."""

from functools import cache

import numpy as np
import pytest

from fe_reference import ELEMENTS, solve_loads, solve_statics
from tests import gates
from tests.closed_forms import by_quadrature, elastica_tip
from tests.fe.cases import EI, FORCE, LENGTH, MOMENT, QUICK_ELEMENTS, SECTION, cantilever, extrapolated, pivot
from tests.gates import hold

LOADS = (0.5, 1.0, 2.0, 5.0, 7.5, 10.0)


@pytest.mark.slow
def test_end_moment_rolls_the_strip_into_two_full_circles() -> None:
    """An end moment of 4 pi EI/L turns the tip by two whole turns, back to the clamp, in both elements."""

    def error(turns: float = 2.0) -> float:
        worst = 0.0
        for element in ELEMENTS:
            model = cantilever(elements=20, element=element)
            answer = solve_loads(model, moment=2.0 * np.pi * turns * MOMENT, increments=16)
            tip = np.linalg.norm(answer.centre[[8, 16]], axis=1).max() / LENGTH
            worst = max(worst, tip, abs(answer.rotation[-1] - 4.0 * np.pi))
        return worst

    hold("fe_roll_up_closure", error)


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


def stiffness_under_tension(q: float) -> float:
    """Return K L/(2 EI) at crossing ratio 1/2 for a tension q EI/L^2 in each strip."""
    u = np.sqrt(complex(q))
    c, s = np.cosh(u), np.sinh(u)
    d = 2.0 - 2.0 * c + u * s
    return float((u * (u * c - s) / d - u**2 * (c - 1.0) / d + 0.25 * u**3 * s / d - 0.5 * u**2).real)


def test_axial_load_takes_the_stiffness_away() -> None:
    """A force through the crossing point changes K as beam-column theory says, down to zero at q = 5.757."""

    def error(elements: tuple[int, ...] = (10, 20, 40)) -> float:
        worst = 0.0
        for q in (-3.0, -1.0, 1.0, 3.0, 5.757):
            pull = 2.0 * np.cos(np.pi / 4.0) * q * FORCE
            values = []
            for n in elements:
                model = pivot(elements=n, area=1e3 * SECTION.area, centre_offset=(0.0, -0.03))
                values.append(
                    solve_loads(model, force=(0.0, pull), increments=2).stiffness[-1] / (2.0 * MOMENT)
                )
            worst = max(worst, abs(float(extrapolated(values)) - stiffness_under_tension(q)))
        return worst

    hold("fe_stiffness_under_axial_load", error)
